#include "diagnosis/verdict/varying_delay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "diagnosis/noise/discrepancy.hpp"
#include "diagnosis/search/expansion.hpp"
#include "diagnosis/search/loop_noise.hpp"
#include "diagnosis/search/sets.hpp"
#include "diagnosis/verdict/jitter.hpp"

namespace hysteron::diagnosis {
namespace {

/// Of the energy that the chosen set leaves, what its delay's variation may leave, or that of a smaller set, and what
/// that of another set may, whose constant delay leaves more.
constexpr double most_left = 0.6;
constexpr double most_left_by_another = 0.25;
/// A residual of which this share is foretold by inputs and outputs has another cause.
constexpr double foretold = 0.2;
/// Residuals of so many floors' energy are no gap.
constexpr double is_noise = 1.3;
/// Of the mean, what a delay varies by at most: one that varies more is something else.
constexpr double most_varied = 0.7;
/// The evenness of a variation, or one over it, at least.
constexpr double least_even = 0.3;
/// Where a linear filter explains so much of it, the machine has another filter than a delay, and none that varies.
constexpr double most_filtered = 0.4;
/// Of sets with a delay so many are tried, none that leaves more than so many times what the chosen one leaves.
constexpr std::size_t most_sets = 4;
constexpr double far_behind = 4.0;
/// On another edge a constant delay does nearly the same; one that leaves more than so many times has no place there.
constexpr double misplaced = 1.5;
/// Of what a variation at the set's own edge leaves, what one elsewhere may leave: behind a gain it is the same one.
constexpr double elsewhere = 0.95;
constexpr int steps_when_moved = 8;
/// A usual variation, by which the residuals are whitened before its size is known, of the mean.
constexpr double usual = 0.2;
constexpr Index most_directions = 64;
/// So many edges for a delay, each with hundreds of rollouts, and so many sets beside it on each.
constexpr std::size_t most_edges = 3;
constexpr std::size_t most_kept = 3;
/// For a delay and nothing else, and how often its variation and its mean are fitted in turn.
constexpr std::size_t most_edges_alone = 6;
constexpr int rounds_alone = 2;

double mean_square(const VectorXd& residuals) {
  return residuals.squaredNorm() / static_cast<double>(std::max<Index>(1, residuals.size()));
}

/// Whether inputs and outputs foretell the residual of an output.
bool is_foretold(const Task& task, const std::string& top, const Explanation& one) {
  const Model model(task, *without_noise(one, top).variant.program, one.variant.further);
  const Index rows = model.rows() / std::ssize(task.outputs);
  for (Index output = 0; output < std::ssize(task.outputs); ++output) {
    const VectorXd own = one.fit.residuals.segment(output * rows, rows);
    if (mean_square(own) > is_noise && discrepancy(model.problem().experiments, own).share_low > foretold) {
      return true;
    }
  }
  return false;
}

/// A set with a delay, once its variation is known.
struct Varying {
  Explanation set{};
  Jitter jitter{};
  std::vector<bool> moves{};
};

class VaryingDelay {
 public:
  VaryingDelay(const Task& task, const std::string& top, const Search& search, double floor_cost,
               const SearchOptions& options, const Explanation& chosen)
      : task_(task),
        top_(top),
        search_(search),
        floor_cost_(floor_cost),
        options_(options),
        sets_(task, top, options.candidates),
        chosen_(chosen),
        chosen_left_(std::sqrt(mean_square(chosen.fit.residuals))) {}

  /// Null where no set has a delay that varies.
  std::shared_ptr<const Varying> find() {
    if (chosen_.variant.effects.size() > 1 || delay_of(chosen_) == nullptr) {
      try_alone();  // what one effect explains needs no second
    }
    if (explains_all()) {
      return best_;
    }
    for (const Explanation* const one : sets_with_delay()) {
      if (one == &chosen_) {
        try_on_each_edge(*one);
      } else if (!is_over()) {
        try_fitted(*one);
      }
    }
    if (!explains_all()) {
      try_beside();
    }
    return best_;
  }

 private:
  [[nodiscard]] bool is_over() const { return options_.is_over(); }

  [[nodiscard]] bool explains_all() const {
    return best_ && best_->jitter.everywhere * best_->jitter.everywhere < is_noise;
  }

  /// The best set that is a delay and nothing else; null where none was fitted.
  [[nodiscard]] const Explanation* delay_alone() const {
    const auto alone = std::ranges::find_if(search_.explanations, [](const Explanation& one) {
      return one.variant.effects.size() == 1 && delay_of(one) != nullptr;
    });
    return alone == search_.explanations.end() ? nullptr : &*alone;
  }

  /// The chosen set where it has a delay. Else those that have one and no more effects, the smallest first.
  [[nodiscard]] std::vector<const Explanation*> sets_with_delay() const {
    if (delay_of(chosen_) != nullptr) {
      return {&chosen_};
    }
    std::vector<const Explanation*> list;
    std::set<std::vector<std::string>> taken;
    for (std::size_t effects = 1; effects <= chosen_.variant.effects.size(); ++effects) {
      for (const Explanation& one : search_.explanations) {
        if (list.size() < most_sets && one.variant.effects.size() == effects && delay_of(one) != nullptr &&
            one.fit.cost < far_behind * chosen_.fit.cost && taken.insert(one.names()).second) {
          list.push_back(&one);
        }
      }
    }
    return list;
  }

  /// The set with its delay elsewhere, the best first, since a constant delay commutes with much that its variation
  /// does not.
  [[nodiscard]] std::vector<Explanation> on_other_edges(const Explanation& one) const {
    const auto at = static_cast<std::size_t>(delay_of(one) - one.variant.effects.data());
    std::vector<Explanation> list = sets_.on_each_edge(one, at, search_.calibrated.variant, steps_when_moved);
    std::erase_if(list, [&](const Explanation& moved) {
      return moved.places() == one.places() || !(moved.fit.cost < misplaced * one.fit.cost);
    });
    std::ranges::stable_sort(list, {}, cost_of_fit);
    list.resize(std::min(list.size(), most_edges - 1));
    return list;
  }

  void try_on_each_edge(const Explanation& one) {
    try_fitted(one);
    for (const Explanation& moved : on_other_edges(one)) {
      try_fitted(moved, elsewhere);
    }
  }

  void try_fitted(const Explanation& one, double of_best = 1.0) {
    if (!is_foretold(task_, top_, one)) {
      try_set(one, of_best);
    }
  }

  /// What the RMS has to be below that a set's variation leaves.
  [[nodiscard]] double limit_of(const Explanation& one) const {
    const bool simple = one.names() == chosen_.names() || one.variant.effects.size() < chosen_.variant.effects.size();
    return std::sqrt(simple ? most_left : most_left_by_another) * chosen_left_;
  }

  /// It becomes the best where it leaves little enough of what the chosen set does, or less than `of_best` of what the
  /// best so far leaves.
  void try_set(const Explanation& one, double of_best = 1.0) {
    const std::optional<JitterResponse> response = response_to_jitter(task_, top_, one, options_.threads);
    if (!response) {
      return;
    }
    const Jitter jitter = jitter_of(task_, *response, one.fit.residuals);
    const bool larger = best_ && one.variant.effects.size() > best_->set.variant.effects.size();
    const double limit = best_ ? (larger ? std::sqrt(most_left) : of_best) * best_->jitter.everywhere : limit_of(one);
    if (jitter.everywhere < limit && is_random(one, jitter)) {
      best_ = std::make_shared<const Varying>(one, jitter, response->moves);
    }
  }

  [[nodiscard]] bool is_random(const Explanation& one, const Jitter& jitter) const {
    return jitter.deviation < most_varied * mean_delay(task_, one) && jitter.evenness > least_even &&
           jitter.evenness * least_even < 1.0 && jitter.filtered < most_filtered;
  }

  /// The delay and nothing else, on each of its edges, fitted to residuals that are whitened of its own variation: that
  /// adds up behind integrators, and a plain fit bends the mean and the known parameters after where it has led.
  void try_alone() {
    const Explanation* const alone = delay_alone();
    if (alone == nullptr || is_over()) {
      return;
    }
    std::vector<Explanation> list = sets_.on_each_edge(*alone, 0, search_.calibrated.variant, steps_when_moved);
    std::ranges::stable_sort(list, {}, cost_of_fit);
    list.resize(std::min(list.size(), most_edges_alone));
    for (Explanation& one : list) {
      double deviation = usual * mean_delay(task_, one);
      for (int round = 0; round < rounds_alone && deviation > 0.0 && !is_over(); ++round) {
        const std::optional<JitterResponse> response = response_to_jitter(task_, top_, one, options_.threads);
        if (!response || !fit_whitened(one, *response, deviation)) {
          break;
        }
        deviation = jitter_of(task_, *response, one.fit.residuals).deviation;
      }
      consider_alone(std::move(one));
    }
  }

  /// Fits a set to residuals whitened of a variation; its own residuals stay those of the record.
  [[nodiscard]] bool fit_whitened(Explanation& one, const JitterResponse& response, double deviation) const {
    Task whitened = task_;
    whitened.whitening = std::make_shared<const Whitening>(deviation * response.columns, most_directions);
    Model model(whitened, *one.variant.program, one.variant.further);
    one.fit = fit(model, one.fit.x);
    return std::isfinite(one.fit.cost) && set_plain(one);
  }

  /// Residuals and cost as the record has them, at the parameters of a whitened fit.
  [[nodiscard]] bool set_plain(Explanation& one) const {
    Model plain(task_, *one.variant.program, one.variant.further);
    if (!plain.residuals(one.fit.x, one.fit.residuals, &one.fit.jacobian)) {
      return false;
    }
    one.fit.cost = cost_of(plain, one.fit.x, one.fit.residuals, nullptr);
    return true;
  }

  /// It has to leave no more than noise. What the user gets has the known parameters that leave least beside that mean.
  void consider_alone(Explanation one) {
    const std::optional<JitterResponse> response = response_to_jitter(task_, top_, one, options_.threads);
    if (!response) {
      return;
    }
    Jitter jitter = jitter_of(task_, *response, one.fit.residuals);
    const double limit = best_ ? best_->jitter.everywhere : limit_of(one);
    if (!(jitter.everywhere * jitter.everywhere < is_noise) || !(jitter.everywhere < limit) ||
        !is_random(one, jitter)) {
      return;
    }
    std::vector<Unknown> held = one.variant.further;
    for (std::size_t j = 0; j < held.size(); ++j) {
      held[j].start = held[j].lower = held[j].upper = one.fit.x[std::ssize(task_.known) + static_cast<Index>(j)];
    }
    Model model(task_, *one.variant.program, held);
    one.fit = fit(model, one.fit.x);
    jitter.left = jitter_of(task_, *response, one.fit.residuals).left;
    best_ = std::make_shared<const Varying>(std::move(one), jitter, response->moves);
  }

  /// The delay by itself, with the residuals whitened of a usual variation, and each effect beside it.
  void try_beside() {
    const Explanation* const alone = delay_alone();
    if (alone == nullptr || options_.most_effects < 2 || is_over()) {
      return;
    }
    for (const Place& place : places_of(*alone)) {
      if (is_over()) {
        return;
      }
      Task whitened = task_;
      whitened.whitening = std::make_shared<const Whitening>(
          usual * mean_delay(task_, place.set) * place.response.columns, most_directions);
      std::vector<Explanation> found = one_more(whitened, place.set);
      found.resize(std::min(found.size(), most_kept));
      for (Explanation& one : found) {
        if (set_plain(one)) {
          try_set(one);
        }
      }
    }
  }

  /// Sets of one effect more, the best first.
  [[nodiscard]] std::vector<Explanation> one_more(const Task& whitened, Explanation from) const {
    Model model(whitened, *from.variant.program, from.variant.further);
    from.fit = fit(model, from.fit.x);
    const Footing footing{.calibrated = from};
    Expansion expansion(whitened, top_, footing, floor_cost_, options_);
    expansion.may_stop();
    std::vector<Explanation> found = expansion.of(from, any_effect, options_.fitted_later);
    std::ranges::stable_sort(found, {}, cost_of_fit);
    return found;
  }

  struct Place {
    Explanation set{};
    JitterResponse response{};
    double left = 0.0;  ///< see Jitter::everywhere
  };

  /// The edges for a delay by itself, first the one where its variation leaves least.
  [[nodiscard]] std::vector<Place> places_of(const Explanation& alone) const {
    std::vector<Explanation> sets = on_other_edges(alone);
    sets.insert(sets.begin(), alone);
    std::vector<Place> places;
    for (const Explanation& one : sets) {
      if (std::optional<JitterResponse> response = response_to_jitter(task_, top_, one, options_.threads)) {
        const double own = places.empty() ? 1.0 : 1.0 / elsewhere;
        const double left = own * jitter_of(task_, *response, one.fit.residuals).everywhere;
        places.push_back({.set = one, .response = std::move(*response), .left = left});
      }
    }
    std::ranges::stable_sort(places, {}, &Place::left);
    return places;
  }

  const Task& task_;
  const std::string& top_;
  const Search& search_;
  double floor_cost_;
  const SearchOptions& options_;
  Sets sets_;
  const Explanation& chosen_;
  double chosen_left_;
  std::shared_ptr<const Varying> best_{};
};

}  // namespace

std::optional<Unrepeatable> with_varying_delay(const Task& task, const std::string& top, const Search& search,
                                               double floor_cost, const SearchOptions& options, Judgement& judgement) {
  const Explanation& chosen = *judgement.chosen;
  if (chosen.variant.effects.empty() || mean_square(chosen.fit.residuals) < is_noise) {
    return std::nullopt;
  }
  const std::shared_ptr<const Varying> best = VaryingDelay(task, top, search, floor_cost, options, chosen).find();
  if (!best) {
    return std::nullopt;
  }
  const Explanation& set = best->set;
  const Jitter& jitter = best->jitter;
  choose_instead(task, set, judgement);
  Unrepeatable result{.residuals = set.fit.residuals, .set = {best, &set}};
  const Index rows = result.residuals.size() / std::ssize(task.outputs);
  for (Index output = 0; output < std::ssize(task.outputs); ++output) {
    if (best->moves[static_cast<std::size_t>(output)]) {
      result.residuals.segment(output * rows, rows) *= jitter.unexplained / jitter.left;
    }
  }
  result.remark = fmt::format(
      "The delay at {} varies by {:.3g} s RMS about its mean: of the {:.2g} floors that a constant one leaves, {:.2g} "
      "are no consequence of that.",
      in_the_diagram(delay_of(set)->edge, set.variant.effects), jitter.deviation, jitter.left, jitter.unexplained);
  return result;
}

}  // namespace hysteron::diagnosis
