// The C file of an FMU: the functions of FMI round the generated C99 step.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "codegen/backends/fmu/model_description.hpp"

namespace hysteron {

/// NAME_fmi2.c or NAME_fmi3.c: the table of variables, what both versions share, and the functions of the version.
std::string fmu_wrapper(const FmuModel& model, std::span<const FmuVariable> variables, const FmuOptions& options);

// The parts that are the same for each diagram. What a diagram needs reaches them by the macros of the first part.

/// Types and functions of FMI 2.0 or 3.0 that the rest is written with.
std::string_view fmi2_declarations();
std::string_view fmi3_declarations();

/// What an instance holds, and what a variable is. The table of variables stands behind it.
std::string_view fmu_core_types();

/// Variables by reference, samples, the saved state: whatever the version.
std::string_view fmu_core();

/// The functions that an importer calls.
std::string_view fmi2_functions();
std::string_view fmi3_functions();

}  // namespace hysteron
