#include "tool/tune_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>

#include "support/numbers.hpp"
#include "support/overwriting.hpp"

namespace hysteron::tool {

std::string iterations_of(const OutputErrorFit& fit) {
  return fmt::format("{} iteration{}", fit.solution.iterations, fit.solution.iterations == 1 ? "" : "s");
}

std::string unit_behind(const std::string& unit) {
  return unit.empty() || unit == "1" ? std::string() : " " + unit;
}

std::string error_text(const LeastSquaresResult& solution, double standard_error, std::size_t unknown) {
  if (solution.at_bound[unknown] == AtBound::Lower || solution.at_bound[unknown] == AtBound::Upper) {
    return solution.at_bound[unknown] == AtBound::Lower ? "on its lower bound" : "on its upper bound";
  }
  if (std::isinf(standard_error)) {
    return "not determined";
  }
  return std::isnan(standard_error) ? "unknown" : fmt::format("{:.2g}", standard_error);
}

std::string share_of(double error, double range) {
  return range > 0.0 ? fmt::format(", {:.3g} % of the range", 100.0 * error / range) : std::string();
}

Signal residuals_of(const TuneReport& report, std::size_t record, std::size_t output) {
  Signal residuals = report.fit.model[record][output];
  const Signal& measured = report.problem.experiments[record].measured[output];
  for (std::size_t k = 0; k < residuals.size(); ++k) {
    residuals[k] -= measured[k];
  }
  return residuals;
}

std::string unexplained(const TuneReport& report) {
  constexpr double least_correlation = 2.0;  // samples; of noise it is 1
  if (report.diagnose_command.empty() || !(report.fit.covariance.correlation_time > least_correlation)) {
    return {};
  }
  std::string text;
  for (std::size_t i = 0; i < report.fit.scores.size() && i < report.floors.size(); ++i) {
    const OutputScore& score = report.fit.scores[i];
    const diagnosis::NoiseFloor& floor = report.floors[i];
    if (std::sqrt(std::max(0.0, score.train * score.train - floor.value * floor.value)) >
        diagnosis::least_excess(floor)) {
      text += fmt::format("{} keeps an RMSE of {:.3g}{}, and its noise is {:.2g}{}: something is not in the model.\n",
                          score.output, score.train, unit_behind(score.unit), floor.value, unit_behind(score.unit));
    }
  }
  return text;
}

std::string what_is_not_in_the_model(const TuneReport& report) {
  const std::string text = unexplained(report);
  return text.empty() ? text : text + fmt::format("This looks for the cause:\n  {}\n", report.diagnose_command);
}

std::string folder_beside(const std::string& name, const std::vector<std::string>& inputs) {
  const auto holds_input = [&](const std::string& folder) {
    return std::ranges::any_of(inputs, [&](const std::string& input) {
      const auto of_input = std::filesystem::path(input).parent_path();
      return same_file(folder, of_input.empty() ? "." : of_input.string());
    });
  };
  std::string folder = name;
  for (int number = 2; holds_input(folder); ++number) {
    folder = name + std::to_string(number);
  }
  return folder;
}

double cost_at_start(const TuneReport& report, std::size_t unknown) {
  if (unknown >= report.problem.parameters.size()) {
    return not_a_number;
  }
  const auto i = static_cast<Eigen::Index>(unknown);
  const Covariance& covariance = report.fit.covariance;
  const double moved =
      (report.fit.solution.x[i] - report.problem.parameters[unknown].start) / covariance.standard_errors[i];
  return std::sqrt(1.0 +
                   moved * moved * covariance.correlation_time / static_cast<double>(covariance.degrees_of_freedom));
}

}  // namespace hysteron::tool
