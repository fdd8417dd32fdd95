// Where what is chosen leaves a cause, no set is true, and likelihoods say nothing of which effects are there: that is
// asked of stretches that no fit has seen.
#pragma once

#include "diagnosis/rules.hpp"
#include "diagnosis/stages/answer.hpp"

namespace hysteron::diagnosis {

/// With the evidence in it, and with its most probable set chosen, where it tells one; as it was where `answer` leaves
/// no cause.
[[nodiscard]] Judged weighed(Judged judged, const Answer& answer, const DiagnosisOptions& options, Rules& rules);

}  // namespace hysteron::diagnosis
