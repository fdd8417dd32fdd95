// Which set of effects is chosen: the best of the search, or one that says more of the same cause.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "diagnosis/stages/hypotheses.hpp"

namespace hysteron::diagnosis {

struct Judged {
  Cleaned record{};
  std::unique_ptr<Searched> searched{};  ///< its judgement points into its search and into `instead`
  std::vector<std::shared_ptr<const Explanation>> instead{};
  std::optional<Unrepeatable> unrepeatable{};
  Evidence evidence{};                ///< see weighed.hpp; empty where it was not asked
  std::optional<GapBudget> budget{};  ///< see weighed.hpp; empty where there is no gap
  std::optional<LoopFinding> loop{};  ///< see weighed.hpp; empty where no controller sets the input
  bool is_related = true;             ///< the calibrated diagram follows the record at least a little
  std::size_t tried = 0;
  std::vector<std::string> warnings{};

  /// Another set than the weights chose.
  void choose(const Explanation& one);

  [[nodiscard]] const Judgement& judgement() const { return searched->judgement; }
  [[nodiscard]] const Explanation& calibrated() const { return searched->search.calibrated; }
  [[nodiscard]] const Explanation& chosen() const { return *judgement().chosen; }
  /// Of the chosen set, without what no diagram repeats.
  [[nodiscard]] const VectorXd& residuals() const {
    return unrepeatable ? unrepeatable->residuals : chosen().fit.residuals;
  }
};

[[nodiscard]] Judged judged(Hypotheses found, const DiagnosisOptions& options, Budget& budget);

}  // namespace hysteron::diagnosis
