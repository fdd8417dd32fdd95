#include "tuning/goal/goal_model.hpp"

#include <algorithm>
#include <cmath>

#include "support/numbers.hpp"

namespace hysteron {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Of places of one limit in one plant: the largest ones bound the others.
constexpr std::size_t most_places = 12;
constexpr double settled_band = 0.02;

bool is_of_test(LimitKind kind) {
  return kind == LimitKind::Effort || kind == LimitKind::Rate || kind == LimitKind::Overshoot;
}

/// The unit in which an excess is counted.
double excess_unit(LimitKind kind, double limit) {
  return kind == LimitKind::Overshoot ? std::max(limit, 1.0) : kind == LimitKind::Sensitivity ? std::log(limit) : limit;
}

}  // namespace

double excess_over(LimitKind kind, double value, double limit) {
  const double over = kind == LimitKind::Sensitivity ? std::log(value / limit) : value - limit;
  return (text_of(kind).is_least ? -over : over) / excess_unit(kind, limit);
}

GoalModel::GoalModel(const GoalProblem& problem) : problem_(problem) {
  for (const LoopPlant& plant : problem.plants) {
    plants_.push_back(std::make_unique<PlantPoint>(LoopRun(plant, problem.drive, problem.parameters)));
  }
}

LoopState GoalModel::evaluate(const VectorXd& x, bool with_derivatives) {
  for (std::size_t plant = 0; plant < plants_.size(); ++plant) {
    PlantPoint& point = *plants_[plant];
    point.sensitivity.reset();
    const LoopState state = point.run.respond(x, with_derivatives, point.response);
    if (state != LoopState::Settles) {
      failed_plant_ = plant;
      return state;
    }
    take_cost(point, with_derivatives);
    if (problem_.settings.limits_margins()) {
      point.margins = sensitivity(plant)->margins();
    }
  }
  return LoopState::Settles;
}

const Sensitivity* GoalModel::sensitivity(std::size_t plant) {
  PlantPoint& point = *plants_[plant];
  if (!point.sensitivity && !point.response.impulse.empty()) {
    point.sensitivity.emplace(point.response.impulse, point.response.impulse_by, problem_.drive.sample_time);
  }
  return point.sensitivity ? &*point.sensitivity : nullptr;
}

/// J = mean of ((y − y_wished)/size)² + (w·(u(k) − u(k−1))/TS)² from the step on, over the test's duration.
void GoalModel::take_cost(PlantPoint& point, bool with_derivatives) const {
  const LoopResponse& response = point.response;
  const double weight = problem_.weight() / problem_.drive.sample_time;
  const auto count = static_cast<double>(problem_.end - problem_.begin);
  point.cost = 0.0;
  point.cost_by = VectorXd::Zero(with_derivatives ? response.output_by.cols() : 0);
  for (std::size_t k = problem_.begin; k < problem_.end; ++k) {
    const auto row = static_cast<Index>(k);
    const double error = (response.output[k] - problem_.wished[k]) / problem_.size;
    const double move = k == 0 ? 0.0 : weight * (response.effort[k] - response.effort[k - 1]);
    point.cost += (error * error + move * move) / count;
    if (with_derivatives) {
      point.cost_by += 2.0 * error / (count * problem_.size) * response.output_by.row(row).transpose();
      if (move != 0.0) {
        point.cost_by +=
            2.0 * move * weight / count * (response.effort_by.row(row) - response.effort_by.row(row - 1)).transpose();
      }
    }
  }
}

double GoalModel::cost() const {
  double worst = 0.0;
  double sum = 0.0;
  for (const auto& point : plants_) {
    worst = std::max(worst, point->cost);
    sum += point->cost;
  }
  return problem_.settings.robust == parameters::GoalSettings::Robust::Worst
             ? worst
             : sum / static_cast<double>(plants_.size());
}

double GoalModel::at_step(LimitKind kind, const LoopResponse& response, std::size_t step) const {
  if (kind == LimitKind::Effort) {
    return response.effort[step];
  }
  if (kind == LimitKind::Rate) {
    return step == 0 ? 0.0 : (response.effort[step] - response.effort[step - 1]) / problem_.drive.sample_time;
  }
  const Signal& input = problem_.drive.inputs[problem_.input];
  const double direction = input.back() < input.front() ? -1.0 : 1.0;
  return 100.0 * direction * (response.output[step] - input.back()) / problem_.size;
}

double GoalModel::value_of(std::size_t limit, std::size_t plant) const {
  const LimitKind kind = problem_.limits[limit].kind;
  const PlantPoint& point = *plants_[plant];
  if (kind == LimitKind::Gain) {
    return point.margins->gain.value;
  }
  if (kind == LimitKind::Phase) {
    return point.margins->phase.value;
  }
  if (kind == LimitKind::Sensitivity) {
    return point.margins->sensitivity.value;
  }
  return largest_in_test(kind, point.response);
}

double GoalModel::largest_in_test(LimitKind kind, const LoopResponse& response) const {
  double largest = 0.0;
  for (std::size_t k = problem_.begin; k < problem_.drive.steps; ++k) {
    largest = std::max(largest, size_at(kind, response, k));
  }
  return largest;
}

double GoalModel::size_at(LimitKind kind, const LoopResponse& response, std::size_t step) const {
  const double value = at_step(kind, response, step);
  return kind == LimitKind::Overshoot ? value : std::fabs(value);
}

double GoalModel::largest_excess() const {
  double largest = -1.0;
  for (std::size_t limit = 0; limit < problem_.limits.size(); ++limit) {
    for (std::size_t plant = 0; plant < plants_.size(); ++plant) {
      const GoalLimit& one = problem_.limits[limit];
      largest = std::max(largest, excess_over(one.kind, value_of(limit, plant), one.limit));
    }
  }
  return largest;
}

std::vector<LimitPlace> GoalModel::places(std::size_t limit, std::size_t plant, double least) const {
  const auto [kind, bound, place] = problem_.limits[limit];
  const PlantPoint& point = *plants_[plant];
  if (kind == LimitKind::Gain || kind == LimitKind::Phase) {
    return {{.limit = limit, .plant = plant}};
  }
  std::vector<LimitPlace> found;
  if (kind == LimitKind::Sensitivity) {
    for (const double frequency : point.sensitivity->peaks_above(bound * std::pow(bound, least))) {
      found.push_back({.limit = limit, .plant = plant, .frequency = frequency});
    }
  } else {
    const auto size = [&, kind = kind](std::size_t k) { return size_at(kind, point.response, k); };
    for (std::size_t k = problem_.begin; k < problem_.drive.steps; ++k) {
      const bool is_peak =
          (k == problem_.begin || size(k) > size(k - 1)) && (k + 1 == problem_.drive.steps || size(k) >= size(k + 1));
      if (is_peak && excess_over(kind, size(k), bound) > least) {
        found.push_back({.limit = limit,
                         .plant = plant,
                         .step = k,
                         .sign = at_step(kind, point.response, k) < 0.0 && kind != LimitKind::Overshoot ? -1.0 : 1.0});
      }
    }
    std::ranges::stable_sort(found, [&](const auto& a, const auto& b) { return size(a.step) > size(b.step); });
  }
  found.resize(std::min(found.size(), most_places));
  return found;
}

Margin GoalModel::excess(const LimitPlace& place) const {
  const GoalLimit& limit = problem_.limits[place.limit];
  const PlantPoint& point = *plants_[place.plant];
  const double unit = excess_unit(limit.kind, limit.limit);
  if (!is_of_test(limit.kind)) {
    if (limit.kind == LimitKind::Sensitivity) {
      Margin size = point.sensitivity->log_size(place.frequency);
      return {.value = (size.value - std::log(limit.limit)) / unit, .by = size.by / unit};
    }
    const Margin& margin = limit.kind == LimitKind::Gain ? point.margins->gain : point.margins->phase;
    const double over = excess_over(limit.kind, margin.value, limit.limit);
    if (over < -1.0) {  // far away, or no crossing at all: no direction is better
      return {.value = -1.0, .by = VectorXd::Zero(margin.by.size())};
    }
    return {.value = over, .by = -margin.by / unit};
  }
  const LoopResponse& response = point.response;
  const auto row = static_cast<Index>(place.step);
  const double value = place.sign * at_step(limit.kind, response, place.step);
  VectorXd by;
  if (limit.kind == LimitKind::Effort) {
    by = response.effort_by.row(row);
  } else if (limit.kind == LimitKind::Rate) {
    by = (response.effort_by.row(row) - response.effort_by.row(row - 1)) / problem_.drive.sample_time;
  } else {
    const Signal& input = problem_.drive.inputs[problem_.input];
    by = (input.back() < input.front() ? -100.0 : 100.0) / problem_.size * response.output_by.row(row);
  }
  return {.value = excess_over(limit.kind, value, limit.limit), .by = place.sign / unit * by};
}

LoopFigures GoalModel::figures(std::size_t plant) {
  const PlantPoint& point = *plants_[plant];
  const Signal& input = problem_.drive.inputs[problem_.input];
  const double ts = problem_.drive.sample_time;
  LoopFigures figures{.error = std::sqrt(point.cost),
                      .overshoot = not_a_number,
                      .rise_time = not_a_number,
                      .settling_time = not_a_number,
                      .effort = not_a_number,
                      .rate = not_a_number};
  if (const Sensitivity* const loop = sensitivity(plant)) {
    figures.margins = point.margins ? *point.margins : loop->margins();
  }
  if (problem_.plants[plant].effort) {
    figures.effort = largest_in_test(LimitKind::Effort, point.response);
    figures.rate = largest_in_test(LimitKind::Rate, point.response);
  }
  if (problem_.settings.signal != parameters::GoalSettings::Signal::Step) {
    return figures;
  }
  figures.overshoot = largest_in_test(LimitKind::Overshoot, point.response);
  std::optional<std::size_t> at_tenth;
  std::optional<std::size_t> at_nine_tenths;
  std::size_t outside = problem_.begin;
  for (std::size_t k = problem_.begin; k < problem_.drive.steps; ++k) {
    const double done = (point.response.output[k] - input.front()) / (input.back() - input.front());
    at_tenth = at_tenth || done < 0.1 ? at_tenth : std::optional(k);
    at_nine_tenths = at_nine_tenths || done < 0.9 ? at_nine_tenths : std::optional(k);
    outside = std::fabs(done - 1.0) > settled_band ? k + 1 : outside;
  }
  if (at_tenth && at_nine_tenths) {
    figures.rise_time = static_cast<double>(*at_nine_tenths - *at_tenth) * ts;
  }
  if (outside < problem_.drive.steps) {
    figures.settling_time = static_cast<double>(outside - problem_.begin) * ts;
  }
  return figures;
}

}  // namespace hysteron
