#include "diagnosis/model/model.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "tuning/rollout.hpp"

namespace hysteron::diagnosis {
namespace {

parameters::FitSetting fit_of(const Unknown& unknown) {
  parameters::FitSetting fit{.path = unknown.path, .record = unknown.record};
  fit.start = parameters::PlacedNumber{.value = unknown.start};
  if (std::isfinite(unknown.lower)) {
    fit.minimum = parameters::PlacedNumber{.value = unknown.lower};
  }
  if (std::isfinite(unknown.upper)) {
    fit.maximum = parameters::PlacedNumber{.value = unknown.upper};
  }
  fit.scale = parameters::PlacedNumber{.value = unknown.typical};
  return fit;
}

/// What a sample costs beside the blocks: its inputs, outputs, residuals and their projections; in blocks.
constexpr std::size_t cost_of_sample = 6;
/// Of a pass that carries the derivatives by eight unknowns, in passes without.
constexpr std::size_t cost_of_derivatives = 5;
/// So many products of a fit's normal equations are a unit.
constexpr std::size_t products_of_a_unit = 16;

}  // namespace

Model::Model(const Task& task, const Program& program, std::span<const Unknown> further)
    : left_out_(task.left_out),
      whitening_(task.whitening),
      effort_(task.effort),
      first_further_(std::ssize(task.known)) {
  parameters::ParameterFile file{.file = task.file.file, .values = task.file.values, .initial = task.file.initial};
  for (const Unknown& unknown : task.known) {
    file.fits.push_back(fit_of(unknown));
  }
  for (const Unknown& unknown : further) {
    file.fits.push_back(fit_of(unknown));
  }
  for (const std::string& output : task.outputs) {
    file.tune.outputs.push_back({.text = output});
  }
  for (const std::string& state : task.initial_states) {
    file.tune.initial_states.push_back({.text = state});
  }
  problem_ = std::make_unique<OutputErrorProblem>(output_error_problem(program, file, task.records, true));
  if (task.shooting) {
    for (std::size_t e = 0; e < problem_->experiments.size(); ++e) {
      problem_->experiments[e].restarts = task.shooting->restarts[e];
    }
  }
  rollout_ = std::make_unique<hysteron::detail::Rollout>(*problem_);
  if (!task.scales.empty()) {
    rollout_->set_scales(task.scales);
  }
  for (std::size_t output = 0; output < task.cells.size(); ++output) {
    cells_.push_back(task.cells[output] / task.scales[output]);
  }

  const Index count = rollout_->unknowns();
  start_.resize(count);
  lower_.resize(count);
  upper_.resize(count);
  typical_.setOnes(count);
  prior_.setZero(count);
  for (std::size_t j = 0; j < problem_->parameters.size(); ++j) {
    const FreeParameter& free = problem_->parameters[j];
    const auto at = static_cast<Index>(j);
    const Unknown& unknown = j < task.known.size() ? task.known[j] : further[j - task.known.size()];
    names_.push_back(free.name);
    start_[at] = free.start;
    lower_[at] = free.lower;
    upper_[at] = free.upper;
    typical_[at] = free.typical;
    if (unknown.rounds) {
      quanta_.push_back(at);
    }
    prior_[at] = unknown.deviation > 0.0 && std::isfinite(unknown.deviation) ? 1.0 / unknown.deviation : 0.0;
  }
  const Index parameters = std::ssize(problem_->parameters);
  const std::vector<double> states = task.shooting && !task.shooting->states.empty()
                                         ? task.shooting->states
                                         : rollout_->own_states(start_.head(parameters));
  auto at = parameters;
  for (const auto& column : rollout_->state_columns()) {
    const FreeState& state = problem_->initial_states[column.state];
    names_.push_back(state.path + " at the start of " + problem_->experiments[column.experiment].name);
    start_[at] = states[static_cast<std::size_t>(at - parameters)];
    lower_[at] = state.lower;
    upper_[at] = state.upper;
    typical_[at] = std::max(std::abs(start_[at]), 1e-3);
    ++at;
  }
}

Model::~Model() = default;

Index Model::rows() const {
  return rollout_->residual_count();
}

VectorXd Model::smooth(VectorXd x) const {
  for (const Index j : quanta_) {
    x[j] = 0.0;
  }
  return x;
}

std::vector<std::size_t> Model::samples() const {
  std::vector<std::size_t> samples;
  for (const Experiment& experiment : problem_->experiments) {
    samples.push_back(experiment.drive.steps);
  }
  return samples;
}

std::vector<double> Model::measured(std::size_t output) const {
  std::vector<double> values;
  for (const Experiment& experiment : problem_->experiments) {
    std::ranges::copy(experiment.measured[output], std::back_inserter(values));
  }
  return values;
}

bool Model::residuals(const VectorXd& x, VectorXd& residuals, MatrixXd* jacobian) {
  residuals.resize(rows());
  if (jacobian != nullptr) {
    jacobian->resize(rows(), unknowns());
  }
  count_work(jacobian != nullptr);
  const bool rounded = std::ranges::any_of(quanta_, [&](Index j) { return x[j] > 0.0; });
  if (!rollout_->residuals(x, residuals, rounded ? nullptr : jacobian) || !residuals.allFinite() ||
      (jacobian != nullptr && rounded && !smooth_jacobian(x, *jacobian)) ||
      (jacobian != nullptr && !jacobian->allFinite())) {
    return false;
  }
  forgive_within_cells(residuals, jacobian);
  for (const Index row : left_out_) {
    residuals[row] = 0.0;
    if (jacobian != nullptr) {
      jacobian->row(row).setZero();
    }
  }
  if (whitening_) {
    whitening_->apply(residuals);
    if (jacobian != nullptr) {
      whitening_->apply(*jacobian);
    }
  }
  return true;
}

void Model::foresee(std::vector<VectorXd> points) {
  rollout_->forget_foreseen();
  rollout_->foresee(std::move(points));
}

void Model::foresee_first(std::vector<VectorXd> points) {
  rollout_->foresee(std::move(points));
}

void Model::count_work(bool derivatives) const {
  std::size_t steps = 0;
  for (const Experiment& experiment : problem_->experiments) {
    steps += experiment.drive.steps;
  }
  const auto columns = static_cast<std::size_t>(unknowns());
  const std::size_t simulated = steps * (problem_->program.graph.nodes.size() + cost_of_sample);
  const std::size_t passes = derivatives ? (columns + 7) / 8 : 0;
  const std::size_t products = derivatives ? static_cast<std::size_t>(rows()) * columns * columns : 0;
  effort_->add(simulated * (1 + passes * cost_of_derivatives) + products / products_of_a_unit);
}

void Model::forgive_within_cells(VectorXd& residuals, MatrixXd* jacobian) const {
  for (Index row = 0; !cells_.empty() && row < rows(); ++row) {
    const double cell = cells_[static_cast<std::size_t>(row * std::ssize(cells_) / rows())];
    const double beyond = residuals[row] - std::clamp(residuals[row], -cell, cell);
    residuals[row] = beyond;
    if (beyond == 0.0 && cell > 0.0 && jacobian != nullptr) {
      jacobian->row(row).setZero();
    }
  }
}

bool Model::smooth_jacobian(const VectorXd& x, MatrixXd& jacobian) {
  VectorXd without(rows());
  if (!rollout_->residuals(smooth(x), without, &jacobian)) {
    return false;
  }
  for (const Index j : quanta_) {
    jacobian.col(j).setZero();
  }
  return true;
}

}  // namespace hysteron::diagnosis
