// The unit that an operation of an expression gives, from the units of its operands.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "codegen/graph/unit.hpp"
#include "codegen/trace/operation.hpp"

namespace hysteron::units {

using MaybeUnit = std::optional<Unit>;

/// Told of two units that have to be the same.
using Agree = std::function<void(const MaybeUnit& given, const MaybeUnit& expected)>;

/// The unit of the result; nothing where it is not known, or is none. `exponent` is that of a power, where it is a
/// literal.
MaybeUnit unit_of_operation(Op op, std::span<const MaybeUnit> operands, std::optional<double> exponent,
                            const Agree& agree);

/// The same for an operation on constants, in texts: empty for one without a unit. Nothing where their units do not
/// agree.
std::optional<std::string> unit_of_constants(Op op, std::span<const std::string_view> operands, double exponent);

}  // namespace hysteron::units
