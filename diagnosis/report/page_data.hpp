// What the script of the report draws, as JSON.
#pragma once

#include <string>

#include "diagnosis/diagnosis.hpp"

namespace hysteron::diagnosis::report {

/// Traces as the measured signal and the residuals of each model, model − measured; maps; the command of the next
/// experiment. Numbers are rounded to seven digits; what is not finite is null. `<` is written as an escape, so that
/// the text can stand in a script element.
[[nodiscard]] std::string page_data(const Diagnosis& diagnosis);

}  // namespace hysteron::diagnosis::report
