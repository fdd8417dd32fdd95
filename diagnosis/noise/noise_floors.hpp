// The noise floors of all measured outputs, from their measurements and from what the calibrated diagram leaves of
// them.
#pragma once

#include <vector>

#include "diagnosis/model/model.hpp"
#include "diagnosis/noise/noise_floor.hpp"

namespace hysteron::diagnosis {

/// By output; the task needs no scales. `others` as in noise_floor().
[[nodiscard]] std::vector<NoiseFloor> noise_floors(Task task, const Program& program,
                                                   const std::vector<std::vector<Signal>>& others);

}  // namespace hysteron::diagnosis
