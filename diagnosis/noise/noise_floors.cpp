#include "diagnosis/noise/noise_floors.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "diagnosis/model/least_squares.hpp"
#include "diagnosis/model/task.hpp"
#include "diagnosis/noise/glitches.hpp"

namespace hysteron::diagnosis {

std::vector<NoiseFloor> noise_floors(Task task, const Program& program,
                                     const std::vector<std::vector<Signal>>& others) {
  task.scales.clear();
  std::vector<NoiseFloor> floors;
  std::vector<std::vector<std::size_t>> glitches;  // by output
  {
    const Model model(task, program);
    const std::vector<Experiment>& experiments = model.problem().experiments;
    const Index rows = model.rows() / std::ssize(task.outputs);
    for (std::size_t output = 0; output < task.outputs.size(); ++output) {
      glitches.push_back(find_glitches(experiments, output).rows);
      floors.push_back(noise_floor_without(glitches.back(), experiments, output, others));
      task.scales.push_back(floors.back().value);
      for (const std::size_t row : glitches.back()) {
        task.left_out.push_back(static_cast<Index>(output) * rows + static_cast<Index>(row));
      }
    }
  }
  if (std::ranges::none_of(floors, [](const NoiseFloor& floor) { return floor.evidence == "dwells"; })) {
    return floors;
  }
  // A gap need not be closed for this: all that counts is whether the machine rings as its model does.
  Model model(task, program);
  const Fit calibrated = fit(model, model.start(), {.iterations = 20});
  if (!std::isfinite(calibrated.cost)) {
    return floors;
  }
  const std::vector<Experiment>& experiments = model.problem().experiments;
  for (std::size_t output = 0; output < floors.size(); ++output) {
    if (floors[output].evidence == "dwells") {
      floors[output] = noise_floor_without(glitches[output], experiments, output, others,
                                           by_record(task, calibrated.residuals, output));
    }
  }
  return floors;
}

}  // namespace hysteron::diagnosis
