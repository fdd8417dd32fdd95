#include "diagnosis/findings/gaps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "diagnosis/findings/next_record.hpp"
#include "diagnosis/model/task.hpp"
#include "diagnosis/verdict/held_out.hpp"

namespace hysteron::diagnosis {

std::vector<GapFinding> gaps_of(const Task& task, const Graph& graph, const GapResiduals& residuals,
                                const std::vector<NoiseFloor>& floors, std::uint64_t seed) {
  const auto before = by_blocks(task, residuals.nominal);
  const auto after = by_blocks(task, residuals.held_out);
  std::vector<GapFinding> result;
  for (std::size_t output = 0; output < task.outputs.size(); ++output) {
    const Port& port = *find_port(graph.outputs, task.outputs[output]);
    GapFinding gap{.signal = port.name,
                   .unit = port.unit,
                   .nominal = rms_of(task, residuals.nominal, output),
                   .calibrated = rms_of(task, residuals.calibrated, output),
                   .improved = rms_of(task, residuals.kept, output),
                   .floor = floors[output]};
    const double left = gap.improved / task.scales[output];
    const Closure share = closure(before[output], after[output], left * left, noise_range(left), seed);
    gap.closed = share.closed;
    gap.closed_low = share.low;
    gap.closed_high = share.high;
    gap.next = next_record(after[output], floors[output].value / task.scales[output], task.scales[output]);
    result.push_back(std::move(gap));
  }
  return result;
}

std::size_t largest_gap(const Task& task, const std::vector<NoiseFloor>& floors, const VectorXd& residuals) {
  std::size_t largest = 0;
  const auto in_floors = [&](std::size_t output) { return rms_of(task, residuals, output) / floors[output].value; };
  for (std::size_t output = 1; output < task.outputs.size(); ++output) {
    largest = in_floors(output) > in_floors(largest) ? output : largest;
  }
  return largest;
}

bool calibration_matters(const Task& task, const std::vector<NoiseFloor>& floors, double material,
                         const VectorXd& nominal, const VectorXd& calibrated) {
  for (std::size_t output = 0; output < task.outputs.size(); ++output) {
    const double before = rms_of(task, nominal, output);
    const double after = rms_of(task, calibrated, output);
    const double closed = std::sqrt(std::max(0.0, before * before - after * after));
    if (closed > std::max(0.25 * floors[output].value, material)) {
      return true;
    }
  }
  return false;
}

std::vector<std::string> remarks_on_floors(const Task& task, const std::vector<NoiseFloor>& floors) {
  std::vector<std::string> remarks;
  for (std::size_t output = 0; output < floors.size(); ++output) {
    if (floors[output].evidence == "differences") {
      remarks.push_back(fmt::format(
          "The noise floor of {} rests on its fast part alone: no input repeats or dwells. Slow noise would count as a "
          "gap.",
          task.outputs[output]));
    }
  }
  return remarks;
}

}  // namespace hysteron::diagnosis
