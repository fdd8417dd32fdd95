#include "diagnosis/verdict/hidden_by_steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

#include "diagnosis/model/task.hpp"
#include "diagnosis/verdict/seen_steps.hpp"

namespace hysteron::diagnosis {

std::optional<Unrepeatable> hidden_by_steps(const Task& task, const Explanation& calibrated,
                                            const Explanation& chosen) {
  if (std::ranges::count(chosen.variant.further, true, &Unknown::rounds) == 0) {
    return std::nullopt;
  }
  const std::vector<double> steps = seen_steps(task, calibrated);
  Task within = task;
  std::ranges::transform(steps, std::back_inserter(within.cells), [](double step) { return 0.5 * step; });
  Model model(within, *chosen.variant.program, chosen.variant.further);
  VectorXd beyond;
  if (!model.residuals(model.smooth(chosen.fit.x), beyond)) {
    return std::nullopt;
  }
  Unrepeatable result{.residuals = chosen.fit.residuals};
  const Index rows = model.rows() / std::ssize(task.outputs);
  for (std::size_t output = 0; output < steps.size(); ++output) {
    const auto own = beyond.segment(static_cast<Index>(output) * rows, rows);
    auto kept = result.residuals.segment(static_cast<Index>(output) * rows, rows);
    if (steps[output] > 0.0 && own.squaredNorm() < kept.squaredNorm()) {
      const double rounded = rms_of(task, result.residuals, output);
      kept = own;
      result.remark = fmt::format(
          "{} comes in steps of {:.4g}: near their thresholds a small error is a whole step. {:.3g} RMS is left, and "
          "{:.3g} of it farther than half a step off.",
          task.outputs[output], steps[output], rounded, rms_of(task, result.residuals, output));
    }
  }
  return result.remark.empty() ? std::nullopt : std::optional(std::move(result));
}

}  // namespace hysteron::diagnosis
