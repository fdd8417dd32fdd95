#include "diagnosis/search/tried_effect.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <utility>

namespace hysteron::diagnosis {
namespace {

/// Outputs within this share of twice the change at half the strength: linear in it.
constexpr double linear_within = 0.05;

}  // namespace

TriedEffect::TriedEffect(const Task& task, Candidate candidate, const Grids& grids, const VectorXd& at,
                         const Background& background)
    : grids_(grids), background_(background) {
  screened_.candidate = std::move(candidate);
  const Applied& own = screened_.candidate.own();
  neutral_.resize(std::ssize(own.parameters));
  std::vector<Unknown> further = screened_.candidate.variant.further;
  for (std::size_t j = 0; j < own.parameters.size(); ++j) {
    if (std::isnan(grids.settings[j])) {
      screened_.unknowns.push_back(unknown_of(own.parameters[j], own.paths[j], grids.parameters[j]));
      further.push_back(screened_.unknowns.back());
      free_.push_back(static_cast<Index>(j));
      neutral_[static_cast<Index>(j)] =
          own.parameters[j].strength ? own.parameters[j].field.neutral : screened_.unknowns.back().start;
    } else {
      screened_.candidate.variant.effects.back().settings.emplace_back(own.paths[j], grids.settings[j]);
      neutral_[static_cast<Index>(j)] = grids.settings[j];
    }
  }
  auto program = std::make_shared<Program>(*screened_.candidate.variant.program);
  for (const auto& [path, value] : own.settings) {
    set_parameter(program->graph, path, value);
  }
  screened_.candidate.variant.program = std::move(program);
  model_.emplace(task, *screened_.candidate.variant.program, further);
  first_ = model_->first_further() + static_cast<Index>(screened_.candidate.variant.further.size());
  base_.resize(model_->unknowns());
  base_.head(first_) = at.head(first_);
  base_.tail(model_->unknowns() - first_ - std::ssize(free_)) = at.tail(at.size() - first_);
}

VectorXd TriedEffect::unknowns_at(const VectorXd& setting) const {
  VectorXd x = base_;
  for (Index k = 0; k < std::ssize(free_); ++k) {
    const double value = setting[free_[static_cast<std::size_t>(k)]];
    x[first_ + k] = std::clamp(value, model_->lower()[first_ + k], model_->upper()[first_ + k]);
  }
  return x;
}

void TriedEffect::foresee(std::span<const VectorXd> settings) {
  std::vector<VectorXd> points;
  points.reserve(settings.size());
  for (const VectorXd& setting : settings) {
    points.push_back(unknowns_at(setting));
  }
  model_->foresee_first(std::move(points));
}

VectorXd TriedEffect::change_at(const VectorXd& setting) {
  VectorXd residuals;
  if (!model_->residuals(unknowns_at(setting), residuals)) {
    return {};
  }
  residuals -= background_.residuals();
  return residuals;
}

std::vector<Index> TriedEffect::strengths() const {
  std::vector<Index> list;
  for (Index j = 0; j < parameter_count(); ++j) {
    if (parameter(j).strength && !points(j).empty()) {
      list.push_back(j);
    }
  }
  return list;
}

bool TriedEffect::is_linear(Index strength, const VectorXd& setting, const VectorXd& change) {
  if (!std::isfinite(parameter(strength).field.neutral)) {
    return false;
  }
  VectorXd twice = setting;
  twice[strength] += setting[strength] - parameter(strength).field.neutral;
  const VectorXd double_change = change_at(twice);
  return double_change.size() > 0 && (double_change - 2.0 * change).norm() <= linear_within * double_change.norm();
}

bool TriedEffect::is_linear_there(const VectorXd& shape) {
  const std::vector<Index> list = strengths();
  for (Index k = std::ssize(linear_); k < std::ssize(list); ++k) {
    const Index j = list[static_cast<std::size_t>(k)];
    VectorXd setting = shape;
    setting[j] = points(j).front();
    const VectorXd change = change_at(setting);
    linear_.push_back(change.size() > 0 && is_linear(j, setting, change));
  }
  return std::ranges::all_of(linear_, [](bool one) { return one; });
}

VectorXd TriedEffect::shape_of(VectorXd setting) const {
  for (const Index strength : strengths()) {
    setting[strength] = neutral_[strength];
  }
  return setting;
}

bool TriedEffect::are_amplitudes(const std::vector<Index>& list) const {
  return std::ranges::all_of(list, [&](Index j) {
    const EffectParameter& one = parameter(j);
    return std::isfinite(one.field.neutral) && !is_gap(one.role) && one.role != Role::Rate &&
           one.role != Role::Duration;
  });
}

double TriedEffect::small(Index strength, bool linear) const {
  const std::vector<double>& grid = points(strength);
  return linear ? grid.front() : grid[grid.size() / 2];
}

void TriedEffect::foresee_changes(std::span<const VectorXd> shapes) {
  if (shapes.empty()) {
    return;
  }
  const std::vector<Index> list = strengths();
  const bool linear = is_linear_there(shapes.front());
  if (!linear && !are_amplitudes(list)) {
    return;
  }
  std::vector<VectorXd> settings;
  for (const VectorXd& shape : shapes) {
    for (const Index j : list) {
      settings.push_back(shape);
      settings.back()[j] = small(j, linear);
    }
  }
  foresee(settings);
}

Screened TriedEffect::with(std::vector<Start> starts) && {
  screened_.starts = std::move(starts);
  return std::move(screened_);
}

}  // namespace hysteron::diagnosis
