// A number as its reader would write it, where it was computed with a rounding.
#pragma once

#include <fmt/format.h>

#include <string>

#include "support/numbers.hpp"

namespace hysteron {

/// The text of the number rounded to 12 significant digits: 0.0003 of 300 * 1e-6, which is 0.00030000000000000003. For
/// messages alone, since it may not read back to the same bits. Infinities and not-a-number are those of number_text.
[[nodiscard]] inline std::string rounded_text(double value) {
  const ParsedNumber rounded = parse_number(fmt::format("{:.12g}", value));
  return number_text(rounded.status == NumberStatus::Finite ? rounded.value : value);
}

}  // namespace hysteron
