// The search for the effects that close the gap: screening, fits, sets of several effects.
//
// 1. The known parameters alone are fitted: what that closes is calibration.
// 2. Every candidate is screened against what is left; the best are fitted together with the known parameters,
//    those of the three effects in front on up to eight edges more.
// 3. Where the plant integrates, effects and pairs are looked for on stretches of the records (stretches.hpp), and the
//    best sets fitted over the whole. Where none of these comes near the floor, pairs whose changes would add up to the
//    residual are fitted. Where one of them closes the gap, each of its effects gives its place to all others once, to
//    see which close it, too.
// 4. Else to the best sets, in a beam, one effect more is added as in 2, while it closes a notable part of the gap. The
//    effects of the best pairs give their places to all others, are moved to other edges, and give their places again.
// Every set that was fitted is kept: the verdict weighs them against each other.
#pragma once

#include <string>
#include <vector>

#include "diagnosis/search/fitting.hpp"
#include "diagnosis/search/search_options.hpp"

namespace hysteron::diagnosis {

struct Search {
  Explanation calibrated{};                 ///< no effect, known parameters fitted
  std::vector<Explanation> explanations{};  ///< with effects, best first
  std::size_t tried = 0;                    ///< candidates over all rounds
};

/// What the last effect of a set of so many has to close, as ½Σr²: a notable share of the gap; for the first two also
/// what stands well above the noise, however large the gap is. A third one there would be for what the formulas of two
/// leave.
[[nodiscard]] double least_gain(double calibrated_cost, double floor_cost, std::size_t effects);

/// `floor_cost` is ½Σr² of noise alone: what no effect can close.
[[nodiscard]] Search search(const Task& task, Variant base, const std::string& top, double floor_cost,
                            const SearchOptions& options);

}  // namespace hysteron::diagnosis
