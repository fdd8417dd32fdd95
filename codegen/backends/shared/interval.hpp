// The operations of a step on intervals.
#pragma once

#include "codegen/backends/shared/value_bounds.hpp"
#include "codegen/trace/operation.hpp"

namespace hysteron::interval {

[[nodiscard]] ValueBounds exactly(double value);
[[nodiscard]] ValueBounds any_of_type(Type type);
/// The least interval that holds both.
[[nodiscard]] ValueBounds hull(const ValueBounds& a, const ValueBounds& b);

/// What an operation gives for any operands within their bounds. Not of leaves.
struct Operands {
  ValueBounds a{};
  ValueBounds b{};
  ValueBounds c{};
};
[[nodiscard]] ValueBounds apply(Op op, const Operands& operands, bool float32);

}  // namespace hysteron::interval
