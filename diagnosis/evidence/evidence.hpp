// Which effects are there: sets of laws, held against each other by what they predict of blocks that no fit has seen.
//
// What is compared is ln of the energy that a set leaves on the blocks held out, each block by a fit without it, of the
// energy that the calibrated diagram leaves there. The probability of a set, and of a family of effects, is how often
// it is the best under weights that are drawn for the blocks (Rubin's Bayesian bootstrap) and under an error that all
// blocks have in common, since no formula is quite the machine's.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "diagnosis/evidence/law_findings.hpp"
#include "diagnosis/search/fitting.hpp"

namespace hysteron::diagnosis {

struct EvidenceOptions {
  std::vector<std::string> effects{};  ///< identifiers; empty: all
  std::vector<std::string> columns{};  ///< of the records that the diagram does not use
  unsigned threads = 2;
  std::uint64_t seed = 1;
};

/// Whether what a set leaves is neither noise, whose cost is `floor_cost`, nor the little by which a formula errs: then
/// no set is true, and its likelihood says nothing of which effects are there.
[[nodiscard]] bool leaves_a_cause(const Explanation& chosen, const Explanation& calibrated, double floor_cost);

/// Of a diagram as calibrated, with residuals and sensitivities.
[[nodiscard]] Evidence evidence_of(const Task& task, const std::string& top, const Explanation& calibrated,
                                   const EvidenceOptions& options);

}  // namespace hysteron::diagnosis
