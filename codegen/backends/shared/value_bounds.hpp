// Within which bounds the values of a routine stay, proved by interval arithmetic: for every input within its stated
// range, in every step of a run without end.
//
// +, -, ·, / and √ are rounded to the nearest number, and rounding is monotonic. So the ends of an interval, computed
// as the target computes a value, bound it to the bit. What the mathematical library rounds gets some units in the last
// place more. A state is bounded by a fixed point: bounds that a step does not leave, found by widening and sharpened
// afterwards (P. and R. Cousot, Abstract interpretation, POPL 1977).
//
// What no interval tells, such as that two values are never large at once, is not seen: a bound may be infinite
// although the value is not.
#pragma once

#include <limits>
#include <vector>

#include "codegen/backends/shared/routine.hpp"

namespace hysteron {

/// low <= x <= high, of any type as a number: BOOL from 0 to 1. An end may be infinite, and is then a value as well.
struct ValueBounds {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool may_be_nan = true;  ///< or not a number

  [[nodiscard]] bool is_finite() const;
  [[nodiscard]] bool contains(double value) const;
  bool operator==(const ValueBounds&) const = default;
};

/// By output of the diagram. Parameters have the values that the program has; an input without a range is any number,
/// infinite or not a number, too. `float32`: LREAL is computed in 32 bits.
[[nodiscard]] std::vector<ValueBounds> output_bounds(const Graph& graph, const Routine& routine, bool float32);

}  // namespace hysteron
