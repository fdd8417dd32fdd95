#include "codegen/backends/st/literals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "codegen/graph/names.hpp"
#include "support/numbers.hpp"

namespace hysteron {
namespace {

/// The digits of a real number with a large E, as the standard writes it. A constant that is not a number (LN(-1.0)) is
/// 0, as what a guard gives for 0 / 0.
std::string digits_of(double value, const StReals& reals) {
  if (std::isnan(value)) {
    value = 0.0;
  }
  if (std::isinf(value)) {
    const double largest =
        reals.float32 || reals.small_literals ? std::numeric_limits<float>::max() : std::numeric_limits<double>::max();
    value = std::copysign(largest, value);
  }
  std::string text = reals.float32 ? real_literal(static_cast<float>(value)) : real_literal(value);
  std::ranges::replace(text, 'e', 'E');
  return text;
}

}  // namespace

std::string st_typed_literal(std::string_view type, std::string_view digits) {
  const bool negative = digits.starts_with('-');
  return fmt::format("{}{}#{}", negative ? "-" : "", type, digits.substr(negative ? 1 : 0));
}

std::string_view st_type(Type type, bool float32) {
  return float32 && type == Type::Real ? "REAL" : type_name(type);
}

std::string st_literal(Type type, double value, const StReals& reals) {
  switch (type) {
    case Type::Real:
      return digits_of(value, reals);
    case Type::Word:
      return fmt::format("WORD#16#{:04X}", static_cast<unsigned>(value));
    default:
      return literal_text(type, value);
  }
}

}  // namespace hysteron
