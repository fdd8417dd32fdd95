// The sets that the search fitted, held against the one that the evidence tells.
//
// The evidence compares laws, to first order in what they add. What is no law is not among them: a sensor's steps, a
// clock, a limit that bends what comes behind it. Where the search has fitted a set that leaves less of the records
// than the evidence's own set as it was fitted, all of them are compared by the same measure: ln of the energy that
// fits leave on blocks which they did not see (held_out.hpp), under weights drawn for the blocks, under an error that
// goes with the families, and with the price of each effect.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "diagnosis/evidence/law_findings.hpp"
#include "diagnosis/rules.hpp"
#include "diagnosis/search/search.hpp"

namespace hysteron::diagnosis {

struct FittedEvidence {
  Evidence evidence{};
  const Explanation* chosen = nullptr;  ///< the most probable set that has the first family
};

struct FittedEvidenceOptions {
  unsigned threads = 2;
  std::uint64_t seed = 1;
};

/// `of_laws` is the set of the evidence, fitted over whole records, or the calibrated diagram where it closes nothing
/// there. Nothing where no set of the search leaves less, or where none of them is more probable than that one.
[[nodiscard]] std::optional<FittedEvidence> fitted_evidence(const Task& task, const Search& search,
                                                            const Explanation& of_laws,
                                                            const FittedEvidenceOptions& options, const Rules& rules);

}  // namespace hysteron::diagnosis
