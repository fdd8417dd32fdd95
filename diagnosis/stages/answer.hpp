// What is said of the gap: nothing is missing, a parameter, an effect, several that could be, or something unknown.
#pragma once

#include <cstddef>
#include <vector>

#include "diagnosis/stages/judged.hpp"

namespace hysteron::diagnosis {

struct Answer {
  Verdict verdict = Verdict::Unknown;
  double unknown_score = 1.0;
  std::size_t gap_output = 0;   ///< see Findings
  std::vector<double> noise{};  ///< of each output what may be noise, in floors
  double predictable = 0.0;     ///< see Findings
  double unexplained = 0.0;     ///< likewise

  /// Whether the verdict names effects.
  [[nodiscard]] bool is_named() const {
    return verdict == Verdict::Named || verdict == Verdict::Group || verdict == Verdict::Partial;
  }
};

[[nodiscard]] Answer answer_of(const Judged& judged, const DiagnosisOptions& options, Rules& rules);

}  // namespace hysteron::diagnosis
