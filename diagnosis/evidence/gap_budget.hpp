// Of which kind a gap is, before any effect has a name: what each kind of function of the measured signals could
// predict of it on stretches that its fit did not see.
//
//   closed(K) = 1 − Σ_b |r_b − J_b δ − Φ_b(K) α|² / Σ_b |r_b|²,   δ, α without block b
//
// r is what the calibrated diagram leaves, J the sensitivities of the known parameters, Φ(K) a general basis of the
// kind (gap_kinds.hpp): ridge regression, the ridge as it predicts best. Kinds overlap, as a creep is a filter and a
// course over time; so each has what it could close alone, what nothing else could, and its part of the whole, the mean
// of both over all kinds. A basis is finite: a bound for what is smooth over it, and no proof against an edge within.
#pragma once

#include <optional>
#include <string>

#include "diagnosis/evidence/blocks.hpp"
#include "diagnosis/evidence/law_findings.hpp"
#include "diagnosis/evidence/space.hpp"

namespace hysteron::diagnosis {

/// Of the signal that is missing, or of one measured output where a space compares at the outputs. Nothing where there
/// is no gap, or fewer than three blocks.
[[nodiscard]] std::optional<GapBudget> gap_budget(const Task& task, const Space& space, const std::string& name,
                                                  unsigned threads);

}  // namespace hysteron::diagnosis
