// The answer as the user reads it: effects with numbers, rivals, the improved diagram, pictures, what to do next.
#pragma once

#include "diagnosis/diagnosis.hpp"
#include "diagnosis/stages/answer.hpp"

namespace hysteron::diagnosis {

[[nodiscard]] Diagnosis told(const Judged& judged, const Answer& answer, const DiagnosisOptions& options, Rules& rules);

/// Of a record that cannot be diagnosed.
[[nodiscard]] Diagnosis refused(const Cleaned& record);

}  // namespace hysteron::diagnosis
