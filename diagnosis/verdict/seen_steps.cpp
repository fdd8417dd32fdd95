#include "diagnosis/verdict/seen_steps.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <vector>

#include "diagnosis/model/task.hpp"
#include "diagnosis/noise/spectrum.hpp"

namespace hysteron::diagnosis {
namespace {

/// Of the noise floor, what the steps round off at least: where it is theirs, they are as any sensor's.
constexpr double beyond_noise = 1.3;

/// Whether values lie on enough of the steps: two levels at which a signal rests are on the steps of any part of their
/// distance.
bool visits_many(const Signal& values, double step) {
  constexpr std::size_t fewest = 4;
  constexpr double notable = 0.005;  // of the values
  std::map<long long, std::size_t> counts;
  for (const double value : values) {
    ++counts[std::llround(value / step)];
  }
  const double least = notable * static_cast<double>(values.size());
  return static_cast<std::size_t>(std::ranges::count_if(
             counts, [&](const auto& level) { return static_cast<double>(level.second) > least; })) >= fewest;
}

/// 0 where it lies on none.
double coarse_step(const Signal& measured, const Signal& beyond, double floor) {
  std::vector<double> foretold = measured;
  std::ranges::transform(measured, beyond, foretold.begin(), std::plus<>());
  for (const double step : clear_steps(measured)) {
    if (rounded_off(step) > beyond_noise * floor && alignment(foretold, step) < 0.5 * alignment(measured, step) &&
        visits_many(measured, step)) {
      return step;
    }
  }
  return 0.0;
}

/// The largest of all records; 0 where one lies on none.
double coarse_step_of(const Task& task, const Explanation& calibrated, std::size_t output) {
  const RecordSignals beyond = by_record(task, calibrated.fit.residuals, output);
  double largest = 0.0;
  for (std::size_t record = 0; record < task.records.size(); ++record) {
    const Signal& measured = task.records[record].column(task.outputs[output]).values;
    const double step = coarse_step(measured, beyond[record], task.scales[output]);
    if (step == 0.0) {
      return 0.0;
    }
    largest = std::max(largest, step);
  }
  return largest;
}

}  // namespace

std::vector<double> seen_steps(const Task& task, const Explanation& calibrated) {
  std::vector<double> steps;
  for (std::size_t output = 0; output < task.outputs.size(); ++output) {
    steps.push_back(coarse_step_of(task, calibrated, output));
  }
  return steps;
}

bool shows_steps(const Task& task, const Explanation& calibrated) {
  return std::ranges::any_of(seen_steps(task, calibrated), [](double step) { return step > 0.0; });
}

}  // namespace hysteron::diagnosis
