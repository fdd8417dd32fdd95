// Traced against run: the expressions that a block leaves on a tape give the bits of its functions.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "blocks/catalogue.hpp"
#include "codegen/trace/block_type.hpp"
#include "codegen/trace/evaluate.hpp"
#include "tests/blocks/any_block.hpp"
#include "tests/blocks/random_io.hpp"

namespace hysteron::testing {
namespace {

/// Numbers by their fields, arrays in full.
std::vector<std::vector<double>> by_field(std::span<const Field> fields, const std::vector<double>& numbers) {
  std::vector<std::vector<double>> result;
  auto next = numbers.begin();
  for (const Field& field : fields) {
    result.emplace_back(next, next + field.length);
    next += field.length;
  }
  return result;
}

/// A second interpreter, of tapes alone: every value is a double, of whatever type it stands for.
class TapeRun {
 public:
  TapeRun(const BlockTrace& trace, double ts) : trace_(trace), ts_(ts) {}

  std::vector<std::vector<double>> pins;
  std::vector<std::vector<double>> cells;

  void reset(std::size_t states, const std::vector<std::vector<double>>& shape) {
    cells = shape;
    evaluate();
    for (std::size_t i = 0; i < states; ++i) {
      if (trace_.initial[i] != no_value) {
        cells[i] = {values_[trace_.initial[i]]};
      }
    }
    write(trace_.initial_stores);
  }

  std::vector<double> step() {
    evaluate();
    std::vector<double> outputs;
    for (const ValueId id : trace_.outputs) {
      outputs.push_back(values_[id]);
    }
    for (std::size_t i = 0; i < trace_.next.size(); ++i) {
      if (trace_.next[i] != no_value) {
        cells[i] = {values_[trace_.next[i]]};
      }
    }
    write(trace_.stores);
    return outputs;
  }

 private:
  void write(const std::vector<Store>& stores) {
    for (const Store& store : stores) {
      auto& array = cells[store.cell];
      if (store.index == no_value) {
        std::ranges::fill(array, values_[store.value]);
      } else {
        const auto last = static_cast<double>(array.size() - 1);
        array[static_cast<std::size_t>(std::clamp(values_[store.index], 0.0, last))] = values_[store.value];
      }
    }
  }

  void evaluate() {
    values_.assign(trace_.tape.size(), 0.0);
    for (ValueId id = 0; id < trace_.tape.size(); ++id) {
      values_[id] = value(trace_.tape[id]);
    }
  }

  double value(const Value& v) {
    const auto arg = [&](std::size_t i) { return v.args[i] == no_value ? 0.0 : values_[v.args[i]]; };
    const auto whole = [&](std::size_t i) { return static_cast<std::int32_t>(arg(i)); };
    switch (v.op) {
      case Op::RealLiteral:
      case Op::IntLiteral:
      case Op::BoolLiteral:
      case Op::WordLiteral:
        return v.literal;
      case Op::SampleTime:
        return ts_;
      case Op::Pin:
        return pins[v.index].front();
      case Op::Cell:
        return cells[v.index].front();
      case Op::At: {
        const Value& base = trace_.tape[v.args[0]];
        const auto& array = base.op == Op::Pin ? pins[base.index] : cells[base.index];
        return array[static_cast<std::size_t>(std::clamp(arg(1), 0.0, static_cast<double>(array.size() - 1)))];
      }
      case Op::ToInt:
        return to_int(arg(0));
      case Op::ToReal:
      case Op::WordToInt:
        return arg(0);
      case Op::IntToWord:
        return int_to_word(whole(0));
      default:
        break;
    }
    if (is_select(v.op)) {
      return arg(0) != 0.0 ? arg(1) : arg(2);
    }
    const bool truth = info(v.op).result == Type::Bool;
    switch (info(v.op).operand) {
      case Type::Int:
        return truth ? static_cast<double>(comparison(v.op, whole(0), whole(1)))
                     : int_operation(v.op, whole(0), whole(1));
      case Type::Bool:
        return static_cast<double>(bool_operation(v.op, arg(0) != 0.0, arg(1) != 0.0));
      default:
        return truth ? static_cast<double>(comparison(v.op, arg(0), arg(1))) : real_operation(v.op, arg(0), arg(1));
    }
  }

  const BlockTrace& trace_;
  double ts_;
  std::vector<double> values_;
};

void hold_traced_against_run(const AnyBlock& block, double ts, std::uint64_t seed) {
  const BlockType* type = find_block_type(block.about->name);
  ASSERT_NE(type, nullptr);
  RandomIo random(seed, ts);
  const auto params = random.numbers(block.params);
  const auto run = block.in_double(params, ts);
  TapeRun tape(type->trace, ts);
  const auto set_pins = [&](const std::vector<double>& in) {
    tape.pins = by_field(block.in, in);
    for (auto& one : by_field(block.params, params)) {
      tape.pins.push_back(std::move(one));
    }
  };
  set_pins(std::vector<double>(places(block.in).back()));
  tape.reset(type->states.size(), by_field(block.state, run->memory()));
  std::vector<double> out(places(block.out).back());
  for (int k = 0; k < 200; ++k) {
    const auto in = random.numbers(block.in);
    set_pins(in);
    run->step(in, out);
    const auto expected = by_field(block.out, out);
    const auto got = tape.step();
    for (std::size_t i = 0; i < expected.size(); ++i) {
      ASSERT_EQ(std::bit_cast<std::uint64_t>(expected[i].front()), std::bit_cast<std::uint64_t>(got[i]))
          << block.about->name << "." << type->outputs[i].name << " at step " << k << ": run " << expected[i].front()
          << ", traced " << got[i];
    }
    ASSERT_EQ(by_field(block.state, run->memory()), tape.cells) << block.about->name << " at step " << k;
  }
}

TEST(Traced, EveryBlockGivesTheBitsOfItsFunctions) {
  for (const double ts : {50e-6, 1e-3, 1.0}) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      Catalogue::for_each([&]<class B> { hold_traced_against_run(AnyBlock::of<B>(), ts, seed); });
    }
  }
}

}  // namespace
}  // namespace hysteron::testing
