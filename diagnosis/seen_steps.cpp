#include "diagnosis/seen_steps.hpp"

#include <algorithm>
#include <functional>
#include <vector>

#include "diagnosis/spectrum.hpp"
#include "diagnosis/task.hpp"

namespace hysteron::diagnosis {
namespace {

/// Of the noise floor, what the steps round off at least: where it is theirs, they are as any sensor's.
constexpr double beyond_noise = 1.3;

bool on_coarse_steps(const Signal& measured, const Signal& beyond, double floor) {
  const double step = common_step(measured);
  if (rounded_off(step) <= beyond_noise * floor) {
    return false;
  }
  std::vector<double> foretold = measured;
  std::ranges::transform(measured, beyond, foretold.begin(), std::plus<>());
  return alignment(foretold, step) < 0.5 * alignment(measured, step);
}

}  // namespace

bool shows_steps(const Task& task, const Explanation& calibrated) {
  for (std::size_t output = 0; output < task.outputs.size(); ++output) {
    const RecordSignals beyond = by_record(task, calibrated.fit.residuals, output);
    bool on_steps = true;
    for (std::size_t record = 0; on_steps && record < task.records.size(); ++record) {
      const Signal& measured = task.records[record].column(task.outputs[output]).values;
      on_steps = on_coarse_steps(measured, beyond[record], task.scales[output]);
    }
    if (on_steps) {
      return true;
    }
  }
  return false;
}

}  // namespace hysteron::diagnosis
