// What the live page is told, as JSON: once what there is to be seen, then again and again the values.
#pragma once

#include <cstdint>
#include <string>

#include "runtime/point.hpp"

namespace hysteron::runtime::web {

/// Of the program that is shown.
struct Subject {
  std::string name{};
  std::int64_t period = 0;  ///< of its steps, in nanoseconds
  std::string diagram{};    ///< SVG; empty where there is none
};

/// {"name", "period" in seconds, "diagram", "points": [{"name", "kind", "type", "unit", "low", "high", "meaning"}],
/// "inner": [{"name", "type", "unit"}], "writable", "token_to_read"}. Limits that are infinite are null.
[[nodiscard]] std::string description_text(const Subject& subject, const PointDoor& door, bool writable,
                                           bool token_to_read);

/// {"cycle", "values", "inner", "staged": [[point, value], …]}. What is not finite is null; all other numbers are read
/// back to the same bits.
[[nodiscard]] std::string values_text(const LiveValues& live);

/// {"refusal": "…"}.
[[nodiscard]] std::string refusal_text(const std::string& refusal);

}  // namespace hysteron::runtime::web
