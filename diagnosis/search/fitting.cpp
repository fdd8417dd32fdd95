#include "diagnosis/search/fitting.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

namespace hysteron::diagnosis {
namespace {

/// A quantum or a gap has its minimum in a slot narrower than the grid: each parameter by small steps about the
/// start.
void scan(Model& model, Fit& best, Index first, Index count) {
  VectorXd residuals;
  for (Index j = first; j < first + count; ++j) {
    const double middle = best.x[j];
    std::vector<VectorXd> points;
    for (int step = -9; step <= 9; ++step) {
      if (step != 0) {
        points.push_back(best.x);
        points.back()[j] = std::clamp(middle * (1.0 + 0.004 * step), model.lower()[j], model.upper()[j]);
      }
    }
    model.foresee(points);
    for (const VectorXd& x : points) {
      if (!model.residuals(x, residuals)) {
        continue;
      }
      const double cost = cost_of(model, x, residuals, nullptr);
      if (cost < best.cost) {
        best.x = x;
        best.cost = cost;
      }
    }
  }
}

/// One unknown, times a factor or by a shift.
struct TrialStep {
  Index unknown = 0;
  double factor = 1.0;
  double shift = 0.0;
};

/// The unknowns of a set that are instants.
std::vector<Index> instants_of(const Model& model, const Variant& variant) {
  std::vector<Index> result;
  for (std::size_t k = 0; k < variant.further.size(); ++k) {
    const std::string& path = variant.further[k].path;
    const auto owner = std::ranges::find_if(
        variant.effects, [&](const Applied& one) { return std::ranges::find(one.paths, path) != one.paths.end(); });
    if (owner != variant.effects.end() && owner->parameter(path).role == Role::Instant) {
      result.push_back(model.first_further() + static_cast<Index>(k));
    }
  }
  return result;
}

/// What a pattern search moves.
struct Pattern {
  Index first = 0;
  Index count = 0;
  double finest = 0.0;            ///< the last step, as a share
  std::vector<Index> instants{};  ///< these by whole samples: a derivative sees the one sample beside an instant
  double sample = 0.0;            ///< in s
};

/// Where the output jumps with a parameter, derivatives do not see the way: single steps by trial, then a last fit.
void pattern_search(Model& model, Fit& best, const Pattern& pattern) {
  std::vector<TrialStep> trials;
  const auto is_moved = [&](Index j) { return j >= pattern.first && j < pattern.first + pattern.count; };
  for (const double share : {0.08, 0.03, 0.01, 0.003, 0.001, 3e-4, 1e-4}) {
    for (Index j = pattern.first; is_moved(j) && share >= pattern.finest; ++j) {
      trials.push_back({.unknown = j, .factor = 1.0 + share});
      trials.push_back({.unknown = j, .factor = 1.0 - share});
    }
  }
  for (const double samples : {4.0, 2.0, 1.0}) {
    for (const Index j : pattern.instants) {
      if (is_moved(j)) {
        trials.push_back({.unknown = j, .shift = samples * pattern.sample});
        trials.push_back({.unknown = j, .shift = -samples * pattern.sample});
      }
    }
  }
  const auto moved_by = [&](const TrialStep& trial) {
    VectorXd x = best.x;
    const Index j = trial.unknown;
    x[j] = std::clamp(x[j] * trial.factor + trial.shift, model.lower()[j], model.upper()[j]);
    return x;
  };
  const auto foresee_from = [&](std::size_t next) {
    std::vector<VectorXd> points;
    std::transform(trials.begin() + static_cast<std::ptrdiff_t>(next), trials.end(), std::back_inserter(points),
                   moved_by);
    model.foresee(std::move(points));
  };
  foresee_from(0);
  VectorXd residuals;
  bool moved = false;
  for (std::size_t k = 0; k < trials.size(); ++k) {
    const VectorXd x = moved_by(trials[k]);
    if (!model.residuals(x, residuals)) {
      continue;
    }
    const double cost = cost_of(model, x, residuals, nullptr);
    if (cost < best.cost * (1.0 - 1e-6)) {
      best.x = x;
      best.cost = cost;
      moved = true;
      foresee_from(k + 1);
    }
  }
  if (moved) {
    Fit again = fit(model, best.x, {.iterations = 12});
    if (again.cost <= best.cost) {
      best = std::move(again);
    } else {
      (void)model.residuals(best.x, best.residuals, &best.jacobian);
    }
  }
}

/// The unknowns of an effect with the frequency of a line that the residual shows held there, to half a turn over the
/// record: while the rest is still far off, a fit would bend it towards what is no line.
std::vector<Unknown> held_at_measured(const Task& task, const Screened& one, const Start& start) {
  std::vector<Unknown> unknowns = one.unknowns;
  const records::Record& record = task.records.front();
  const double half_turn = 0.5 / (record.sample_time() * static_cast<double>(record.size()));
  for (std::size_t k = 0; k < unknowns.size() && start.measured; ++k) {
    if (one.candidate.own().parameter(unknowns[k].path).role == Role::Frequency) {
      const double value = start.values[static_cast<Index>(k)];
      unknowns[k].start = value;
      unknowns[k].lower = std::max(unknowns[k].lower, value - half_turn);
      unknowns[k].upper = std::min(unknowns[k].upper, value + half_turn);
    }
  }
  return unknowns;
}

}  // namespace

std::vector<std::string> Explanation::names() const {
  std::vector<std::string> names;
  for (const Applied& applied : variant.effects) {
    names.push_back(applied.effect);
  }
  std::ranges::sort(names);
  return names;
}

std::vector<std::string> Explanation::places() const {
  std::vector<std::string> places;
  for (const Applied& applied : variant.effects) {
    places.push_back(applied.place());
  }
  std::ranges::sort(places);
  return places;
}

double cost_of_fit(const Explanation& one) {
  return one.fit.cost;
}

std::optional<Index> place_in_fit(const Task& task, const Explanation& one, const std::string& path) {
  const auto found = std::ranges::find(one.variant.further, path, &Unknown::path);
  return found == one.variant.further.end()
             ? std::nullopt
             : std::optional(std::ssize(task.known) + (found - one.variant.further.begin()));
}

Explanation placed(const Task& task, const Screened& one, const Start& start, const VectorXd& known) {
  Explanation result{.variant = one.candidate.variant};
  std::vector<Unknown>& further = result.variant.further;
  const Index inherited = std::ssize(further);
  std::ranges::move(held_at_measured(task, one, start), std::back_inserter(further));
  const Index first = std::ssize(task.known) + inherited;
  const Index own = std::ssize(one.unknowns);
  VectorXd& x = result.fit.x;
  x.resize(known.size() + own);
  x << known.head(first), start.values, known.tail(known.size() - first);
  for (Index j = 0; j < own; ++j) {
    Unknown& unknown = further[static_cast<std::size_t>(inherited + j)];
    unknown.start = std::clamp(start.values[j], unknown.lower, unknown.upper);
  }
  return result;
}

Explanation begun_from(const Task& task, const Screened& one, const Explanation& from,
                       const KnownStarts& known_starts) {
  Explanation best{.variant = one.candidate.variant};
  const auto begin_at = [&](const VectorXd& known, const Start& start) {
    Explanation here = placed(task, one, start, known);
    std::vector<Unknown>& further = here.variant.further;
    Model model(task, *here.variant.program, further);
    here.fit = fit(model, here.fit.x, {.iterations = 5, .tolerance = 1e-4});
    if (here.fit.cost < best.fit.cost) {
      for (std::size_t j = 0; j < further.size(); ++j) {
        further[j].unit = model.problem().parameters[task.known.size() + j].unit;
      }
      keep_starts(here, model);
      best = std::move(here);
    }
  };
  const double worth = one.candidate.own().has(Role::Period) ? 0.25 : 0.5;  // of the best start's gain
  for (const Start& start : one.starts) {
    if (start.measured || start.gain >= worth * one.gain()) {
      begin_at(start.about_calibration ? known_starts.calibrated : from.fit.x, start);
    }
  }
  if (from.variant.effects.empty()) {
    begin_at(known_starts.other, one.starts.front());
  }
  return best;
}

void finish(const Task& task, Explanation& one, const FinishOptions& options) {
  Model model(task, *one.variant.program, one.variant.further);
  const Applied& own = one.variant.effects.back();
  const Index count = std::ranges::count_if(own.paths, [&](const std::string& path) {
    return std::ranges::none_of(own.settings, [&](const auto& setting) { return setting.first == path; });
  });
  const Index first = model.first_further() + std::ssize(one.variant.further) - count;
  if (own.has_gap()) {
    scan(model, one.fit, first, count);
  }
  const bool thoroughly = options.thoroughly;
  one.fit = fit(model, one.fit.x,
                {.iterations = thoroughly ? 60 : 20, .tolerance = thoroughly ? 1e-6 : 1e-5, .stop = options.stop});
  const bool is_cut = options.stop && options.stop();  // single steps take as long again
  Pattern pattern{.first = first,
                  .count = count,
                  .finest = 0.003,
                  .instants = instants_of(model, one.variant),
                  .sample = task.records.front().sample_time()};
  if (own.has_gap() && !is_cut) {
    // A hundred steps from 0, a quantum that is off by a thousandth is off by a tenth of itself.
    pattern.first = 0;
    pattern.count = first + count;
    pattern.finest = thoroughly && own.has(Role::Quantum) ? 1e-4 : 0.003;
    pattern_search(model, one.fit, pattern);
  } else if (thoroughly && !is_cut) {
    pattern_search(model, one.fit, pattern);
  }
  keep_starts(one, model);
}

void keep_starts(Explanation& one, const Model& model) {
  for (std::size_t j = 0; j < one.variant.further.size() && std::isfinite(one.fit.cost); ++j) {
    one.variant.further[j].start = one.fit.x[model.first_further() + static_cast<Index>(j)];
  }
}

}  // namespace hysteron::diagnosis
