// What a fit says, in words: shared by its text and its page.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tool/tune_report.hpp"

namespace hysteron::tool {

[[nodiscard]] std::string iterations_of(const OutputErrorFit& fit);

/// " um"; nothing without a unit.
[[nodiscard]] std::string unit_behind(const std::string& unit);

/// The standard error of an unknown, or why it has none.
[[nodiscard]] std::string error_text(const LeastSquaresResult& solution, double standard_error, std::size_t unknown);

/// ", 1.2 % of the range"
[[nodiscard]] std::string share_of(double error, double range);

/// Model less measurement, over the whole record.
[[nodiscard]] Signal residuals_of(const TuneReport& report, std::size_t record, std::size_t output);

/// A sentence for each output that keeps more than its noise; empty where none does, or where no command is known that
/// looks for the cause.
[[nodiscard]] std::string unexplained(const TuneReport& report);

/// A paragraph where the fit leaves of an output more than its noise, with the command that looks for the cause; else
/// nothing. What is left stands out of the noise as the diagnosis asks it to, and its samples hang together.
[[nodiscard]] std::string what_is_not_in_the_model(const TuneReport& report);

/// `name`, or name2, name3 and so on: the first that is no folder of an input. A command that is printed writes there.
[[nodiscard]] std::string folder_beside(const std::string& name, const std::vector<std::string>& inputs);

/// By what the sum of squares would grow if an unknown had stayed at its start and the others were fitted again, as a
/// factor on the RMSE: √(1 + (x − x₀)²·τ/((N − n)·σ²)), the parabola at the solution. NaN where σ is not known, and of
/// initial states, whose start no file states.
[[nodiscard]] double cost_at_start(const TuneReport& report, std::size_t unknown);

}  // namespace hysteron::tool
