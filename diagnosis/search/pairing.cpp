#include "diagnosis/search/pairing.hpp"

#include <map>
#include <set>
#include <string>
#include <utility>

#include "diagnosis/model/parallel.hpp"
#include "diagnosis/search/fitting.hpp"

namespace hysteron::diagnosis {
namespace {

/// Strengths up to so many times those that were screened.
constexpr double range = 5.0;
/// What goes with one that is best by itself is seen when it gets a second effect: here are those that hide.
constexpr int most_times = 3;

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
  std::vector<std::string> effects;
  effects.reserve(singles.size());
  for (const Screened& single : singles) {
    effects.push_back(single.candidate.own().effect);
  }
  return different_pairs(Superposition(changes, background).pairs(range), effects, count);
}

std::vector<Superposition::Pair> different_pairs(const std::vector<Superposition::Pair>& ranked,
                                                 const std::vector<std::string>& effects, std::size_t count) {
  std::vector<Superposition::Pair> pairs;
  std::set<std::set<std::string>> taken;
  std::map<Index, int> times;
  for (const Superposition::Pair& one : ranked) {
    std::set<std::string> names{effects[static_cast<std::size_t>(one.first)],
                                effects[static_cast<std::size_t>(one.second)]};
    if (pairs.size() < count && names.size() == 2 && times[one.first] < most_times && times[one.second] < most_times &&
        taken.insert(std::move(names)).second) {
      ++times[one.first];
      ++times[one.second];
      pairs.push_back(one);
    }
  }
  return pairs;
}

}  // namespace hysteron::diagnosis
