// Blocks whose pins are vectors: how many there are follows from the sizes of an instance, which the lists of its
// parameters say. Such a block is one header like the others: a description with sizes for lengths, and the functions
// `initial`, `output` and `update`.
//
//   static constexpr std::array params{matrix_parameter("A", Size::N, Size::N, "from state to state, row by row")};
//
// Its functions see an instance through a view, which a machine, a dual number and a trace each have:
//
//   view.in(i, k)  view.flag(i)  view.param(i, k)   element k of the field i of inputs and of parameters
//   view.state(k)  view.out(k)  view.ts()           elements counted through all states, through all outputs
//   view.set_out(k, value)  view.set_state(k, value)  a state changes after the step
//
// A matrix stands in a list row by row. Sums go from the left: a0·x0 + a1·x1 + …, without a zero before them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "blocks/description.hpp"

namespace hysteron {

/// What a length counts. `One` is no size but the number.
enum class Size : std::uint8_t { One, N, M, P };

struct Sizes {
  std::size_t n = 0;
  std::size_t m = 0;
  std::size_t p = 0;
  bool direct = false;  ///< the matrix that passes inputs at once is there

  [[nodiscard]] constexpr std::size_t of(Size size) const {
    return size == Size::One ? 1 : size == Size::N ? n : size == Size::M ? m : p;
  }
  bool operator==(const Sizes&) const = default;
};

/// How the lists that an instance gives say its sizes.
enum class SizeRule : std::uint8_t {
  Matrix,           ///< K and a number of ROWS
  StateSpace,       ///< A, B and C, perhaps D and X0
  TransferFunction  ///< NUM and DEN
};

/// Of a block whose lists are all parameters.
inline constexpr std::array<std::string_view, 0> no_settings{};

/// Bounds that keep a step readable: each element of a state is a line of it.
inline constexpr std::size_t most_states = 16;
inline constexpr std::size_t most_elements_of_pin = 32;

struct SizedField {
  Field field{};
  Size rows = Size::One;
  Size columns = Size::One;
  bool vector = false;  ///< its elements are pins of their own, named U[0], U[1], …; else it is one pin
  bool direct = false;  ///< there only where Sizes::direct says so
  bool scaled = false;  ///< its first number only scales the others and those of other parameters: a fit leaves it

  [[nodiscard]] constexpr std::size_t length(const Sizes& sizes) const { return sizes.of(rows) * sizes.of(columns); }
};

/// One pin of type LREAL, to be connected.
constexpr SizedField signal_pin(std::string_view name, std::string_view meaning) {
  SizedField one;
  one.field.name = name;
  one.field.meaning = meaning;
  one.field.required = true;
  return one;
}
/// One pin of type BOOL, FALSE where it is not connected.
constexpr SizedField flag_pin(std::string_view name, std::string_view meaning) {
  SizedField one = signal_pin(name, meaning);
  one.field.type = Type::Bool;
  one.field.required = false;
  return one;
}
/// A pin, an output or a state for each element.
constexpr SizedField vector_pin(std::string_view name, Size length, std::string_view meaning) {
  SizedField one = signal_pin(name, meaning);
  one.rows = length;
  one.vector = true;
  return one;
}
/// A parameter that is a list of numbers, row by row; 0 where it is left out.
constexpr SizedField matrix_parameter(std::string_view name, Size rows, Size columns, std::string_view meaning) {
  SizedField one = signal_pin(name, meaning);
  one.field.required = false;
  one.field.filled = true;
  one.rows = rows;
  one.columns = columns;
  return one;
}
/// The same, there only where Sizes::direct says so.
constexpr SizedField direct_parameter(std::string_view name, Size rows, Size columns, std::string_view meaning) {
  SizedField one = matrix_parameter(name, rows, columns, meaning);
  one.direct = true;
  return one;
}

/// A list whose first number divides all others.
constexpr SizedField scaled_list(std::string_view name, Size length, std::string_view meaning) {
  SizedField one = matrix_parameter(name, length, Size::One, meaning);
  one.scaled = true;
  return one;
}

/// sum of weight(k)·value(k) for k = 0 … count − 1, from the left.
template <class S, class Weight, class Value>
S weighted_sum(std::size_t count, Weight weight, Value value) {
  S sum = weight(0) * value(0);
  for (std::size_t k = 1; k < count; ++k) {
    sum = sum + weight(k) * value(k);
  }
  return sum;
}

}  // namespace hysteron
