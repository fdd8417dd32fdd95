// The sets that the search fitted, held against the one that the evidence tells.
//
// The evidence compares laws, and what is no law is not among them: what converters, clocks and loggers do. A law that
// resembles it wins then. So where the search has fitted a set with such an effect, in a place that makes sense for it,
// and that set leaves less of the records than the evidence's own set as it was fitted, these are compared by one
// measure: ln of the energy that fits leave on blocks which they did not see (held_out.hpp), under weights drawn for
// the blocks, under an error that goes with the families, and with the price of each effect.
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
  std::string top{};
  unsigned threads = 2;
  std::uint64_t seed = 1;
};

/// `of_laws` is the set of the evidence, fitted over whole records, or the calibrated diagram where it closes nothing
/// there. Nothing where no such set leaves less, where none of them is more probable than that one, or where what
/// stands first in the most probable one is a law, too: laws have been compared.
[[nodiscard]] std::optional<FittedEvidence> fitted_evidence(const Task& task, const Search& search,
                                                            const Explanation& of_laws,
                                                            const FittedEvidenceOptions& options, const Rules& rules);

}  // namespace hysteron::diagnosis
