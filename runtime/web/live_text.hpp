// What the live page is told, as JSON: once what there is to be seen, then again and again the values.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "runtime/history/history_trend.hpp"
#include "runtime/point.hpp"
#include "runtime/web/access.hpp"

namespace hysteron::runtime::web {

/// Of the program that is shown.
struct Subject {
  std::string name{};
  std::int64_t period = 0;                    ///< of its steps, in nanoseconds
  std::filesystem::path history{};            ///< the file of its history; empty where there is none
  std::vector<std::string> history_points{};  ///< what is in it
};

/// {"name", "period" in seconds, "version" of the diagram, "diagram", "points": [{"name", "kind", "type", "data_type",
/// "unit", "low", "high", "meaning"}], "inner": [{"name", "type", "data_type", "unit"}], "history": [names of points],
/// "writable", "rights": [what may be written: "parameters", "reset", "force"], "token_to_read"}. Limits that are
/// infinite are null; "type" is boolean, integer or real, "data_type" as in the register map.
[[nodiscard]] std::string description_text(const Subject& subject, const LiveView& view, const Access& access);

/// {"version", "cycle", "values", "inner", "staged": [[point, value], …], "forced": [point, …]}, of the description of
/// that version. What is not finite is null; all other numbers are read back to the same bits.
[[nodiscard]] std::string values_text(const LiveValues& live);

/// {"unit", "rows", "looked_at", "set_back" in seconds, "places": [[UTC in ms, low, mean, high], …]}; null stands
/// between two places with a gap.
[[nodiscard]] std::string trend_text(const Trend& trend);

/// {"refusal": "…"}.
[[nodiscard]] std::string refusal_text(const std::string& refusal);

}  // namespace hysteron::runtime::web
