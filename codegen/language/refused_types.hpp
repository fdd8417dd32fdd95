// The elementary types of the standard that a body does not have, and what is written in place of each.
#pragma once

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "codegen/language/syntax.hpp"

namespace hysteron::language {

/// A mend; empty where the type is none of them. A number has 32 bits, or is an LREAL.
inline std::string_view in_place_of_type(std::string_view type) {
  using Row = std::pair<std::string_view, std::string_view>;
  constexpr std::string_view date = "Take the date out: hand over seconds as a UDINT, or days as a DINT.";
  constexpr std::array rows{
      Row{"LINT", "Use DINT; above 2147483647 an LREAL, which has every whole number up to 9007199254740992."},
      Row{"ULINT", "Use UDINT; above 4294967295 an LREAL, which has every whole number up to 9007199254740992."},
      Row{"LWORD", "Use two DWORDs, one for the upper and one for the lower bits."},
      Row{"LTIME", "Use TIME: its literals are written T#, with parts of a millisecond as T#0.5ms."},
      Row{"DATE", date},
      Row{"LDATE", date},
      Row{"DATE_AND_TIME", date},
      Row{"DT", date},
      Row{"LDT", date},
      Row{"TOD", "Take the time of the day out: hand it over as a TIME."},
      Row{"TIME_OF_DAY", "Take the time of the day out: hand it over as a TIME."},
      Row{"LTOD", "Take the time of the day out: hand it over as a TIME."}};
  const auto* const found = std::ranges::find_if(rows, [&](const Row& one) { return same_name(one.first, type); });
  return found == rows.end() ? std::string_view() : found->second;
}

}  // namespace hysteron::language
