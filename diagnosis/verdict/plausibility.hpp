// Whether a fitted diagram can be believed to be the machine of the record at all: no effect is named where it is not.
#pragma once

#include <string>
#include <vector>

#include "diagnosis/search/fitting.hpp"

namespace hysteron::diagnosis {

/// Where the calibrated diagram follows next to nothing of what any output does, and the chosen effects do not make up
/// for it, as a load that is larger than all else or a resonance in the middle of the band would: what to say of it,
/// else empty.
[[nodiscard]] std::string unrelated(const Task& task, const Explanation& calibrated, const Explanation& chosen,
                                    double effective_samples);

/// Known parameters that a fit has driven far off their tuned values, several deviations of the prior: what to say of
/// each.
[[nodiscard]] std::vector<std::string> far_parameters(const Task& task, const Explanation& chosen);

}  // namespace hysteron::diagnosis
