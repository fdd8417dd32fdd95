// The table [goal] of a parameter file, with [goal.limits].
#pragma once

#include <toml++/toml.h>

#include <string>

#include "codegen/parameters/parameter_file.hpp"
#include "support/diagnostic.hpp"

namespace hysteron::parameters {

/// What is wrong in itself is reported: HY602 to HY606, HY530. What the diagram does not have, only the diagram knows.
[[nodiscard]] GoalSettings read_goal(const toml::table& table, const Place& place, const std::string& file,
                                     Diagnostics& diagnostics);

}  // namespace hysteron::parameters
