// From the sets of effects that were fitted to a verdict: which of them the data call for, which they do not rule out,
// and whether anything is left that none explains.
//
// Sets are weighed by their likelihood with the noise level left open, on as many samples as the correlated residuals
// are worth, less a penalty for each parameter and for each candidate that was tried:
//
//   L(S) = −½ N' log C(S) − ½ k log N' − |S| log T,   N' = N/τ of the best set's residuals
//
// An effect is part of the verdict if its set is the best, if it closes a notable share of the gap, if it does so on
// blocks held out, and if it moves the output notably.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "diagnosis/diagnosis.hpp"
#include "diagnosis/search/search.hpp"
#include "diagnosis/verdict/held_out.hpp"

namespace hysteron::diagnosis {

/// Sets whose support lies within this of the best are not ruled out: odds of some 1 : 50.
inline constexpr double rival_within = 4.0;

struct Weighed {
  const Explanation* explanation = nullptr;
  double support = 0.0;  ///< L(S) less that of the best

  /// How probable it is, of that of the best.
  [[nodiscard]] double weight() const { return std::exp(std::min(0.0, support)); }
};

/// Of each, among all of them: the weights, to a sum of 1.
[[nodiscard]] std::vector<double> probabilities(std::span<const Weighed> rivals);

struct Judgement {
  const Explanation* chosen = nullptr;  ///< never null: the calibrated diagram, where no effect holds
  std::vector<Weighed> rivals{};        ///< one for each set of identifiers, best first, those not ruled out
  std::vector<Weighed> fitted{};        ///< all sets, best first
  std::vector<Weighed> same{};          ///< other edges for the chosen set
  double effective_samples = 0.0;
  double weighing_samples = 0.0;  ///< N' of L(S): of these no more than a likelihood is to count
  VectorXd held_out{};            ///< residuals of the chosen set on what its fits have not seen
  double significance = 0.0;      ///< of the chosen set against the calibrated diagram, nats
};

/// Of the chosen set among its rivals, with those that are the same in a simpler or a richer formula; 1 without rivals.
[[nodiscard]] double probability_of_cause(const Judgement& judgement);

/// What a machine does that no diagram repeats, counted as explained: steps of unequal widths, a delay that varies.
struct Unrepeatable {
  VectorXd residuals{};                      ///< of all outputs, without it
  std::string remark{};                      ///< for the user
  std::shared_ptr<const Explanation> set{};  ///< what was chosen for it, where the search had it not
};

/// Another set than the weights chose, which has no rivals then.
void choose_instead(const Task& task, const Explanation& one, Judgement& judgement);

/// L(S) above, of a fit with so many parameters beside those of the calibrated diagram, after so many candidates.
[[nodiscard]] double support_of(double cost, Index parameters, std::size_t effects, double samples, std::size_t tried);

/// `floor_cost` as in search().
[[nodiscard]] Judgement judge(const Task& task, const Search& search, double floor_cost);

/// A search with its judgement, which points into it.
struct Searched {
  Searched(const Task& task, Search found, double floor_cost)
      : search(std::move(found)), judgement(judge(task, search, floor_cost)) {}
  Search search;
  Judgement judgement;
};

}  // namespace hysteron::diagnosis
