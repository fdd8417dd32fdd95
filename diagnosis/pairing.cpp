#include "diagnosis/pairing.hpp"

#include <set>
#include <string>
#include <utility>

#include "diagnosis/fitting.hpp"
#include "diagnosis/parallel.hpp"

namespace hysteron::diagnosis {
namespace {

/// Strengths up to so many times those that were screened.
constexpr double range = 5.0;

}  // namespace

std::vector<Superposition::Pair> pairs_that_add_up(const Task& task, const std::vector<Screened>& singles,
                                                   const VectorXd& known, const Background& background,
                                                   std::size_t count, unsigned threads) {
  MatrixXd changes = MatrixXd::Zero(background.residuals().size(), std::ssize(singles));
  in_parallel(singles.size(), threads, [&](std::size_t i) {
    const Explanation one = placed(task, singles[i], singles[i].starts.front(), known);
    Model alone(task, *one.variant.program, one.variant.further);
    VectorXd residuals;
    if (alone.residuals(one.fit.x, residuals)) {
      changes.col(static_cast<Index>(i)) = residuals - background.residuals();
    }
  });
  const auto effect_of = [&](Index single) -> const std::string& {
    return singles[static_cast<std::size_t>(single)].candidate.own().effect;
  };
  std::vector<Superposition::Pair> pairs;
  std::set<std::set<std::string>> taken;
  for (const Superposition::Pair& one : Superposition(changes, background).pairs(range)) {
    std::set<std::string> names{effect_of(one.first), effect_of(one.second)};
    if (pairs.size() < count && names.size() == 2 && taken.insert(std::move(names)).second) {
      pairs.push_back(one);
    }
  }
  return pairs;
}

}  // namespace hysteron::diagnosis
