#include "diagnosis/search/search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <set>
#include <utility>

#include "diagnosis/model/budget.hpp"
#include "diagnosis/model/parallel.hpp"
#include "diagnosis/search/expansion.hpp"
#include "diagnosis/search/line_start.hpp"
#include "diagnosis/search/pairing.hpp"
#include "diagnosis/search/sets.hpp"
#include "diagnosis/search/shortlist.hpp"
#include "diagnosis/search/stretches.hpp"
#include "diagnosis/search/superposition.hpp"
#include "tuning/covariance.hpp"

namespace hysteron::diagnosis {
namespace {

/// A pair whose cost is below so many of the floor's closes the gap: no third effect is tried beside it.
constexpr double well_closed = 1.3;

/// What was found on stretches and leaves less over whole records is followed by itself.
constexpr double nearly_closed = 4.0;

/// One whose cost is above so many of the best one's is not followed.
constexpr double pair_far_behind = 3.0;

/// What the calibrated diagram leaves on stretches, of what it leaves over whole records, where most of that adds up.
constexpr double adds_up = 0.25;

/// A set that leaves so little of that gap has closed it.
constexpr double little = 0.05;

/// So many sets that were found on stretches are fitted over the whole records.
constexpr std::size_t most_taken_over = 6;

void append(std::vector<Explanation> more, std::vector<Explanation>& found) {
  std::ranges::move(more, std::back_inserter(found));
}

const Explanation& best_of(const std::vector<Explanation>& found) {
  return *std::ranges::min_element(found, {}, cost_of_fit);
}

class Searcher {
 public:
  Searcher(const Task& task, const std::string& top, const Footing& footing, double floor_cost,
           const SearchOptions& options)
      : task_(task),
        top_(top),
        footing_(footing),
        floor_cost_(floor_cost),
        expansion_(task, top, footing, floor_cost, options),
        sets_(task, top, options.candidates),
        options_(options) {}

  Search run() {
    Search result{.calibrated = footing_.calibrated};
    const Explanation& bare = footing_.bare();
    std::vector<Explanation> beam{bare};
    for (int round = 0; round < options_.most_effects && !beam.empty(); ++round) {
      const double part = 1.0 / options_.most_effects / static_cast<double>(beam.size());
      double begin = static_cast<double>(round) / options_.most_effects;
      expansion_.progress_within(begin, part);
      std::vector<Explanation> found;
      if (round == 1) {
        on_stretches(found);
        const bool again = footing_.is_near && !expansion_.must_stop();
        const Explanation& about = again ? footing_.calibrated : bare;
        std::vector<Screened> singles =
            again ? expansion_.screen(about, any_effect, options_.fitted_first) : expansion_.singles();
        if (!is_closed(found, nearly_closed)) {
          pair_up(about, singles, found);
          pair_with_line(about, singles, found);
        } else {
          beam.clear();
          simplify(found);
        }
      }
      if (is_closed(found)) {
        beam.clear();  // what remains to be seen is which others close it, too
        simplify(found);
        exchange_in(best_of(found), found);
      }
      for (const Explanation& one : beam) {
        if (expansion_.must_stop()) {
          break;
        }
        expand(one, any_effect, round == 0 ? options_.fitted_first : options_.fitted_later, found);
        expansion_.progress_within(begin += part, part);
      }
      if (round == 0) {
        expansion_.may_stop();
        on_other_edges(bare, found);
      }
      if (round > 0) {
        without_each(found);
      }
      if (round == 1) {
        exchange(3, found);
        move_each(found);
        exchange(1, found);
        simplify(found);
      }
      std::ranges::stable_sort(found, {}, cost_of_fit);
      const bool ends = round == 0 && !found.empty() && options_.ends_with_singles && options_.ends_with_singles(found);
      beam = ends ? std::vector<Explanation>{} : next_beam(found, round == 0 ? options_.beam : 1);
      append(std::move(found), result.explanations);
    }
    std::ranges::stable_sort(result.explanations, {}, cost_of_fit);
    result.tried = tried_on_stretches_ + expansion_.tried();
    return result;
  }

 private:
  /// Where a plant integrates, sets of up to two effects that close the gap over stretches of the records.
  void on_stretches(std::vector<Explanation>& found) {
    const std::optional<Task> cut = in_stretches(task_, footing_.calibrated);
    if (!cut || expansion_.must_stop()) {
      return;
    }
    Footing about = footing_of(*cut, footing_.calibrated.variant);
    about.about_nominal = false;  // the states at the starts were fitted to the calibration
    about.is_near = false;
    const Index states = about.calibrated.fit.x.size() - std::ssize(task_.known);
    about.nominal.fit.x.tail(states) = about.calibrated.fit.x.tail(states);
    if (about.calibrated.fit.cost > adds_up * footing_.calibrated.fit.cost) {
      return;
    }
    Searcher inner(*cut, top_, about, floor_cost_, options_);
    const std::vector<Explanation> sets = inner.first_to_close();
    tried_on_stretches_ = inner.expansion_.tried();
    std::vector<Explanation> whole;
    std::set<std::vector<std::string>> taken;
    for (const Explanation& one : sets) {
      if (whole.size() < most_taken_over && taken.insert(one.names()).second) {
        whole.push_back(one);
      }
    }
    in_parallel(whole.size(), options_.threads, [&](std::size_t i) { whole[i] = over_whole_records(task_, whole[i]); });
    append(std::move(whole), found);
  }

  /// The single effects and the sets of two, best first, until one closes the gap.
  std::vector<Explanation> first_to_close() {
    expansion_.may_stop();
    std::vector<Explanation> found;
    expand(footing_.bare(), any_effect, options_.fitted_first, found);
    std::ranges::stable_sort(found, {}, cost_of_fit);
    const double closed =
        std::max(well_closed * floor_cost_, floor_cost_ + little * (footing_.calibrated.fit.cost - floor_cost_));
    const auto is_open = [&] { return !is_closed(found, closed / floor_cost_) && !expansion_.must_stop(); };
    for (const Explanation& one : next_beam(found, options_.beam)) {
      if (is_open()) {
        expand(one, any_effect, options_.fitted_later, found);
      }
    }
    if (is_open()) {
      exchange(1, found);
    }
    std::ranges::stable_sort(found, {}, cost_of_fit);
    return found;
  }

  void expand(const Explanation& from, const Wanted& wanted, std::size_t fitted, std::vector<Explanation>& found) {
    append(expansion_.of(from, wanted, fitted), found);
  }

  /// The effects in front after the first round on their other edges: beside others an effect is often screened best
  /// where it is not. Where none of them closes the gap, the others get a few more edges as well: about parameters that
  /// are far off, a straight line ranks the edge where an effect is behind those where it is not.
  void on_other_edges(const Explanation& bare, std::vector<Explanation>& found) {
    std::ranges::stable_sort(found, {}, cost_of_fit);
    if (found.empty() || !expansion_.is_worth_following(bare.fit.cost, found.front().fit)) {
      return;
    }
    std::set<std::string> front;
    std::set<std::string> others;
    std::vector<Applied> fitted;
    for (const Explanation& one : found) {
      fitted.push_back(one.variant.effects.front());
      const std::string& effect = fitted.back().effect;
      if (front.size() < options_.beam) {
        front.insert(effect);
      } else if (!front.contains(effect)) {
        others.insert(effect);
      }
    }
    const auto on_more = [&](const std::set<std::string>& effects, int most) {
      const std::vector<Screened> more = on_untried_edges(expansion_.singles(), effects, fitted, most);
      append(expansion_.fitted_and_finished(more, bare), found);
    };
    on_more(front, options_.edges_of_front);
    if (!is_closed(found)) {
      on_more(others, options_.edges_of_others);
    }
  }

  /// The best sets of this round with each of their effects taken away again: what an effect was found beside may be
  /// all that it was there for, and the other one by itself the better explanation.
  void without_each(std::vector<Explanation>& found) const {
    std::ranges::stable_sort(found, {}, cost_of_fit);
    std::vector<Explanation> reduced;
    for (std::size_t k = 0; k < std::min<std::size_t>(found.size(), 3); ++k) {
      const Explanation& one = found[k];
      for (std::size_t i = 0; i < one.variant.effects.size() && one.variant.effects.size() > 1; ++i) {
        Explanation smaller = sets_.without(one, i, footing_.calibrated.variant, 30);
        if (std::isfinite(smaller.fit.cost)) {
          reduced.push_back(std::move(smaller));
        }
      }
    }
    append(std::move(reduced), found);
  }

  void pair_up(const Explanation& from, std::vector<Screened>& singles, std::vector<Explanation>& found) {
    constexpr std::size_t most_values = 20'000'000;
    Model model(task_, *from.variant.program);
    const Background background(model, from.fit);
    keep_best(singles, std::min<std::size_t>(150, most_values / static_cast<std::size_t>(from.fit.residuals.size())),
              1);
    const std::vector<Superposition::Pair> pairs =
        pairs_that_add_up(task_, singles, from.fit.x, background, options_.pairs, options_.threads);
    std::vector<Explanation> fits(pairs.size());
    in_batches(pairs.size(), options_.threads, options_.budget, [&](std::size_t i) {
      if (expansion_.must_stop()) {
        return;
      }
      fits[i] = sets_.together(singles[static_cast<std::size_t>(pairs[i].first)],
                               singles[static_cast<std::size_t>(pairs[i].second)], from.fit.x);
    });
    std::erase_if(fits, [](const Explanation& one) { return !std::isfinite(one.fit.cost); });
    expansion_.finish_front(fits, footing_.calibrated.fit.cost);
    append(std::move(fits), found);
  }

  /// A line that stands out of the spectrum, beside any other effect: by itself it took on what that one does.
  void pair_with_line(const Explanation& from, const std::vector<Screened>& singles, std::vector<Explanation>& found) {
    const auto line = std::ranges::find_if(singles, is_line);
    if (line == singles.end() || is_closed(found) || expansion_.must_stop()) {
      return;
    }
    const Explanation alone = with_line(task_, *line, from);
    if (std::isfinite(alone.fit.cost)) {
      expand(alone, any_effect, options_.fitted_first, found);
    }
  }

  /// The best pairs with each of their effects on any other of its edges: beside the other effect its place shows, by
  /// itself it often did not.
  void move_each(std::vector<Explanation>& found) {
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
        for (std::size_t i = 0; i < one.variant.effects.size() && !expansion_.must_stop(); ++i) {
          const Explanation rest = sets_.without(one, i, footing_.calibrated.variant, 0);
          if (std::isfinite(rest.fit.cost)) {
            const std::string& effect = one.variant.effects[i].effect;
            expand(
                rest, [&](const Applied& other) { return other.effect == effect; }, edges, found);
          }
        }
      }
    }
  }

  [[nodiscard]] bool is_closed(const std::vector<Explanation>& found, double floors = well_closed) const {
    return std::ranges::any_of(found, [&](const Explanation& one) { return one.fit.cost <= floors * floor_cost_; });
  }

  /// Each effect of so many of the best pairs in turn gives its place to any other: what was found first may have stood
  /// in for two, and is not what fits best beside the other one.
  void exchange(std::size_t most, std::vector<Explanation>& found) {
    std::set<std::vector<std::string>> done;
    while (done.size() < most && !found.empty() && !is_closed(found) && !expansion_.must_stop()) {
      std::ranges::stable_sort(found, {}, cost_of_fit);
      const auto next = std::ranges::find_if(
          found, [&](const Explanation& one) { return one.variant.effects.size() > 1 && !done.contains(one.names()); });
      if (next == found.end() || next->fit.cost > pair_far_behind * found.front().fit.cost) {
        return;
      }
      done.insert(next->names());
      exchange_in(*next, found);
    }
    if (is_closed(found)) {
      exchange_in(best_of(found), found);  // which others close it, too
    }
  }
  void exchange_in(const Explanation& one, std::vector<Explanation>& found) {
    replace_in(one, found, exchanged_, [](const Applied&, const Applied&) { return true; });
  }

  /// Each effect of the best pair in turn gives its place to those with fewer parameters on its edge: the first part of
  /// a warm-up is a drift, and by itself the drift may have been the worse one beside an effect that was still missing.
  /// Also where the other effect had been expanded: it may have been with other settings.
  void simplify(std::vector<Explanation>& found) {
    if (found.empty()) {
      return;
    }
    const Explanation best = best_of(found);
    const bool is_new = best.variant.effects.size() > 1 && held_.insert(best.places()).second;
    for (std::size_t i = 0; is_new && i < best.variant.effects.size(); ++i) {
      if (!expansion_.must_stop()) {
        append(sets_.in_simpler_formulas(best, i, footing_.calibrated.variant), found);
      }
    }
    replace_in(best, found, simplified_, [](const Applied& gone, const Applied& other) {
      return other.paths.size() < gone.paths.size() && Sets::same_root(other.edge, gone.edge);
    });
  }

  /// What stayed, and beside what it stood.
  using Replaced = std::set<std::pair<std::vector<std::string>, std::string>>;

  /// Each effect of a set in turn gives its place to those that `suits` lets have it, once.
  template <class Suits>
  void replace_in(const Explanation& of_found, std::vector<Explanation>& found, Replaced& replaced,
                  const Suits& suits) {
    const Explanation one = of_found;  // `found` grows
    for (std::size_t i = 0; i < one.variant.effects.size() && one.variant.effects.size() > 1 && !expansion_.must_stop();
         ++i) {
      const Applied& gone = one.variant.effects[i];
      const Explanation rest =
          sets_.rest_of(one, i, footing_.calibrated.variant, footing_.nominal.fit.x.head(std::ssize(task_.known)));
      const bool is_new = replaced.emplace(rest.places(), gone.place()).second;
      if (std::isfinite(rest.fit.cost) && is_new) {
        expand(
            rest, [&](const Applied& other) { return suits(gone, other); }, options_.fitted_later, found);
      }
    }
  }

  /// The sets that one effect more is tried on, of those found, best first: the best of each, none where the gap is
  /// closed.
  [[nodiscard]] std::vector<Explanation> next_beam(const std::vector<Explanation>& found, std::size_t width) const {
    std::vector<Explanation> beam;
    std::set<std::vector<std::string>> taken;
    const double gap = footing_.calibrated.fit.cost - floor_cost_;
    if (found.empty() || !expansion_.is_worth_following(footing_.calibrated.fit.cost, found.front().fit)) {
      return beam;
    }
    for (const Explanation& one : found) {
      const double left = one.fit.cost - floor_cost_;
      const std::size_t effects = found.front().variant.effects.size() + 1;
      const bool closed =
          found.front().fit.cost - floor_cost_ < least_gain(footing_.calibrated.fit.cost, floor_cost_, effects);
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
  const Footing& footing_;
  double floor_cost_;
  Expansion expansion_;
  Sets sets_;
  Replaced exchanged_{};
  Replaced simplified_{};
  std::set<std::vector<std::string>> held_{};  ///< sets whose simpler formulas were fitted
  std::size_t tried_on_stretches_ = 0;
  const SearchOptions& options_;
};

}  // namespace

double least_gain(double calibrated_cost, double floor_cost, std::size_t effects) {
  constexpr double share = 0.05;
  constexpr double floors = 3.0;
  const double notable = share * std::max(calibrated_cost - floor_cost, 0.0);
  return effects > 2 ? notable : std::min(notable, floors * floor_cost);
}

Search search(const Task& task, Variant base, const std::string& top, double floor_cost, const SearchOptions& options) {
  const Footing footing = footing_of(task, std::move(base));
  return Searcher(task, top, footing, floor_cost, options).run();
}

}  // namespace hysteron::diagnosis
