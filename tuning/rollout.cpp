// See rollout.hpp.
#include "tuning/rollout.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "codegen/cosimulation/session.hpp"
#include "tuning/dual_value.hpp"

namespace hysteron::detail {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

double sample_time_of(const OutputErrorProblem& problem) {
  return problem.experiments.empty() ? 0.0 : problem.experiments.front().drive.sample_time;
}

bool acts_in(const FreeParameter& free, std::size_t experiment) {
  return !free.record || *free.record == experiment;
}

}  // namespace

Rollout::Rollout(const OutputErrorProblem& problem)
    : problem_(problem),
      scales_(problem.outputs.size(), 1.0),
      first_row_(problem.experiments.size(), std::vector<Index>(problem.outputs.size())),
      plain_(problem.program, sample_time_of(problem)) {
  for (std::size_t output = 0; output < problem.outputs.size(); ++output) {
    for (std::size_t e = 0; e < problem.experiments.size(); ++e) {
      first_row_[e][output] = rows_;
      for (const records::RowRange& range : problem.experiments[e].train) {
        rows_ += static_cast<Index>(range.size());
      }
    }
  }
  first_state_.push_back(std::ssize(problem.parameters));
  for (const Experiment& experiment : problem.experiments) {
    first_state_.push_back(first_state_.back() +
                           std::ssize(problem.initial_states) * (1 + std::ssize(experiment.restarts)));
  }
}

Index Rollout::unknowns() const {
  return first_state_.back();
}

std::vector<Rollout::StateColumn> Rollout::state_columns() const {
  std::vector<StateColumn> columns;
  for (std::size_t e = 0; e < problem_.experiments.size(); ++e) {
    for (std::size_t start = 0; start <= problem_.experiments[e].restarts.size(); ++start) {
      for (std::size_t state = 0; state < problem_.initial_states.size(); ++state) {
        columns.push_back({.experiment = e, .start = start, .state = state});
      }
    }
  }
  return columns;
}

Index Rollout::state_column(std::size_t experiment, std::size_t start, std::size_t state) const {
  return first_state_[experiment] + static_cast<Index>(start * problem_.initial_states.size() + state);
}

Index Rollout::column_at(Index column, std::size_t start) const {
  const bool is_state = column >= std::ssize(problem_.parameters);
  return is_state ? column + static_cast<Index>(start) * std::ssize(problem_.initial_states) : column;
}

template <class S>
void Rollout::load_states(Machine<S>& machine, const VectorXd& x, std::size_t experiment, std::size_t start,
                          std::span<const Index> columns) {
  for (std::size_t state = 0; state < problem_.initial_states.size(); ++state) {
    *machine.real_state(problem_.initial_states[state].path) =
        seeded<S>(x[state_column(experiment, start, state)], state_column(experiment, 0, state), columns);
  }
}

template <class S>
bool Rollout::restarts(Machine<S>& machine, const VectorXd& x, std::size_t experiment, std::size_t step,
                       std::size_t& start, std::span<const Index> columns) {
  const std::vector<std::size_t>& steps = problem_.experiments[experiment].restarts;
  if (start == steps.size() || step != steps[start]) {
    return false;
  }
  load_states(machine, x, experiment, ++start, columns);
  return true;
}

template <class S>
void Rollout::set_parameters(Machine<S>& machine, const VectorXd& parameters, std::size_t experiment,
                             std::span<const Index> columns) {
  for (std::size_t j = 0; j < problem_.parameters.size(); ++j) {
    const FreeParameter& free = problem_.parameters[j];
    const auto column = static_cast<Index>(j);
    if (acts_in(free, experiment)) {
      machine.set_parameter(free.parameter, seeded<S>(parameters[column], column, columns), free.element);
    }
  }
}

template <class S>
void Rollout::prepare(Machine<S>& machine, const VectorXd& x, std::size_t experiment, std::span<const Index> columns) {
  set_parameters(machine, x, experiment, columns);
  machine.reset();
  load_states(machine, x, experiment, 0, columns);
}

template <class S>
void Rollout::drive(Machine<S>& machine, const Drive& drive, std::size_t step) {
  for (std::size_t i = 0; i < drive.inputs.size(); ++i) {
    if (step == 0 || drive.inputs[i].size() > 1) {
      machine.set_input(i, S(at_step(drive.inputs[i], step)));
    }
  }
}

template <class S>
bool Rollout::pass(Machine<S>& machine, const VectorXd& x, std::size_t experiment, std::span<const Index> columns,
                   VectorXd& residuals, MatrixXd* jacobian) {
  machine.use_directions(columns.size());
  prepare(machine, x, experiment, columns);
  const Experiment& record = problem_.experiments[experiment];
  std::vector<Index> targets(columns.begin(), columns.end());
  std::size_t step = 0;
  std::size_t start = 0;
  Index row = 0;
  for (const records::RowRange& range : record.train) {
    for (; step < range.last; ++step) {
      if (restarts(machine, x, experiment, step, start, columns)) {
        std::ranges::transform(columns, targets.begin(), [&](Index column) { return column_at(column, start); });
      }
      drive(machine, record.drive, step);
      machine.step();
      if (step < range.first) {
        continue;
      }
      for (std::size_t output = 0; output < problem_.outputs.size(); ++output) {
        const S y = machine.output(problem_.outputs[output]);
        const double value = plain_value(y);
        if (!std::isfinite(value)) {
          return false;
        }
        const Index at = first_row_[experiment][output] + row;
        const double scale = scales_[output];
        residuals[at] = (value - record.measured[output][step]) / scale;
        if constexpr (is_dual<S>) {
          for (std::size_t k = 0; k < columns.size(); ++k) {
            (*jacobian)(at, targets[k]) = y.derivative(static_cast<int>(k)) / scale;
          }
        }
      }
      ++row;
    }
  }
  return true;
}

bool Rollout::residuals(const VectorXd& x, VectorXd& residuals, MatrixXd* jacobian) {
  try {
    return all_residuals(x, residuals, jacobian);
  } catch (const cosimulation::FmuRefusal&) {  // a point at which a model cannot go on has no value
    return false;
  }
}

bool Rollout::all_residuals(const VectorXd& x, VectorXd& residuals, MatrixXd* jacobian) {
  if (jacobian != nullptr) {
    jacobian->setZero();
  }
  for (std::size_t e = 0; e < problem_.experiments.size(); ++e) {
    std::vector<Index> columns;
    for (std::size_t j = 0; jacobian != nullptr && j < problem_.parameters.size(); ++j) {
      if (acts_in(problem_.parameters[j], e)) {
        columns.push_back(static_cast<Index>(j));
      }
    }
    for (std::size_t state = 0; jacobian != nullptr && state < problem_.initial_states.size(); ++state) {
      columns.push_back(state_column(e, 0, state));
    }
    if (columns.empty()) {  // also where derivatives are asked for, and there is nothing to derive by
      if (!pass<double>(plain_, x, e, {}, residuals, nullptr)) {
        return false;
      }
      continue;
    }
    const std::span<const Index> all(columns);
    for (std::size_t begin = 0; begin < all.size();) {
      const std::size_t left = all.size() - begin;
      bool finite = false;
      if (left <= 4) {
        if (!four_) {
          four_.emplace(problem_.program, sample_time_of(problem_));
        }
        finite = pass<Dual<4>>(*four_, x, e, all.subspan(begin), residuals, jacobian);
      } else {
        if (!eight_) {
          eight_.emplace(problem_.program, sample_time_of(problem_));
        }
        finite = pass<Dual<8>>(*eight_, x, e, all.subspan(begin, std::min<std::size_t>(left, 8)), residuals, jacobian);
      }
      if (!finite) {
        return false;
      }
      begin += left <= 4 ? left : std::min<std::size_t>(left, 8);
    }
  }
  return true;
}

std::vector<Signal> Rollout::outputs(const VectorXd& x, std::size_t experiment) {
  prepare<double>(plain_, x, experiment, {});
  const Drive& inputs = problem_.experiments[experiment].drive;
  std::vector<Signal> result(problem_.outputs.size(), Signal(inputs.steps));
  std::size_t start = 0;
  for (std::size_t step = 0; step < inputs.steps; ++step) {
    (void)restarts<double>(plain_, x, experiment, step, start, {});
    drive(plain_, inputs, step);
    plain_.step();
    for (std::size_t i = 0; i < problem_.outputs.size(); ++i) {
      result[i][step] = plain_.output(problem_.outputs[i]);
    }
  }
  return result;
}

std::vector<double> Rollout::own_states(const VectorXd& parameters) {
  std::vector<double> values;
  const auto keep = [&] {
    for (const FreeState& state : problem_.initial_states) {
      values.push_back(*plain_.real_state(state.path));
    }
  };
  for (std::size_t e = 0; e < problem_.experiments.size(); ++e) {
    const Experiment& experiment = problem_.experiments[e];
    set_parameters<double>(plain_, parameters, e, {});
    plain_.reset();
    keep();
    std::size_t step = 0;
    for (const std::size_t restart : experiment.restarts) {
      for (; step < restart; ++step) {
        drive(plain_, experiment.drive, step);
        plain_.step();
      }
      keep();
    }
  }
  return values;
}

}  // namespace hysteron::detail
