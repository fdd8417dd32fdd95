// How much of a gap each effect has, and what is open.
#pragma once

#include <string>
#include <vector>

#include "diagnosis/findings/findings.hpp"

namespace hysteron::diagnosis {

/// Shapley shares of the effects of a set in what the set closes, from the sets that were fitted.
[[nodiscard]] std::vector<double> shares_of(const Findings& findings, const Explanation& chosen);

/// What the effects could close of what calibration leaves, ½Σr² in deviations of the noise.
[[nodiscard]] double gap_energy(const Findings& findings);

/// An effect more, of so much energy that is not in the gap yet, to others whose shares are of it: all shares become
/// those of the gap with it, which is returned.
[[nodiscard]] double add_share(std::vector<EffectFinding>& effects, double gap, EffectFinding more, double energy);

/// `edges` are those of the diagram as given, `ports` its inputs and outputs.
[[nodiscard]] GapSplit split_of(const std::vector<EffectFinding>& effects, const std::vector<Edge>& edges,
                                const std::vector<std::string>& ports);

}  // namespace hysteron::diagnosis
