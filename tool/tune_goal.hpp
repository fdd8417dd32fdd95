// `hysteron tune` of a parameter file with [goal]: a control loop is tuned for it.
#pragma once

#include "codegen/parameters/parameter_file.hpp"
#include "tool/console.hpp"
#include "tool/tune_options.hpp"

namespace hysteron::tool {

int tune_goal(const TuneOptions& options, const parameters::ParameterFile& file, Console& console);

}  // namespace hysteron::tool
