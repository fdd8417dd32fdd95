// A block, whatever it is: its description, and runs of it on numbers. What a test holds of every block is written and
// compiled over these, once. Of an expectation that is compiled once a block, the catalogue makes a hundred.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "blocks/description.hpp"
#include "tests/blocks/random_io.hpp"
#include "tests/blocks/stepper.hpp"

namespace hysteron::testing {

/// A block with its parameters and its memory, which begins by itself. `Number` is double, or the scalar of the block;
/// bool, DINT and WORD are numbers as well, and an array is as many as it has elements.
template <class Number>
class AnyRun {
 public:
  AnyRun() = default;
  AnyRun(const AnyRun&) = delete;
  AnyRun& operator=(const AnyRun&) = delete;
  virtual ~AnyRun() = default;

  virtual void step(std::span<const Number> in, std::span<Number> out) = 0;
};

/// In double also what makes up a step.
class AnyRunInDouble : public AnyRun<double> {
 public:
  virtual void reset() = 0;
  /// The outputs alone: the memory does not move.
  virtual void output(std::span<const double> in, std::span<double> out) const = 0;
  /// Output and update in one, for a block that says them so.
  virtual void step_at_once(std::span<const double> in, std::span<double> out) = 0;
  [[nodiscard]] virtual std::vector<double> memory() const = 0;
};

namespace detail {

template <class T>
inline constexpr bool is_array = false;
template <class T, std::size_t N>
inline constexpr bool is_array<std::array<T, N>> = true;

template <class Value, class Number>
Value value_of_number(const Number& number) {
  if constexpr (std::is_same_v<Value, Number>) {
    return number;
  } else if constexpr (requires { number.value(); }) {
    return value_of_number<Value>(number.value());
  } else if constexpr (requires(const Value& value) { value.value(); }) {
    return Value(static_cast<decltype(std::declval<const Value&>().value())>(number));
  } else {
    return static_cast<Value>(number);
  }
}

template <class Number, class Value>
Number number_of_value(const Value& value) {
  if constexpr (std::is_same_v<Value, Number>) {
    return value;
  } else if constexpr (requires { value.value(); }) {
    return number_of_value<Number>(value.value());
  } else {
    return Number(static_cast<double>(value));
  }
}

template <class Struct, class Number>
Struct structure_of(std::span<const Number> numbers) {
  Struct result{};
  std::size_t next = 0;
  const auto set = [&]<class Member>(Member& member) {
    if constexpr (is_array<Member>) {
      for (auto& element : member) {
        element = value_of_number<typename Member::value_type>(numbers[next++]);
      }
    } else {
      member = value_of_number<Member>(numbers[next++]);
    }
  };
  Struct::fields().apply([&](const auto&... field) { (set(result.*(field.member)), ...); });
  return result;
}

template <class Number, class Struct>
void write_numbers(const Struct& structure, std::span<Number> numbers) {
  std::size_t next = 0;
  const auto write = [&]<class Member>(const Member& member) {
    if constexpr (is_array<Member>) {
      for (const auto& element : member) {
        numbers[next++] = number_of_value<Number>(element);
      }
    } else {
      numbers[next++] = number_of_value<Number>(member);
    }
  };
  Struct::fields().apply([&](const auto&... field) { (write(structure.*(field.member)), ...); });
}

template <class Struct>
inline constexpr auto fields_in_memory = fields_of<Struct>();

}  // namespace detail

/// Block B in scalar S.
template <class B, class S, class Number>
class RunOf : public AnyRun<Number> {
 public:
  RunOf(std::span<const Number> params, double ts)
      : block_(static_cast<S>(ts), detail::structure_of<typename B::template Params<S>>(params)) {}

  void step(std::span<const Number> in, std::span<Number> out) override {
    detail::write_numbers(block_(detail::structure_of<typename B::template In<S>>(in)), out);
  }

 private:
  Stepper<B, S> block_;
};

template <class B>
class RunInDoubleOf : public AnyRunInDouble {
 public:
  using In = typename B::template In<double>;

  RunInDoubleOf(std::span<const double> params, double ts)
      : ts_(ts), block_(ts, detail::structure_of<typename B::template Params<double>>(params)) {}

  void step(std::span<const double> in, std::span<double> out) override {
    detail::write_numbers(block_(detail::structure_of<In>(in)), out);
  }
  void reset() override { block_.reset(); }
  void output(std::span<const double> in, std::span<double> out) const override {
    detail::write_numbers(B::output(block_.params, block_.state, detail::structure_of<In>(in), ts_), out);
  }
  void step_at_once(std::span<const double> in, std::span<double> out) override {
    if constexpr (StepsAtOnce<B>) {
      const auto structure = detail::structure_of<In>(in);
      detail::write_numbers(B::template step<double>(block_.params, block_.state, structure, ts_), out);
    }
  }
  [[nodiscard]] std::vector<double> memory() const override {
    std::vector<double> result(places(detail::fields_in_memory<typename B::template State<double>>).back());
    detail::write_numbers(block_.state, std::span<double>(result));
    return result;
  }

 private:
  double ts_;
  Stepper<B> block_;
};

/// Makes a run of a block with these parameters and this sample time.
template <class Run, class Number = double>
using MakeRun = std::unique_ptr<Run> (*)(std::span<const Number> params, double ts);

template <class B, class S, class Number = double>
std::unique_ptr<AnyRun<Number>> make_run(std::span<const Number> params, double ts) {
  return std::make_unique<RunOf<B, S, Number>>(params, ts);
}

template <class B>
std::unique_ptr<AnyRunInDouble> make_run_in_double(std::span<const double> params, double ts) {
  return std::make_unique<RunInDoubleOf<B>>(params, ts);
}

/// The description of a block, and how it is run in double.
struct AnyBlock {
  const About* about = nullptr;
  std::span<const Field> in;
  std::span<const Field> params;
  std::span<const Field> out;
  std::span<const Field> state;
  bool steps_at_once = false;
  MakeRun<AnyRunInDouble> in_double = nullptr;

  template <class B>
  static constexpr AnyBlock of() {
    return {.about = &B::about,
            .in = detail::fields_in_memory<typename B::template In<double>>,
            .params = detail::fields_in_memory<typename B::template Params<double>>,
            .out = detail::fields_in_memory<typename B::template Out<double>>,
            .state = detail::fields_in_memory<typename B::template State<double>>,
            .steps_at_once = StepsAtOnce<B>,
            .in_double = make_run_in_double<B>};
  }
};

}  // namespace hysteron::testing
