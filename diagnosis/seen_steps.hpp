// A sensor's coarse steps show in the measured values themselves, whatever else there is. Beside an effect that no
// formula repeats, as a delay that varies, what they close in the residual may be too little to name them.
#pragma once

#include "diagnosis/fitting.hpp"
#include "diagnosis/model.hpp"

namespace hysteron::diagnosis {

/// Whether an output lies on steps, in each record, on which what the explanation says of it does not lie. Steps of
/// less than a fourteenth of its range count as noise, as with the noise floor.
[[nodiscard]] bool shows_steps(const Task& task, const Explanation& calibrated);

}  // namespace hysteron::diagnosis
