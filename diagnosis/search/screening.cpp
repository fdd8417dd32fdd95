#include "diagnosis/search/screening.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "diagnosis/search/superposition.hpp"
#include "diagnosis/search/tried_effect.hpp"

namespace hysteron::diagnosis {
namespace {

/// Of the gap, what a start has to explain for its parameters to be narrowed down.
constexpr double worth_narrowing = 0.2;

class Screening : private TriedEffect {
 public:
  using TriedEffect::TriedEffect;

  Screened run(std::size_t keep) {
    std::vector<Start> starts;
    if (own().has_end()) {
      try_intervals(starts);
    } else {
      try_shapes(shapes(), starts);
    }
    narrow(starts);
    return finished(std::move(starts), keep);
  }

  /// The points of the grid about the starts that a thinner one has found; all of a quantum's: what lies between two of
  /// its points cannot be guessed from them.
  Screened run_about(const std::vector<Start>& coarse, std::size_t stride, std::size_t keep) {
    std::vector<VectorXd> about;
    std::vector<std::size_t> end_of_moves;
    std::vector<Move> moves;
    for (const Start& start : coarse) {
      VectorXd& values = about.emplace_back(neutral());
      for (Index k = 0; k < std::ssize(free()); ++k) {
        values[free()[static_cast<std::size_t>(k)]] = start.values[k];
      }
      for (const Index j : free()) {
        if (parameter(j).role != Role::Quantum || &start == &coarse.front()) {
          move_along_grid(values, j, stride, moves);
        }
      }
      end_of_moves.push_back(moves.size());
    }
    prepare(moves);
    std::vector<Start> starts;
    std::size_t next = 0;
    for (std::size_t i = 0; i < coarse.size(); ++i) {
      starts.push_back({.values = about[i], .gain = coarse[i].gain});
      for (; next < end_of_moves[i]; ++next) {
        try_move(moves[next], starts);
      }
    }
    return finished(std::move(starts), keep);
  }

 private:
  /// The best starts, with the free parameters alone.
  Screened finished(std::vector<Start> starts, std::size_t keep) {
    for (Start& start : starts) {
      start.measured = is_measured(start.values);
    }
    std::ranges::stable_sort(
        starts, [](const Start& a, const Start& b) { return a.measured != b.measured ? a.measured : a.gain > b.gain; });
    std::vector<Start> kept;
    for (Start& start : starts) {
      if ((kept.size() < keep || start.measured) &&
          std::ranges::none_of(kept, [&](const Start& other) { return is_near(start.values, other.values); })) {
        kept.push_back(std::move(start));
      }
    }
    for (Start& start : kept) {
      VectorXd values(std::ssize(free()));
      for (Index k = 0; k < std::ssize(free()); ++k) {
        values[k] = start.values[free()[static_cast<std::size_t>(k)]];
      }
      start.values = std::move(values);
    }
    std::ranges::stable_sort(kept, [](const Start& a, const Start& b) { return a.gain > b.gain; });
    return std::move(*this).with(std::move(kept));
  }

  /// What varies smoothly, between the points of its grid and by halves of their distance: an exponential that is off
  /// by half its time constant, or a limit that cuts twice as much, leaves more of a gap than another effect at its
  /// best.
  void narrow(std::vector<Start>& starts) {
    for (Index j = 0; j < parameter_count() && !starts.empty(); ++j) {
      const std::vector<double>& grid = points(j);
      Start best = *std::ranges::max_element(starts, {}, &Start::gain);
      if (!is_narrowed(j) || grid.size() < 3 || best.gain < worth_narrowing * background().unexplained()) {
        continue;
      }
      const std::size_t at = nearest(grid, best.values[j]);
      double low = grid[at == 0 ? 0 : at - 1];
      double high = grid[std::min(at + 1, grid.size() - 1)];
      for (int halving = 0; halving < 3; ++halving) {
        const double middle = best.values[j];
        const double below = between(low, middle);
        const double above = between(middle, high);
        std::vector<Move> moves;
        for (const double value : {below, above}) {
          if (value != middle) {
            moves.push_back({.values = best.values, .parameter = j});
            moves.back().values[j] = value;
          }
        }
        prepare(moves);
        for (const Move& move : moves) {
          try_move(move, starts);
        }
        best = *std::ranges::max_element(starts, {}, &Start::gain);
        low = best.values[j] == middle ? below : best.values[j] < middle ? low : middle;
        high = best.values[j] == middle ? above : best.values[j] < middle ? middle : high;
      }
    }
  }

  [[nodiscard]] bool is_narrowed(Index j) const {
    const Role role = parameter(j).role;
    return (role == Role::Duration && !parameter(j).strength) || role == Role::Instant ||
           (parameter(j).strength && (role == Role::Level || role == Role::Rate) &&
            std::isinf(parameter(j).field.neutral));
  }

  /// The middle, by ratio where both are positive: time constants and limits of a rate come by ratios.
  [[nodiscard]] static double between(double low, double high) {
    return low > 0.0 && high > 4.0 * low ? std::sqrt(low * high) : 0.5 * (low + high);
  }

  /// Whether a quantum is the step on which the measured values lie.
  [[nodiscard]] bool is_measured(const VectorXd& values) const {
    for (Index j = 0; j < parameter_count(); ++j) {
      const Grid& grid = this->grid(j);
      if (std::ranges::count(std::span(grid.values).first(grid.measured), values[j]) > 0) {
        return true;
      }
    }
    return false;
  }

  /// What a straight line through small strengths promises of a shape.
  struct Promise {
    VectorXd shape{};
    std::vector<VectorXd> settings{};  ///< where it is held against the diagram: there, short of there, beyond
    double gain = 0.0;
  };

  /// One parameter at another value.
  struct Move {
    VectorXd values{};
    Index parameter = 0;
    std::optional<Promise>
        promised{};  ///< of a new shape, whose strengths are taken anew: the output is linear in them
  };

  /// One parameter moved along its grid, the others where they are.
  void move_along_grid(const VectorXd& values, Index j, std::size_t stride, std::vector<Move>& moves) const {
    const Grid& grid = this->grid(j);
    const auto last = std::ssize(grid.values) - 1;
    if (last < 1) {
      return;
    }
    const auto middle = static_cast<std::ptrdiff_t>(nearest(grid.values, values[j]));
    const bool whole = parameter(j).role == Role::Quantum;
    const auto reach = whole ? last : std::max<std::ptrdiff_t>(1, static_cast<std::ptrdiff_t>(stride) - 1);
    for (auto k = std::max<std::ptrdiff_t>(0, middle - reach); k <= std::min(last, middle + reach); ++k) {
      if (k != middle) {
        moves.push_back({.values = values, .parameter = j});
        moves.back().values[j] = grid.values[static_cast<std::size_t>(k)];
      }
    }
  }

  /// What straight lines promise of all moves at once, so that the points they ask for can be run side by side.
  void prepare(std::vector<Move>& moves) {
    std::vector<VectorXd> shapes;
    std::vector<Move*> of_shapes;
    std::vector<VectorXd> first;
    for (Move& move : moves) {
      VectorXd shape = shape_of(move.values);
      if (!parameter(move.parameter).strength && is_linear_there(shape)) {
        shapes.push_back(std::move(shape));
        of_shapes.push_back(&move);
      } else {
        first.push_back(move.values);
      }
    }
    foresee_changes(shapes);
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      std::optional<Promise>& promise = of_shapes[i]->promised;
      promise = promised(shapes[i], strengths(), true);
      if (promise && !promise->settings.empty()) {
        first.push_back(promise->settings.front());
      }
    }
    foresee(first);
  }

  void try_move(const Move& move, std::vector<Start>& starts) {
    const std::size_t before = starts.size();
    if (move.promised) {
      hold(*move.promised, true, starts);
    }
    if (starts.size() == before) {
      try_point(move.values, starts);
    }
  }

  /// So many at a time that all points that they will ask for can be foreseen.
  void try_shapes(std::span<const VectorXd> shapes, std::vector<Start>& starts) {
    constexpr std::size_t most = 24;
    for (; !shapes.empty(); shapes = shapes.subspan(std::min(most, shapes.size()))) {
      try_some_shapes(shapes.first(std::min(most, shapes.size())), starts);
    }
  }

  void try_some_shapes(std::span<const VectorXd> shapes, std::vector<Start>& starts) {
    const std::vector<Index> list = strengths();
    const bool linear = is_linear_there(shapes.front());
    const bool amplitudes = are_amplitudes(list);
    if (!linear && !amplitudes) {
      for (const VectorXd& shape : shapes) {
        try_grid(shape, list, starts);
      }
      return;
    }
    foresee_changes(shapes);
    std::vector<Promise> promises;
    std::vector<VectorXd> first;  // of a line the first mostly holds, of what is bent most are asked for
    for (const VectorXd& shape : shapes) {
      if (std::optional<Promise> one = promised(shape, list, linear)) {
        const std::size_t asked = linear ? std::min<std::size_t>(one->settings.size(), 1) : one->settings.size();
        std::copy_n(one->settings.begin(), asked, std::back_inserter(first));
        promises.push_back(std::move(*one));
      }
    }
    foresee(first);
    for (const Promise& one : promises) {
      hold(one, linear, starts);
    }
  }

  /// A promise against the diagram. A short delay or lag is linear, and says nothing of a long one, as a friction that
  /// never holds says nothing of one that does: about parameters that are off it may even seem to make things worse.
  void hold(const Promise& promise, bool linear, std::vector<Start>& starts) {
    const std::vector<Index> list = strengths();
    const bool kept = is_kept(promise, linear, starts);
    if ((!are_amplitudes(list) || !kept) && !std::exchange(grid_tried_, true)) {
      try_grid(promise.shape, list, starts);
    }
  }

  /// What begins at one instant and ends at another, from small steps at each of them.
  void try_intervals(std::vector<Start>& starts) {
    constexpr std::size_t most = 4;
    const Index begin = *std::ranges::find_if(free(), [&](Index j) { return is_instant(j) && !is_end(j); });
    const Index end = *std::ranges::find_if(free(), [&](Index j) { return is_instant(j) && is_end(j); });
    const Index strength = strengths().front();
    const std::vector<double>& instants = points(begin);
    const double never = points(end).back();
    const double small = points(strength).front();
    VectorXd values = neutral();
    values[end] = never;
    values[strength] = small;
    std::vector<VectorXd> settings;
    for (const double instant : instants) {
      settings.push_back(values);
      settings.back()[begin] = instant;
    }
    foresee(settings);
    MatrixXd steps = MatrixXd::Zero(background().residuals().size(), std::ssize(instants));
    for (Index k = 0; k < std::ssize(settings); ++k) {
      if (const VectorXd change = change_at(settings[static_cast<std::size_t>(k)]); change.size() > 0) {
        steps.col(k) = change;
      }
    }
    const auto at = [&](Index k) { return k < std::ssize(instants) ? instants[static_cast<std::size_t>(k)] : never; };
    for (const Superposition::Interval& one : Superposition(steps, background()).intervals(most)) {
      values[begin] = at(one.begin);
      values[end] = at(one.end);
      for (const double share : {1.0, 0.3}) {
        values[strength] = share * one.size * small;
        if (try_point(values, starts) > 0.5 * one.gain) {
          break;
        }
      }
    }
  }
  [[nodiscard]] bool is_instant(Index j) const { return parameter(j).role == Role::Instant; }
  [[nodiscard]] bool is_end(Index j) const { return std::isinf(parameter(j).field.preset); }

  /// None where the diagram has no value, without settings where the effect does nothing.
  std::optional<Promise> promised(const VectorXd& shape, const std::vector<Index>& list, bool linear) {
    MatrixXd changes(background().residuals().size(), std::ssize(list));
    VectorXd sizes(std::ssize(list));
    VectorXd low(std::ssize(list));
    VectorXd high(std::ssize(list));
    for (Index k = 0; k < std::ssize(list); ++k) {
      const Index j = list[static_cast<std::size_t>(k)];
      const Field& field = parameter(j).field;
      VectorXd setting = shape;
      setting[j] = small(j, linear);
      const VectorXd change = change_at(setting);
      if (change.size() == 0) {
        return std::nullopt;
      }
      changes.col(k) = change;
      sizes[k] = setting[j] - field.neutral;
      const double a = (field.minimum - field.neutral) / sizes[k];
      const double b = (field.maximum - field.neutral) / sizes[k];
      low[k] = std::min(a, b);
      high[k] = std::max(a, b);
    }
    Promise result{.shape = shape};
    if (!(changes.squaredNorm() > 0.0)) {
      return result;
    }
    VectorXd alpha;
    result.gain = background().gain(changes, low, high, alpha);
    VectorXd values = shape;
    for (Index k = 0; k < std::ssize(list); ++k) {
      const Index j = list[static_cast<std::size_t>(k)];
      values[j] = parameter(j).field.neutral + alpha[k] * sizes[k];
    }
    for (const double share : linear ? std::vector{1.0, 0.3, 0.1} : std::vector{1.0, 0.5, 0.1, 1.5, 2.2}) {
      VectorXd& there = result.settings.emplace_back(shape);
      for (const Index j : list) {
        there[j] += share * (values[j] - shape[j]);
      }
    }
    return result;
  }

  /// Whether the diagram keeps a part of what the straight line promises.
  bool is_kept(const Promise& promise, bool linear, std::vector<Start>& starts) {
    double best = 0.0;
    for (std::size_t k = 0; k < promise.settings.size(); ++k) {
      if (linear && k == 1) {
        foresee(std::span(promise.settings).subspan(k));
      }
      best = std::max(best, try_point(promise.settings[k], starts));
      if (best > 0.8 * promise.gain) {
        break;
      }
    }
    return !promise.settings.empty() && best > 0.3 * promise.gain;
  }

  /// Each strength by itself over its grid; of limits also all of them at once, and each at its best.
  void try_grid(const VectorXd& shape, const std::vector<Index>& list, std::vector<Start>& starts) {
    const bool limits =
        list.size() > 1 && std::ranges::all_of(list, [&](Index j) { return std::isinf(parameter(j).field.neutral); });
    const auto at = [&](Index j, double value) {
      VectorXd values = shape;
      values[j] = value;
      return values;
    };
    const auto has_other_side = [&](Index j) {
      return points(j).size() < 5 && parameter(j).field.minimum < parameter(j).field.neutral;
    };
    const auto other_side = [&](Index j, double value) { return 2.0 * parameter(j).field.neutral - value; };
    std::vector<VectorXd> settings;
    for (const Index j : list) {
      for (const double value : points(j)) {
        settings.push_back(at(j, value));
        if (has_other_side(j)) {
          settings.push_back(at(j, other_side(j, value)));
        }
      }
    }
    foresee(settings);
    VectorXd each_at_its_best = shape;
    for (const Index j : list) {
      double best = 0.0;
      for (const double value : points(j)) {
        const double gain = try_point(at(j, value), starts);
        if (gain > best) {
          best = gain;
          each_at_its_best[j] = value;
        }
        if (has_other_side(j)) {
          try_point(at(j, other_side(j, value)), starts);
        }
      }
    }
    if (!limits) {
      return;
    }
    try_point(each_at_its_best, starts);
    try_together(shape, list, starts);
  }

  /// Limits to both sides are alike as a rule, and one of them alone lets an integrator run away: both at once, at one
  /// level from point to point of the further one's grid in smaller steps, and by halves about the best of these. Of a
  /// signal that stays on one side of 0, each along its own grid; rates in ratios, as a tenth more or less may hide
  /// one.
  void try_together(const VectorXd& shape, const std::vector<Index>& list, std::vector<Start>& starts) {
    constexpr double narrow_ratio = 1.12;
    constexpr double to_both_sides = 0.1;
    const auto [low, high] = std::ranges::minmax(list, {}, [&](Index j) { return points(j).front(); });
    const double least = points(low).front();
    const double most = points(high).front();
    const Index further = -least > most ? low : high;
    const bool about_zero = std::min(-least, most) > to_both_sides * std::max(-least, most);
    std::size_t longest = 0;
    for (const Index j : list) {
      longest = std::max(longest, points(j).size());
    }
    const double last = static_cast<double>(longest) - 1.0;
    const bool rates = std::ranges::all_of(list, [&](Index j) { return parameter(j).role == Role::Rate; });
    const double ratio = rates ? points(further).front() / points(further).back() : 1.0;
    const double smaller = std::max(3.0, std::ceil(std::abs(std::log(ratio)) / (last * std::log(narrow_ratio))));
    const auto settings_at = [&](double place) {
      VectorXd values = shape;
      for (const Index j : list) {
        const std::vector<double>& grid = points(about_zero ? further : j);
        const double here = std::clamp(place, 0.0, static_cast<double>(grid.size()) - 1.0);
        const auto below = static_cast<std::size_t>(here);
        const std::size_t above = std::min(below + 1, grid.size() - 1);
        const double share = here - static_cast<double>(below);
        const double value = rates ? grid[below] * std::pow(grid[above] / grid[below], share)
                                   : std::lerp(grid[below], grid[above], share);
        values[j] = about_zero ? std::copysign(value, points(j).front()) : value;
      }
      return values;
    };
    double best = 0.0;
    double gain = -std::numeric_limits<double>::infinity();
    const auto consider = [&](double place) {
      if (const double here = try_point(settings_at(place), starts); here > gain) {
        gain = here;
        best = place;
      }
    };
    std::vector<VectorXd> settings;
    for (double k = 0.0; k <= smaller * last; ++k) {
      settings.push_back(settings_at(k / smaller));
    }
    foresee(settings);
    for (double k = 0.0; k <= smaller * last; ++k) {
      consider(k / smaller);
    }
    for (double step = 0.5 / smaller; gain > worth_narrowing * background().unexplained() && step > 0.05; step *= 0.5) {
      const double middle = best;
      for (const double place : {middle - step, middle + step}) {
        if (place > 0.0 && place < last) {
          consider(place);
        }
      }
    }
  }

  /// What the diagram gains there, which becomes a start; 0 where it has no value, or the effect does nothing.
  double try_point(const VectorXd& values, std::vector<Start>& starts) {
    const VectorXd change = change_at(values);
    if (change.size() == 0 || change.squaredNorm() == 0.0) {
      return 0.0;
    }
    const VectorXd one = VectorXd::Ones(1);
    VectorXd alpha;
    starts.push_back({.values = values, .gain = background().gain(change, one, one, alpha)});
    return starts.back().gain;
  }

  bool grid_tried_ = false;  ///< once, also where straight lines are tried for each shape
};

}  // namespace

Screened screened(const Task& task, Candidate candidate, const Grids& grids, const VectorXd& at,
                  const Background& background, std::size_t keep) {
  return Screening(task, std::move(candidate), grids, at, background).run(keep);
}

Screened screened_about(const std::vector<Start>& coarse, std::size_t stride, const Task& task, Candidate candidate,
                        const Grids& grids, const VectorXd& at, const Background& background, std::size_t keep) {
  return Screening(task, std::move(candidate), grids, at, background).run_about(coarse, stride, keep);
}

}  // namespace hysteron::diagnosis
