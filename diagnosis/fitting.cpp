#include "diagnosis/fitting.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hysteron::diagnosis {
namespace {

/// A quantum or a gap has its minimum in a slot narrower than the grid: each parameter by small steps about the
/// start.
void scan(Model& model, Fit& best, Index first, Index count) {
  VectorXd residuals;
  for (Index j = first; j < first + count; ++j) {
    const double middle = best.x[j];
    for (int step = -9; step <= 9; ++step) {
      VectorXd x = best.x;
      x[j] = std::clamp(middle * (1.0 + 0.004 * step), model.lower()[j], model.upper()[j]);
      if (step == 0 || !model.residuals(x, residuals)) {
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

/// Where the output jumps with a parameter, derivatives do not see the way: single steps by trial, then a last fit.
void pattern_search(Model& model, Fit& best, Index first, Index count) {
  VectorXd residuals;
  bool moved = false;
  for (const double share : {0.08, 0.03, 0.01, 0.003}) {
    for (Index j = first; j < first + count; ++j) {
      for (const double sign : {1.0, -1.0}) {
        VectorXd x = best.x;
        x[j] = std::clamp(x[j] * (1.0 + sign * share), model.lower()[j], model.upper()[j]);
        if (!model.residuals(x, residuals)) {
          continue;
        }
        const double cost = cost_of(model, x, residuals, nullptr);
        if (cost < best.cost * (1.0 - 1e-6)) {
          best.x = x;
          best.cost = cost;
          moved = true;
        }
      }
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

Explanation begun_from(const Task& task, const Screened& one, const Explanation& from,
                       const KnownStarts& known_starts) {
  Explanation best{.variant = one.candidate.variant};
  best.fit.cost = std::numeric_limits<double>::infinity();
  std::vector<Unknown>& further = best.variant.further;
  const std::size_t inherited = further.size();
  further.insert(further.end(), one.unknowns.begin(), one.unknowns.end());
  Model model(task, *one.candidate.variant.program, further);
  const Index first = model.first_further() + static_cast<Index>(inherited);
  VectorXd x(model.unknowns());
  const auto begin_at = [&](const VectorXd& known, const Start& start) {
    x.head(first) = known.head(first);
    x.segment(first, std::ssize(one.unknowns)) = start.values;
    x.tail(model.unknowns() - first - std::ssize(one.unknowns)) = known.tail(known.size() - first);
    Fit here = fit(model, x, {.iterations = 5, .tolerance = 1e-4});
    if (here.cost < best.fit.cost) {
      best.fit = std::move(here);
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
  for (std::size_t j = 0; j < further.size(); ++j) {
    further[j].unit = model.problem().parameters[task.known.size() + j].unit;
  }
  keep_starts(best, model);
  return best;
}

void finish(const Task& task, Explanation& one, bool thoroughly) {
  Model model(task, *one.variant.program, one.variant.further);
  const Applied& own = one.variant.effects.back();
  const Index count = std::ranges::count_if(own.paths, [&](const std::string& path) {
    return std::ranges::none_of(own.settings, [&](const auto& setting) { return setting.first == path; });
  });
  const Index first = model.first_further() + std::ssize(one.variant.further) - count;
  if (own.has_gap()) {
    scan(model, one.fit, first, count);
  }
  one.fit = fit(model, one.fit.x, {.iterations = thoroughly ? 60 : 20, .tolerance = thoroughly ? 1e-6 : 1e-5});
  if (own.has_gap()) {
    pattern_search(model, one.fit, 0, first + count);
  } else if (thoroughly) {
    pattern_search(model, one.fit, first, count);
  }
  keep_starts(one, model);
}

void keep_starts(Explanation& one, const Model& model) {
  for (std::size_t j = 0; j < one.variant.further.size() && std::isfinite(one.fit.cost); ++j) {
    one.variant.further[j].start = one.fit.x[model.first_further() + static_cast<Index>(j)];
  }
}

}  // namespace hysteron::diagnosis
