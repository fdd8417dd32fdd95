#include "diagnosis/search/expansion.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <iterator>
#include <utility>

#include "diagnosis/effects/drivers.hpp"
#include "diagnosis/model/budget.hpp"
#include "diagnosis/model/refusal.hpp"
#include "diagnosis/noise/spectrum.hpp"
#include "diagnosis/search/shortlist.hpp"
#include "tuning/covariance.hpp"

namespace hysteron::diagnosis {
namespace {

/// So many of the best fits of a round go to the end in any case.
constexpr std::size_t finished_always = 6;
/// Of what a straight line leaves of the tuned parameters' part, a bent one leaves less than this where it is bent.
constexpr double straight_enough = 0.5;
/// A calibration is near that moves no parameter by as many deviations of its prior, leaves a small part of what the
/// tuned parameters leave, and no more than a straight line about these.
constexpr double near_shift = 1.0;
constexpr double near_left = 0.1;
constexpr double near_straight = 1.1;
/// One point in so many of a long grid comes first.
constexpr std::size_t stride = 3;
/// Of a period many are tried: the one that a straight line favours before a fit is often not the one.
std::size_t starts_kept(const Applied& effect) {
  return effect.has(Role::Period) ? 6 : 3;
}

/// What a fit has to gain, in nats, to be followed further: a verdict asks for 6 beyond the penalties, which are as
/// many.
constexpr double more_than_chance = 10.0;

/// Costs above this many of the floor's are a gap, however little one effect alone gains on it.
constexpr double surely_a_gap = 2.0;

/// What a fit gains in log likelihood with the noise left open, on as many samples as its residuals are worth.
double nats_gained(double cost_before, const Fit& fit) {
  const double samples = static_cast<double>(fit.residuals.size()) / std::max(1.0, correlation_time(fit.residuals));
  return 0.5 * samples * std::log(cost_before / std::max(fit.cost, 1e-300));
}

}  // namespace

KnownStarts Footing::known_starts() const {
  return {.calibrated = calibrated.fit.x, .other = about_nominal ? calibrated.fit.x : nominal.fit.x};
}

Footing footing_of(const Task& task, Variant base) {
  Footing result{.calibrated = {.variant = std::move(base)}};
  Model model(task, *result.calibrated.variant.program);
  result.calibrated.fit = fit(model, model.start(), {.iterations = 40, .tolerance = 1e-7});
  result.nominal = result.calibrated;
  Fit& nominal = result.nominal.fit;
  nominal.x = model.start();
  (void)model.residuals(nominal.x, nominal.residuals, &nominal.jacobian);
  nominal.cost = cost_of(model, nominal.x, nominal.residuals, nullptr);
  result.nominal_cost = Background(model, nominal).unexplained();
  const double calibrated_cost = Background(model, result.calibrated.fit).unexplained();
  const double shift =
      (result.calibrated.fit.x - nominal.x).cwiseProduct(model.prior()).lpNorm<Eigen::Infinity>();  // 0 of none
  result.about_nominal = calibrated_cost > straight_enough * result.nominal_cost;
  result.is_near = result.about_nominal && shift < near_shift && calibrated_cost < near_left * nominal.cost &&
                   calibrated_cost < near_straight * result.nominal_cost;
  return result;
}

void Expansion::progress_within(double begin, double width) {
  begin_ = begin;
  width_ = width;
}

void Expansion::say(double fraction, std::string_view text) {
  if (options_.progress) {
    const std::lock_guard lock(mutex_);
    options_.progress(begin_ + width_ * fraction, text);
  }
}

std::vector<Explanation> Expansion::of(const Explanation& from, const Wanted& wanted, std::size_t fitted) {
  std::vector<Screened> list = screen(from, wanted, fitted);
  keep_best(list, fitted, from.variant.effects.empty() ? 2 : 1);
  return fitted_and_finished(list, from);
}

std::vector<Screened> Expansion::screen(const Explanation& from, const Wanted& wanted, std::size_t fitted) {
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
  tried_ += candidates.size();
  // Lines and periods show best where a calibration has taken off what is none.
  const VectorXd& shown = from.variant.effects.empty() ? footing_.calibrated.fit.residuals : from.fit.residuals;
  const Hints hints = hints_of(task_, shown);
  StrongestPeriods strongest(shown, periods_tried);
  Model model(task_, *from.variant.program, from.variant.further);
  const Background background(model, from.fit);

  std::vector<Screened> list(candidates.size());
  std::vector<Grids> grids(candidates.size());
  std::atomic<std::size_t> done{0};
  in_batches(candidates.size(), options_.threads, options_.budget, [&](std::size_t i) {
    const Driven* const signals = drivers.find(candidates[i]);
    if (signals == nullptr || !(signals->input.range() >= 0.0) || must_stop()) {
      return;
    }
    std::vector<double> periods;
    if (candidates[i].own().has(Role::Period) || candidates[i].own().has(Role::Quantum)) {
      periods = strongest.over(signals->auxiliary_values ? *signals->auxiliary_values : signals->input_values);
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
  if (from.variant.effects.empty() && footing_.about_nominal && &from != &footing_.calibrated) {
    about_calibration(list, candidates, grids);
  }
  std::erase_if(list, [](const Screened& one) { return one.starts.empty(); });
  std::ranges::stable_sort(list, [](const Screened& a, const Screened& b) { return a.gain() > b.gain(); });
  if (from.variant.effects.empty()) {
    singles_ = list;
  }
  return list;
}

std::vector<Explanation> Expansion::fitted_and_finished(const std::vector<Screened>& list, const Explanation& from) {
  const KnownStarts known_starts = footing_.known_starts();
  std::vector<Explanation> fits(list.size());
  std::atomic<std::size_t> done{0};
  in_batches(list.size(), options_.threads, options_.budget, [&](std::size_t i) {
    if (must_stop()) {
      return;
    }
    fits[i] = begun_from(task_, list[i], from, known_starts);
    say(0.6 + 0.3 * static_cast<double>(++done) / static_cast<double>(list.size()),
        list[i].candidate.own().effect + " at " + list[i].candidate.own().edge);
  });
  std::erase_if(fits, [](const Explanation& one) { return !std::isfinite(one.fit.cost); });
  finish_front(fits, from.fit.cost);
  return fits;
}

bool Expansion::is_worth_following(double cost_before, const Fit& best) const {
  return cost_before > surely_a_gap * floor_cost_ || nats_gained(cost_before, best) > more_than_chance;
}

void Expansion::finish_front(std::vector<Explanation>& fits, double cost_before) {
  std::ranges::stable_sort(fits, {}, cost_of_fit);
  const bool decides = !fits.empty() && is_worth_following(cost_before, fits.front().fit);
  std::atomic<std::size_t> done{0};
  in_batches(fits.size(), options_.threads, options_.budget, [&](std::size_t i) {
    const bool in_front =
        decides && !must_stop() && cost_before - fits[i].fit.cost > 0.25 * (cost_before - fits.front().fit.cost);
    if (i < finished_always || in_front) {
      finish(task_, fits[i], {.thoroughly = i < finished_always, .stop = [&] { return must_stop(); }});
    }
    say(0.9 + 0.1 * static_cast<double>(++done) / static_cast<double>(fits.size()), "last steps of the fits");
  });
}

void Expansion::refine(std::vector<Screened>& list, const std::vector<Candidate>& candidates,
                       const std::vector<Grids>& grids, const Explanation& from, const Background& background,
                       std::size_t count) {
  const std::vector<std::size_t> order = front_of(list, candidates, count);
  std::atomic<std::size_t> done{0};
  in_batches(order.size(), options_.threads, options_.budget, [&](std::size_t i) {
    const std::size_t at = order[i];
    if (!list[at].starts.empty() && !must_stop()) {
      list[at] = screened_about(list[at].starts, stride, task_, candidates[at], grids[at], from.fit.x, background,
                                starts_kept(candidates[at].own()));
    }
    say(0.4 + 0.2 * static_cast<double>(++done) / static_cast<double>(order.size()), "finer grids");
  });
}

void Expansion::about_calibration(std::vector<Screened>& list, const std::vector<Candidate>& candidates,
                                  const std::vector<Grids>& grids) {
  const Explanation& calibrated = footing_.calibrated;
  Model model(task_, *calibrated.variant.program);
  const Background background(model, calibrated.fit);
  std::vector<Screened> others(list.size());
  in_batches(list.size(), options_.threads, options_.budget, [&](std::size_t i) {
    if (candidates[i].own().has_gap() && !grids[i].parameters.empty()) {
      others[i] = unless_refused([&] {
        return screened(task_, candidates[i], thinned(candidates[i].own(), grids[i], stride), calibrated.fit.x,
                        background, 2);
      });
    }
  });
  const std::vector<std::size_t> front = front_of(others, candidates, 0);
  in_batches(front.size(), options_.threads, options_.budget, [&](std::size_t k) {
    const std::size_t i = front[k];
    if (others[i].starts.empty()) {
      return;
    }
    Screened other =
        screened_about(others[i].starts, stride, task_, candidates[i], grids[i], calibrated.fit.x, background, 2);
    // Gains are held against each other by what is left: the calibrated residual is the smaller one.
    const double saved = footing_.nominal_cost - calibrated.fit.cost;
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

}  // namespace hysteron::diagnosis
