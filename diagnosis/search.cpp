#include "diagnosis/search.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <functional>
#include <iterator>
#include <mutex>
#include <optional>
#include <set>
#include <utility>

#include "diagnosis/drivers.hpp"
#include "diagnosis/line_start.hpp"
#include "diagnosis/pairing.hpp"
#include "diagnosis/parallel.hpp"
#include "diagnosis/refusal.hpp"
#include "diagnosis/sets.hpp"
#include "diagnosis/shortlist.hpp"
#include "diagnosis/spectrum.hpp"
#include "diagnosis/superposition.hpp"
#include "tuning/covariance.hpp"

namespace hysteron::diagnosis {
namespace {

/// So many of the best fits of a round go to the end in any case.
constexpr std::size_t finished_always = 6;
/// Of what a straight line leaves of the tuned parameters' part, a bent one leaves less than this where it is bent.
constexpr double straight_enough = 0.5;
/// One point in so many of a long grid comes first.
constexpr std::size_t stride = 3;
/// Of a period many are tried: the one that a straight line favours before a fit is often not the one.
std::size_t starts_kept(const Applied& effect) {
  return effect.has(Role::Period) ? 6 : 3;
}

/// What a fit has to gain, in nats, to be followed further: a verdict asks for 6 beyond the penalties, which are as
/// many.
constexpr double more_than_chance = 10.0;

/// A pair whose cost is below so many of the floor's closes the gap: no third effect is tried beside it.
constexpr double well_closed = 1.3;

/// One whose cost is above so many of the best one's is not followed.
constexpr double pair_far_behind = 3.0;
/// Costs above this many of the floor's are a gap, however little one effect alone gains on it.
constexpr double surely_a_gap = 2.0;

/// What a fit gains in log likelihood with the noise left open, on as many samples as its residuals are worth.
double nats_gained(double cost_before, const Fit& fit) {
  const double samples = static_cast<double>(fit.residuals.size()) / std::max(1.0, correlation_time(fit.residuals));
  return 0.5 * samples * std::log(cost_before / std::max(fit.cost, 1e-300));
}

double cost_of_fit(const Explanation& one) {
  return one.fit.cost;
}
const Explanation& best_of(const std::vector<Explanation>& found) {
  return *std::ranges::min_element(found, {}, cost_of_fit);
}

class Searcher {
 public:
  Searcher(const Task& task, const std::string& top, double floor_cost, const SearchOptions& options)
      : task_(task), top_(top), floor_cost_(floor_cost), sets_(task, top, options.candidates), options_(options) {}

  Search run(Variant base) {
    Search result;
    say(0.0, "calibration");
    result.calibrated.variant = std::move(base);
    Model model(task_, *result.calibrated.variant.program);
    result.calibrated.fit = fit(model, model.start(), {.iterations = 40, .tolerance = 1e-7});
    Explanation nominal = result.calibrated;
    nominal.fit.x = model.start();
    tuned_ = nominal.fit.x.head(std::ssize(task_.known));
    (void)model.residuals(nominal.fit.x, nominal.fit.residuals, &nominal.fit.jacobian);
    nominal.fit.cost = cost_of(model, nominal.fit.x, nominal.fit.residuals, nullptr);
    nominal_cost_ = Background(model, nominal.fit).unexplained();
    // The first candidates are tried about the parameters as tuned, since a large effect bends a calibration far away;
    // but where these are so far off that a straight line does not calibrate them, about the calibrated ones.
    about_nominal_ = Background(model, result.calibrated.fit).unexplained() > straight_enough * nominal_cost_;
    known_starts_ = {.calibrated = result.calibrated.fit.x,
                     .other = about_nominal_ ? result.calibrated.fit.x : nominal.fit.x};
    const Explanation& bare = about_nominal_ ? nominal : result.calibrated;
    std::vector<Explanation> beam{bare};
    for (int round = 0; round < options_.most_effects && !beam.empty(); ++round) {
      can_stop_ = round > 0;
      begin_ = static_cast<double>(round) / options_.most_effects;
      width_ = 1.0 / options_.most_effects / static_cast<double>(beam.size());
      std::vector<Explanation> found;
      if (round == 1) {
        pair_up(bare, result, found);
        pair_with_line(bare, result, found);
      }
      if (is_closed(found)) {
        beam.clear();  // what remains to be seen is which others close it, too
        simplify(found, result);
        exchange_in(best_of(found), found, result);
      }
      for (const Explanation& one : beam) {
        if (must_stop()) {
          break;
        }
        expand(one, any, round == 0 ? options_.fitted_first : options_.fitted_later, result, found);
        begin_ += width_;
      }
      if (round == 0) {
        can_stop_ = true;
        on_other_edges(bare, found);
      }
      if (round > 0) {
        without_each(found, result);
      }
      if (round == 1) {
        exchange(3, found, result);
        move_each(found, result);
        exchange(1, found, result);
        simplify(found, result);
      }
      beam = next_beam(found, result, round == 0 ? options_.beam : 1);
      std::ranges::move(found, std::back_inserter(result.explanations));
    }
    std::ranges::stable_sort(result.explanations,
                             [](const Explanation& a, const Explanation& b) { return a.fit.cost < b.fit.cost; });
    return result;
  }

 private:
  void say(double fraction, std::string_view text) {
    if (options_.progress) {
      const std::lock_guard lock(mutex_);
      options_.progress(begin_ + width_ * fraction, text);
    }
  }
  /// The first round is done whole: each effect gets its chance. Later ones end where they are when time is up.
  [[nodiscard]] bool must_stop() const { return can_stop_ && options_.out_of_time && options_.out_of_time(); }

  using Wanted = std::function<bool(const Applied&)>;
  static bool any(const Applied& /*effect*/) { return true; }

  /// To a set every effect more is added that is wanted; `found` gets the best.
  void expand(const Explanation& from, const Wanted& wanted, std::size_t fitted, Search& result,
              std::vector<Explanation>& found) {
    std::vector<Candidate> candidates = candidates_of(from.variant, top_, options_.candidates);
    std::erase_if(candidates, [&](const Candidate& one) { return !wanted(one.own()); });
    const Drivers drivers(task_, candidates, from.fit.x.head(std::ssize(task_.known)), options_.threads);
    for (std::size_t i = 0, count = candidates.size(); i < count; ++i) {
      const Driven* const signals = drivers.find(candidates[i]);
      if (signals != nullptr) {
        const Extent* const auxiliary = signals->auxiliary ? &*signals->auxiliary : nullptr;
        std::ranges::move(other_guesses(candidates[i], signals->input, auxiliary), std::back_inserter(candidates));
      }
    }
    result.tried += candidates.size();
    // Lines and periods show best where a calibration has taken off what is none.
    const VectorXd& shown = from.variant.effects.empty() ? result.calibrated.fit.residuals : from.fit.residuals;
    const Hints hints = hints_of(task_, shown);
    Model model(task_, *from.variant.program, from.variant.further);
    const Background background(model, from.fit);

    std::vector<Screened> list(candidates.size());
    std::vector<Grids> grids(candidates.size());
    std::atomic<std::size_t> done{0};
    in_parallel(candidates.size(), options_.threads, [&](std::size_t i) {
      const Driven* const signals = drivers.find(candidates[i]);
      if (signals == nullptr || !(signals->input.range() >= 0.0) || must_stop()) {
        return;
      }
      std::vector<double> periods;
      if (candidates[i].own().has(Role::Period) || candidates[i].own().has(Role::Quantum)) {
        periods =
            strongest_periods(shown, signals->auxiliary_values ? *signals->auxiliary_values : signals->input_values, 8);
      }
      grids[i] =
          grids_of(candidates[i], signals->input, signals->auxiliary ? &*signals->auxiliary : nullptr, hints, periods);
      list[i] = unless_refused([&] {
        return screened(task_, candidates[i], thinned(candidates[i].own(), grids[i], stride), from.fit.x, background,
                        starts_kept(candidates[i].own()));
      });
      say(0.4 * static_cast<double>(++done) / static_cast<double>(candidates.size()),
          candidates[i].own().effect + " at " + candidates[i].own().edge);
    });
    refine(list, candidates, grids, from, background, fitted);
    if (from.variant.effects.empty() && about_nominal_) {
      about_calibration(list, candidates, grids, result.calibrated);
    }
    std::erase_if(list, [](const Screened& one) { return one.starts.empty(); });
    std::ranges::stable_sort(list, [](const Screened& a, const Screened& b) { return a.gain() > b.gain(); });
    if (from.variant.effects.empty()) {
      singles_ = list;
    }
    keep_best(list, fitted, from.variant.effects.empty() ? 2 : 1);
    fit_and_finish(list, from, found);
  }

  /// Candidates as they were screened, fitted; those in front to the end.
  void fit_and_finish(const std::vector<Screened>& list, const Explanation& from, std::vector<Explanation>& found) {
    std::vector<Explanation> fits(list.size());
    std::atomic<std::size_t> done{0};
    in_parallel(list.size(), options_.threads, [&](std::size_t i) {
      if (must_stop()) {
        return;
      }
      fits[i] = begun_from(task_, list[i], from, known_starts_);
      say(0.6 + 0.3 * static_cast<double>(++done) / static_cast<double>(list.size()),
          list[i].candidate.own().effect + " at " + list[i].candidate.own().edge);
    });
    std::erase_if(fits, [](const Explanation& one) { return !std::isfinite(one.fit.cost); });
    finish_front(fits, from.fit.cost);
    std::ranges::move(fits, std::back_inserter(found));
  }

  /// Where the residual is little more than noise, an effect has to gain more than chance does. Of a large gap a single
  /// one may close little, and leave residuals so slow that they count for few samples.
  [[nodiscard]] bool is_worth_following(double cost_before, const Fit& best) const {
    return cost_before > surely_a_gap * floor_cost_ || nats_gained(cost_before, best) > more_than_chance;
  }

  /// To the end those fits that a few steps have brought to the front; one that closes a small part of what the best
  /// closes is ranked well enough.
  void finish_front(std::vector<Explanation>& fits, double cost_before) {
    std::ranges::stable_sort(fits, {}, cost_of_fit);
    const bool decides = !fits.empty() && is_worth_following(cost_before, fits.front().fit);
    std::atomic<std::size_t> done{0};
    in_parallel(fits.size(), options_.threads, [&](std::size_t i) {
      const bool in_front =
          decides && !must_stop() && cost_before - fits[i].fit.cost > 0.25 * (cost_before - fits.front().fit.cost);
      if (i < finished_always || in_front) {
        finish(task_, fits[i], i < finished_always);
      }
      say(0.9 + 0.1 * static_cast<double>(++done) / static_cast<double>(fits.size()), "last steps of the fits");
    });
  }

  /// The whole grid near the starts of those candidates that the thin one has brought to the front.
  void refine(std::vector<Screened>& list, const std::vector<Candidate>& candidates, const std::vector<Grids>& grids,
              const Explanation& from, const Background& background, std::size_t count) {
    const std::vector<std::size_t> order = front_of(list, candidates, count);
    std::atomic<std::size_t> done{0};
    in_parallel(order.size(), options_.threads, [&](std::size_t i) {
      const std::size_t at = order[i];
      if (!list[at].starts.empty() && !must_stop()) {
        list[at] = screened_about(list[at].starts, stride, task_, candidates[at], grids[at], from.fit.x, background,
                                  starts_kept(candidates[at].own()));
      }
      say(0.4 + 0.2 * static_cast<double>(++done) / static_cast<double>(order.size()), "finer grids");
    });
  }

  /// Gaps and quanta once more about the calibrated parameters: their place on the signal counts, and a gain that is
  /// off by a percent shifts a quantum at the far end by more than itself.
  void about_calibration(std::vector<Screened>& list, const std::vector<Candidate>& candidates,
                         const std::vector<Grids>& grids, const Explanation& calibrated) {
    Model model(task_, *calibrated.variant.program);
    const Background background(model, calibrated.fit);
    std::vector<Screened> others(list.size());
    in_parallel(list.size(), options_.threads, [&](std::size_t i) {
      if (candidates[i].own().has_gap() && !grids[i].parameters.empty()) {
        others[i] = unless_refused([&] {
          return screened(task_, candidates[i], thinned(candidates[i].own(), grids[i], stride), calibrated.fit.x,
                          background, 2);
        });
      }
    });
    const std::vector<std::size_t> front = front_of(others, candidates, 0);
    in_parallel(front.size(), options_.threads, [&](std::size_t k) {
      const std::size_t i = front[k];
      if (others[i].starts.empty()) {
        return;
      }
      Screened other =
          screened_about(others[i].starts, stride, task_, candidates[i], grids[i], calibrated.fit.x, background, 2);
      // Gains are held against each other by what is left: the calibrated residual is the smaller one.
      const double saved = nominal_cost_ - calibrated.fit.cost;
      for (Start& start : other.starts) {
        start.gain += saved;
        start.about_calibration = true;
      }
      std::ranges::move(other.starts, std::back_inserter(list[i].starts));
      if (list[i].unknowns.empty()) {
        list[i] = std::move(other);
      }
      std::ranges::stable_sort(list[i].starts, [](const Start& a, const Start& b) { return a.gain > b.gain; });
    });
  }

  /// The effects in front after the first round on their other edges: beside others an effect is often screened best
  /// where it is not.
  void on_other_edges(const Explanation& bare, std::vector<Explanation>& found) {
    std::ranges::stable_sort(found, {}, cost_of_fit);
    if (found.empty() || !is_worth_following(bare.fit.cost, found.front().fit)) {
      return;
    }
    std::set<std::string> front;
    std::vector<Applied> fitted;
    for (const Explanation& one : found) {
      fitted.push_back(one.variant.effects.front());
      if (front.size() < options_.beam) {
        front.insert(fitted.back().effect);
      }
    }
    fit_and_finish(on_untried_edges(singles_, front, fitted), bare, found);
  }

  /// The best sets of this round with each of their effects taken away again: what an effect was found beside may be
  /// all that it was there for, and the other one by itself the better explanation.
  void without_each(std::vector<Explanation>& found, const Search& result) const {
    std::ranges::stable_sort(found, {}, cost_of_fit);
    std::vector<Explanation> reduced;
    for (std::size_t k = 0; k < std::min<std::size_t>(found.size(), 3); ++k) {
      const Explanation& one = found[k];
      for (std::size_t i = 0; i < one.variant.effects.size() && one.variant.effects.size() > 1; ++i) {
        Explanation smaller = sets_.without(one, i, result.calibrated.variant, 30);
        if (std::isfinite(smaller.fit.cost)) {
          reduced.push_back(std::move(smaller));
        }
      }
    }
    std::ranges::move(reduced, std::back_inserter(found));
  }

  void pair_up(const Explanation& from, const Search& result, std::vector<Explanation>& found) {
    constexpr std::size_t most_values = 20'000'000;
    Model model(task_, *from.variant.program);
    const Background background(model, from.fit);
    keep_best(singles_, std::min<std::size_t>(150, most_values / static_cast<std::size_t>(from.fit.residuals.size())),
              1);
    const std::vector<Superposition::Pair> pairs =
        pairs_that_add_up(task_, singles_, from.fit.x, background, options_.pairs, options_.threads);
    std::vector<Explanation> fits(pairs.size());
    in_parallel(pairs.size(), options_.threads, [&](std::size_t i) {
      fits[i] = sets_.together(singles_[static_cast<std::size_t>(pairs[i].first)],
                               singles_[static_cast<std::size_t>(pairs[i].second)], from.fit.x);
    });
    std::erase_if(fits, [](const Explanation& one) { return !std::isfinite(one.fit.cost); });
    finish_front(fits, result.calibrated.fit.cost);
    std::ranges::move(fits, std::back_inserter(found));
  }

  /// A line that stands out of the spectrum, beside any other effect: by itself it took on what that one does.
  void pair_with_line(const Explanation& from, Search& result, std::vector<Explanation>& found) {
    const auto line = std::ranges::find_if(singles_, is_line);
    if (line == singles_.end() || is_closed(found) || must_stop()) {
      return;
    }
    const Explanation alone = with_line(task_, *line, from);
    if (std::isfinite(alone.fit.cost)) {
      expand(alone, any, options_.fitted_first, result, found);
    }
  }

  /// The best pairs with each of their effects on any other of its edges: beside the other effect its place shows, by
  /// itself it often did not.
  void move_each(std::vector<Explanation>& found, Search& result) {
    constexpr std::size_t edges = 4;
    std::set<std::vector<std::string>> moved;
    for (const std::size_t most : std::array<std::size_t, 3>{4, 2, 2}) {
      if (is_closed(found)) {
        return;
      }
      std::ranges::stable_sort(found, {}, cost_of_fit);
      std::vector<Explanation> best;
      std::set<std::vector<std::string>> taken;
      for (const Explanation& one : found) {
        if (best.size() < most && one.fit.cost < pair_far_behind * found.front().fit.cost &&
            taken.insert(one.names()).second && moved.insert(one.places()).second) {
          best.push_back(one);
        }
      }
      for (const Explanation& one : best) {
        for (std::size_t i = 0; i < one.variant.effects.size() && !must_stop(); ++i) {
          const Explanation rest = sets_.without(one, i, result.calibrated.variant, 0);
          if (std::isfinite(rest.fit.cost)) {
            const std::string& effect = one.variant.effects[i].effect;
            expand(
                rest, [&](const Applied& other) { return other.effect == effect; }, edges, result, found);
          }
        }
      }
    }
  }

  [[nodiscard]] bool is_closed(const std::vector<Explanation>& found) const {
    return std::ranges::any_of(found,
                               [&](const Explanation& one) { return one.fit.cost <= well_closed * floor_cost_; });
  }

  /// Each effect of so many of the best pairs in turn gives its place to any other: what was found first may have stood
  /// in for two, and is not what fits best beside the other one.
  void exchange(std::size_t most, std::vector<Explanation>& found, Search& result) {
    std::set<std::vector<std::string>> done;
    while (done.size() < most && !found.empty() && !is_closed(found) && !must_stop()) {
      std::ranges::stable_sort(found, {}, cost_of_fit);
      const auto next = std::ranges::find_if(
          found, [&](const Explanation& one) { return one.variant.effects.size() > 1 && !done.contains(one.names()); });
      if (next == found.end() || next->fit.cost > pair_far_behind * found.front().fit.cost) {
        return;
      }
      done.insert(next->names());
      exchange_in(*next, found, result);
    }
    if (is_closed(found)) {
      exchange_in(best_of(found), found, result);  // which others close it, too
    }
  }
  void exchange_in(const Explanation& one, std::vector<Explanation>& found, Search& result) {
    replace_in(one, found, result, exchanged_, [](const Applied&, const Applied&) { return true; });
  }

  /// Each effect of the best pair in turn gives its place to those with fewer parameters on its edge: the first part of
  /// a warm-up is a drift, and by itself the drift may have been the worse one beside an effect that was still missing.
  /// Also where the other effect had been expanded: it may have been with other settings.
  void simplify(std::vector<Explanation>& found, Search& result) {
    if (found.empty()) {
      return;
    }
    replace_in(best_of(found), found, result, simplified_, [](const Applied& gone, const Applied& other) {
      return other.paths.size() < gone.paths.size() && Sets::same_root(other.edge, gone.edge);
    });
  }

  /// What stayed, and beside what it stood.
  using Replaced = std::set<std::pair<std::vector<std::string>, std::string>>;

  /// Each effect of a set in turn gives its place to those that `suits` lets have it, once.
  template <class Suits>
  void replace_in(const Explanation& of_found, std::vector<Explanation>& found, Search& result, Replaced& replaced,
                  const Suits& suits) {
    const Explanation one = of_found;  // `found` grows
    for (std::size_t i = 0; i < one.variant.effects.size() && one.variant.effects.size() > 1 && !must_stop(); ++i) {
      const Applied& gone = one.variant.effects[i];
      const Explanation rest = sets_.rest_of(one, i, result.calibrated.variant, tuned_);
      const bool is_new = replaced.emplace(rest.places(), gone.place()).second;
      if (std::isfinite(rest.fit.cost) && is_new) {
        expand(
            rest, [&](const Applied& other) { return suits(gone, other); }, options_.fitted_later, result, found);
      }
    }
  }

  /// The sets that one effect more is tried on: the best of each, none where the gap is closed.
  [[nodiscard]] std::vector<Explanation> next_beam(std::vector<Explanation>& found, const Search& result,
                                                   std::size_t width) const {
    std::ranges::stable_sort(found, {}, cost_of_fit);
    std::vector<Explanation> beam;
    std::set<std::vector<std::string>> taken;
    const double gap = result.calibrated.fit.cost - floor_cost_;
    if (found.empty() || !is_worth_following(result.calibrated.fit.cost, found.front().fit)) {
      return beam;
    }
    for (const Explanation& one : found) {
      const double left = one.fit.cost - floor_cost_;
      const std::size_t effects = found.front().variant.effects.size() + 1;
      const bool closed =
          found.front().fit.cost - floor_cost_ < least_gain(result.calibrated.fit.cost, floor_cost_, effects);
      if (closed || correlation_time(found.front().fit.residuals) < 1.5) {
        break;  // nothing notable is left for another effect, or nothing but white noise
      }
      if (beam.size() < width && left < gap && taken.insert(one.names()).second) {
        beam.push_back(one);
      }
    }
    return beam;
  }

  const Task& task_;
  const std::string& top_;
  double floor_cost_;
  Sets sets_;
  double nominal_cost_ = 0.0;
  bool can_stop_ = false;
  KnownStarts known_starts_{};
  VectorXd tuned_{};  ///< the known parameters as tuned
  bool about_nominal_ = true;
  std::vector<Screened> singles_{};  ///< by themselves, best first
  Replaced exchanged_{};
  Replaced simplified_{};
  const SearchOptions& options_;
  std::mutex mutex_{};
  double begin_ = 0.0;
  double width_ = 1.0;
};

}  // namespace

double least_gain(double calibrated_cost, double floor_cost, std::size_t effects) {
  constexpr double share = 0.05;
  constexpr double floors = 3.0;
  const double notable = share * std::max(calibrated_cost - floor_cost, 0.0);
  return effects > 2 ? notable : std::min(notable, floors * floor_cost);
}

Search search(const Task& task, Variant base, const std::string& top, double floor_cost, const SearchOptions& options) {
  return Searcher(task, top, floor_cost, options).run(std::move(base));
}

}  // namespace hysteron::diagnosis
