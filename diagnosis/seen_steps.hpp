// A sensor's coarse steps show in the measured values themselves, whatever else there is. Beside an effect that no
// formula repeats, as a delay that varies, what they close in the residual may be too little to name them.
#pragma once

#include "diagnosis/fitting.hpp"
#include "diagnosis/model.hpp"

namespace hysteron::diagnosis {

/// Whether an output lies on steps, in each record, on which what the explanation says of it does not lie. Steps that
/// round off less than 1.3 times the noise floor do not count: a floor that holds the rounding of a sensor is as large.
[[nodiscard]] bool shows_steps(const Task& task, const Explanation& calibrated);

}  // namespace hysteron::diagnosis
