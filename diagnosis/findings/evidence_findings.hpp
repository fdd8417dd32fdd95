// The evidence as the user reads it: effects with their numbers, rivals, the sentence that an engineer would say.
#pragma once

#include <string>

#include "diagnosis/diagnosis.hpp"
#include "diagnosis/rules.hpp"

namespace hysteron::diagnosis {

/// The effects of the most probable set, its rivals, and the probability of the first family as the confidence. Effects
/// that the fitted diagram holds keep the numbers of its fit.
void tell(const Evidence& evidence, const Rules& rules, Diagnosis& result);

/// That the first family is a cause, and that what the set predicts is what is missing.
[[nodiscard]] double confidence_of(const Evidence& evidence, const SetFinding& set);

/// "Dry friction at SPEED.XIN (coulomb_friction) explains 80 % of the gap on stretches not fitted, …"
[[nodiscard]] std::string sentence_of(const Diagnosis& found, const Rules& rules);

/// dry_friction as "dry friction".
[[nodiscard]] std::string words_of_family(const std::string& family);

}  // namespace hysteron::diagnosis
