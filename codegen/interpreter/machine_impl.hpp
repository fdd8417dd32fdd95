// The body of Machine, to be included by the source files that instantiate it.
#pragma once

#include <algorithm>
#include <cstring>
#include <numeric>
#include <stdexcept>

#include "codegen/graph/sample_time.hpp"
#include "codegen/interpreter/fmu_node.hpp"
#include "codegen/interpreter/machine.hpp"
#include "codegen/interpreter/sized_code.hpp"
#include "codegen/trace/evaluate.hpp"

namespace hysteron {
namespace detail {

template <class S>
void write_as(void* target, Type type, const NumberOf<S>& number) {
  const auto plain = [&] {
    if constexpr (SideBySide<S>) {
      return number;
    } else {
      return value_of(number);
    }
  }();
  switch (type) {
    case Type::Real:
      new (target) S(static_cast<S>(plain));
      break;
    case Type::Bool:
      new (target) Bool<S>(plain != decltype(plain)(0.0));
      break;
    case Type::Int:
      new (target) Int<S>(to_int(plain));
      break;
    case Type::Word:
      new (target) Word<S>(int_to_word(to_int(plain)));
      break;
  }
}

template <class S>
NumberOf<S> read_as(const void* source, Type type) {
  using Number = NumberOf<S>;
  switch (type) {
    case Type::Real:
      return *static_cast<const S*>(source);
    case Type::Bool:
      return select(*static_cast<const Bool<S>*>(source), Number(1.0), Number(0.0));
    case Type::Int:
      return to_real<Number>(*static_cast<const Int<S>*>(source));
    default:
      return to_real<Number>(word_to_int(*static_cast<const Word<S>*>(source)));
  }
}

}  // namespace detail

template <class S>
Machine<S>::Machine(const Program& program, double sample_time)
    : program_(std::make_shared<const Program>(program)),
      sample_time_(program.graph.sample_time_ns > 0 ? program.graph.sample_time() : sample_time) {
  if (!(sample_time_ > 0.0)) {
    require_sample_time(program.graph);
  }
  lay_out();
  place_instructions();
  reset();
}

template <class S>
Machine<S>::~Machine() = default;
template <class S>
Machine<S>::Machine(Machine&&) noexcept = default;
template <class S>
Machine<S>& Machine<S>::operator=(Machine&&) noexcept = default;

template <class S>
const BlockCode<S>& Machine<S>::code_of(std::uint32_t node) const {
  if (fmus_[node] != nullptr) {
    return fmus_[node]->code();
  }
  const BlockType* const block = program_->graph.nodes[node].block;
  return block->sized != nullptr ? sized_.at(block)
                                 : block_codes<S>()[static_cast<std::size_t>(block - block_types().data())];
}

template <class S>
void Machine<S>::lay_out() {
  const Graph& graph = program_->graph;
  std::size_t size = 0;
  const auto reserve = [&](std::size_t bytes, std::size_t alignment) {
    size = (size + alignment - 1) / alignment * alignment;
    const std::size_t at = size;
    size += bytes;
    return at;
  };
  constexpr std::size_t align = alignof(S) > 8 ? alignof(S) : 8;
  fmus_.resize(graph.nodes.size());
  for (std::uint32_t index = 0; index < graph.nodes.size(); ++index) {
    const Node& node = graph.nodes[index];
    Placed placed;
    if (node.block != nullptr) {
      if (node.block->fmu != nullptr) {
        if constexpr (SideBySide<S>) {
          throw std::logic_error("an FMU runs by itself, not side by side");
        } else {
          fmus_[index] = std::make_unique<FmuNode<S>>(*node.block, node.path, *directions_);
        }
      }
      if (node.block->sized != nullptr && !sized_.contains(node.block)) {
        sized_.emplace(node.block, detail::sized_code<S>(*node.block->sized));
      }
      const auto& code = code_of(index);
      placed.state = reserve(code.state_size, code.alignment);
      placed.out = reserve(code.out_size, code.alignment);
    } else {
      placed.out = reserve(sizeof(S), align);
    }
    placed_.push_back(placed);
  }
  for (std::size_t i = 0; i < graph.inputs.size(); ++i) {
    inputs_.push_back(reserve(sizeof(S), align));
  }
  live_size_ = size;
  for (std::size_t i = 0; i < graph.literals.size(); ++i) {
    literals_.push_back(reserve(sizeof(S), align));
  }
  for (const Parameter& parameter : graph.parameters) {
    parameters_.push_back(reserve(sizeof(S) * parameter.value.size(), align));
  }
  for (std::uint32_t index = 0; index < graph.nodes.size(); ++index) {
    const Node& node = graph.nodes[index];
    if (node.block != nullptr && code_of(index).prepare != nullptr && parameters_stand_still(node)) {
      placed_[index].prepared = reserve(code_of(index).prepared_size, code_of(index).alignment);
    }
  }
  memory_.reset(static_cast<std::byte*>(::operator new[](size == 0 ? 1 : size, std::align_val_t{64})));
  std::memset(memory_.get(), 0, size);
  for (std::size_t i = 0; i < graph.parameters.size(); ++i) {
    const Parameter& parameter = graph.parameters[i];
    for (std::size_t element = 0; element < parameter.value.size(); ++element) {
      // An array is an array of S; a single value stands alone.
      detail::write_as<S>(memory_.get() + parameters_[i] + element * sizeof(S), parameter.field.type,
                          NumberOf<S>(parameter.value[element]));
    }
  }
  const auto write_literal = [&](const Wire& wire) {
    if (wire.from == Wire::From::Literal) {
      detail::write_as<S>(memory_.get() + literals_[wire.index], wire.type, NumberOf<S>(graph.literals[wire.index]));
    }
  };
  std::ranges::for_each(graph.wires, write_literal);
  for (const Port& output : graph.outputs) {
    write_literal(output.wire);
  }
  for (const NamedWire& named : graph.named) {
    write_literal(named.wire);
  }
}

template <class S>
std::size_t Machine<S>::output_offset(const Wire& wire) const {
  const Node& node = program_->graph.nodes[wire.index];
  const Placed& placed = placed_[wire.index];
  if (node.block == nullptr) {
    return placed.out;
  }
  return placed.out + code_of(wire.index).out_offsets[wire.port];
}

template <class S>
const void* Machine<S>::source_of(const Wire& wire) const {
  switch (wire.from) {
    case Wire::From::Literal:
      return memory_.get() + literals_[wire.index];
    case Wire::From::Parameter:
      return memory_.get() + parameters_[wire.index];
    case Wire::From::Input:
      return memory_.get() + inputs_[wire.index];
    case Wire::From::Node:
      return memory_.get() + output_offset(wire);
    default:
      return nullptr;
  }
}

template <class S>
const S* Machine<S>::ts_of(const Node& node) {
  for (const auto& [every, ts] : sample_times_) {
    if (every == node.rate.every) {
      return ts.get();
    }
  }
  // Whole nanoseconds times the divisor, once rounded: the same number as in generated code.
  const double ts = program_->graph.sample_time_ns > 0
                        ? static_cast<double>(program_->graph.sample_time_ns * node.rate.every) * 1e-9
                        : sample_time_ * node.rate.every;
  sample_times_.emplace_back(node.rate.every, std::make_unique<S>(static_cast<S>(ts)));
  return sample_times_.back().second.get();
}

/// Whether no signal is wired to a parameter of a block.
template <class S>
bool Machine<S>::parameters_stand_still(const Node& node) const {
  const Graph& graph = program_->graph;
  for (std::size_t pin = node.block->inputs.size(); pin < node.wire_count; ++pin) {
    const Wire::From from = graph.wire(node, static_cast<std::uint32_t>(pin)).from;
    if (from != Wire::From::Parameter && from != Wire::From::Literal) {
      return false;
    }
  }
  return true;
}

template <class S>
Instruction<S> Machine<S>::instruction_of(std::uint32_t index) {
  const Node& node = program_->graph.nodes[index];
  void* const state = memory_.get() + placed_[index].state;
  const std::size_t prepared = placed_[index].prepared;
  return {.run = nullptr,
          .pins = pins_.data() + placed_[index].first_pin,
          .state = fmus_[index] != nullptr ? static_cast<void*>(fmus_[index].get()) : state,
          .out = memory_.get() + placed_[index].out,
          .ts = ts_of(node),
          .prepared = prepared == 0 ? nullptr : memory_.get() + prepared,
          .block = node.block};
}

template <class S>
void Machine<S>::place_instructions() {
  const Graph& graph = program_->graph;
  for (std::uint32_t index = 0; index < graph.nodes.size(); ++index) {
    placed_[index].first_pin = pins_.size();
    const Node& node = graph.nodes[index];
    for (std::uint32_t pin = 0; pin < node.wire_count; ++pin) {
      pins_.push_back(source_of(graph.wire(node, pin)));
    }
  }
  for (const Port& output : graph.outputs) {
    outputs_.push_back(source_of(output.wire));
  }
  for (std::uint32_t index = 0; index < graph.nodes.size(); ++index) {
    if (graph.nodes[index].block != nullptr) {
      auto instruction = instruction_of(index);
      instruction.run = code_of(index).reset;
      resets_.push_back(instruction);
      if (instruction.prepared != nullptr) {
        instruction.run = code_of(index).prepare;
        preparations_.push_back(instruction);
      }
    }
  }
  for (const Node& node : graph.nodes) {
    longest_period_ = std::lcm(longest_period_, std::uint64_t{node.rate.every});
  }
  const bool one_rate = std::ranges::all_of(graph.nodes, [](const Node& node) { return node.rate == Rate{}; });
  for (const Action& action : program_->schedule.actions) {
    const Node& node = graph.nodes[action.node];
    auto instruction = instruction_of(action.node);
    if (node.block == nullptr) {
      instruction.run = run_table<S>().operations[static_cast<std::size_t>(node.op)];
    } else {
      const auto& code = code_of(action.node);
      instruction.run = action.kind == Action::Kind::Output   ? code.output
                        : action.kind == Action::Kind::Update ? code.update
                                                              : code.step;
    }
    if (one_rate) {
      instructions_.push_back(instruction);
    } else {
      timed_.push_back({instruction, node.rate});
    }
  }
}

template <class S>
void Machine<S>::set_parameter(std::size_t parameter, const Number& value, std::size_t element) {
  prepared_ = false;
  const Type type = program_->graph.parameters[parameter].field.type;
  std::byte* target = memory_.get() + parameters_[parameter] + element * sizeof(S);
  if (type == Type::Real) {
    *reinterpret_cast<S*>(target) = static_cast<S>(value);
    next_directions_.note(value, program_->graph.parameters[parameter].field);
  } else {
    detail::write_as<S>(target, type, value);
  }
}

template <class S>
typename Machine<S>::Number Machine<S>::parameter(std::size_t parameter, std::size_t element) const {
  return detail::read_as<S>(memory_.get() + parameters_[parameter] + element * sizeof(S),
                            program_->graph.parameters[parameter].field.type);
}

template <class S>
void Machine<S>::reset() {
  steps_ = 0;
  *directions_ = next_directions_;
  next_directions_ = {.used = next_directions_.used};
  std::memset(memory_.get(), 0, live_size_);  // a parameter that is wired to a signal begins at 0
  for (const auto& instruction : resets_) {
    instruction.run(instruction);
  }
  for (const InitialState& given : program_->graph.initial_states) {
    *real_state(given.node, given.state) = static_cast<S>(given.value);
  }
}

template <class S>
void Machine<S>::set_input(std::size_t input, const Number& value) {
  if (program_->graph.inputs[input].type == Type::Real) {
    *reinterpret_cast<S*>(memory_.get() + inputs_[input]) = static_cast<S>(value);
  } else {
    detail::write_as<S>(memory_.get() + inputs_[input], program_->graph.inputs[input].type, value);
  }
}

template <class S>
void Machine<S>::set_input(std::size_t input, double value) requires(!std::is_same_v<NumberOf<S>, double>) {
  if (program_->graph.inputs[input].type == Type::Real) {
    run_table<S>().constant(memory_.get() + inputs_[input], value);
  } else {
    set_input(input, Number(value));
  }
}

template <class S>
void Machine<S>::prepare() {
  for (const auto& instruction : preparations_) {
    instruction.run(instruction);
  }
  prepared_ = true;
}

template <class S>
void Machine<S>::step() {
  if (!prepared_) {
    prepare();
  }
  for (const auto& instruction : instructions_) {
    instruction.run(instruction);
  }
  for (const auto& [instruction, rate] : timed_) {
    if (steps_ % rate.every == rate.phase) {
      instruction.run(instruction);
    }
  }
  if (++steps_ == longest_period_) {
    steps_ = 0;
  }
}

template <class S>
typename Machine<S>::Number Machine<S>::output(std::size_t output) const {
  return detail::read_as<S>(outputs_[output], program_->graph.outputs[output].wire.type);
}

template <class S>
typename Machine<S>::Number Machine<S>::value(const Wire& wire) const {
  return detail::read_as<S>(source_of(wire), wire.type);
}

template <class S>
S* Machine<S>::real_state(std::string_view path) {
  const Graph& graph = program_->graph;
  for (std::uint32_t index = 0; index < graph.nodes.size(); ++index) {
    const Node& node = graph.nodes[index];
    if (node.block == nullptr || path.size() <= node.path.size() + 1 || path[node.path.size()] != '.' ||
        !language::same_name(path.substr(0, node.path.size()), node.path)) {
      continue;
    }
    for (std::uint32_t state = 0; state < node.block->states.size(); ++state) {
      const Field& field = node.block->states[state];
      if (field.type == Type::Real && field.length == 1 &&
          language::same_name(field.name, path.substr(node.path.size() + 1))) {
        return real_state(index, state);
      }
    }
  }
  return nullptr;
}

template <class S>
S* Machine<S>::real_state(std::uint32_t node, std::uint32_t state) {
  return reinterpret_cast<S*>(memory_.get() + place_of_state(node, state));
}

template <class S>
std::size_t Machine<S>::place_of_state(std::uint32_t node, std::uint32_t state) const {
  return placed_[node].state + code_of(node).state_offsets[state];
}

template <class S>
std::size_t Machine<S>::place_of_output(std::uint32_t node, std::uint16_t port) const {
  return output_offset({.from = Wire::From::Node, .port = port, .index = node});
}

template <class S>
void Machine<S>::save(std::span<std::byte> bytes) const noexcept {
  std::memcpy(bytes.data(), memory_.get(), live_size_);
  std::memcpy(bytes.data() + live_size_, &steps_, sizeof(steps_));
}

template <class S>
void Machine<S>::restore(std::span<const std::byte> bytes) noexcept {
  std::memcpy(memory_.get(), bytes.data(), live_size_);
  std::memcpy(&steps_, bytes.data() + live_size_, sizeof(steps_));
}

}  // namespace hysteron
