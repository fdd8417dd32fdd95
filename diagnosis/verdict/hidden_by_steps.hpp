// What a sensor of coarse steps hides: where a signal lies near the threshold between two steps, rounding makes a whole
// step of a small error.
#pragma once

#include <optional>

#include "diagnosis/search/fitting.hpp"
#include "diagnosis/verdict/verdict.hpp"

namespace hysteron::diagnosis {

/// Of an output that shows coarse steps, a measured value says that the signal lay within half a step of it. Beside an
/// explanation that has a quantiser, the residuals of such an output are then what the signal before the quantiser lies
/// farther off. Nothing where no output has such steps, or where that is no less than what rounding leaves.
[[nodiscard]] std::optional<Unrepeatable> hidden_by_steps(const Task& task, const Explanation& calibrated,
                                                          const Explanation& chosen);

}  // namespace hysteron::diagnosis
