// The parameters that count in the task as a parameter file, so that what was found on site goes back into the project.
#pragma once

#include <span>
#include <string>

#include "runtime/point.hpp"

namespace hysteron::runtime::web {

/// TOML for `--params`: `[parameters]`, then a table for each instance. `values` as `points`. A vector is one list.
/// What is not finite, as a limit that is off, is left out and named in a comment: a parameter file has no such number.
[[nodiscard]] std::string parameter_text(const std::string& program, std::span<const Point> points,
                                         std::span<const double> values);

}  // namespace hysteron::runtime::web
