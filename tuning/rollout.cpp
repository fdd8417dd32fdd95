// See rollout.hpp.
#include "tuning/rollout.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <type_traits>
#include <utility>

#include "codegen/cosimulation/session.hpp"
#include "tuning/dual_value.hpp"
#include "tuning/rollout_unknowns.hpp"

namespace hysteron::detail {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

double sample_time_of(const OutputErrorProblem& problem) {
  return problem.experiments.empty() ? 0.0 : problem.experiments.front().drive.sample_time;
}

/// The unknowns of one point.
template <class S>
auto unknowns_at(const VectorXd& x, std::span<const Index> columns) {
  return [&x, columns](Index column, Index seed) { return seeded<S>(x[column], seed, columns); };
}

}  // namespace

Rollout::Rollout(const OutputErrorProblem& problem)
    : problem_(problem),
      scales_(problem.outputs.size(), 1.0),
      first_row_(problem.experiments.size(), std::vector<Index>(problem.outputs.size())),
      whole_(problem.program, sample_time_of(problem)),
      reach_(problem),
      last_x_(problem.experiments.size()) {
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
  std::vector<Index> all(static_cast<std::size_t>(unknowns()));
  std::iota(all.begin(), all.end(), Index{0});
  if (std::vector<bool> still = reach_.unreached(all); std::ranges::count(still, true) > 0) {
    unreached_ =
        std::make_unique<Kept>(problem.program, sample_time_of(problem), std::move(still), problem.experiments.size());
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
bool Rollout::pass(Machine<S>& machine, const VectorXd& x, std::size_t experiment, std::span<const Index> columns,
                   const Replay& replay, VectorXd& residuals, MatrixXd* jacobian) {
  machine.use_directions(columns.size());
  const auto of = unknowns_at<S>(x, columns);
  prepare(machine, experiment, of);
  const Experiment& record = problem_.experiments[experiment];
  std::vector<Index> targets(columns.begin(), columns.end());
  std::size_t step = 0;
  std::size_t start = 0;
  Index row = 0;
  const std::vector<double>* const played =
      replay.played != nullptr ? &replay.played->records[experiment].values : nullptr;
  const std::size_t given = replay.played != nullptr ? replay.played->rest.given.size() : 0;
  std::vector<double> values;
  for (const records::RowRange& range : record.train) {
    for (; step < range.last; ++step) {
      if (restarts(machine, experiment, step, start, of)) {
        std::ranges::transform(columns, targets.begin(), [&](Index column) { return column_at(column, start); });
      }
      set_inputs(machine, record.drive, step);
      for (std::size_t i = 0; i < given; ++i) {
        machine.set_input(replay.played->rest.first_input + i, (*played)[step * given + i]);
      }
      machine.step();
      if (replay.kept != nullptr) {
        for (const Wire& wire : replay.kept->rest.given) {
          values.push_back(value_of(machine.value(wire)));
        }
      }
      if (step < range.first) {
        continue;
      }
      for (std::size_t output = 0; output < problem_.outputs.size(); ++output) {
        const S y = machine.output(problem_.outputs[output]);
        const double value = value_of(y);
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
  if (replay.kept != nullptr) {
    replay.kept->records[experiment] = {.filled = true, .x = x, .values = std::move(values)};
  }
  return true;
}

bool Rollout::residuals(const VectorXd& x, VectorXd& residuals, MatrixXd* jacobian) {
  if (Foreseen* const found = jacobian == nullptr ? among_foreseen(x) : nullptr) {
    const bool has_value = found->residuals.has_value();
    if (has_value) {
      residuals = *found->residuals;
    }
    found->asked = true;
    keep_some();
    return has_value;
  }
  try {
    return all_residuals(x, residuals, jacobian);
  } catch (const cosimulation::FmuRefusal&) {  // a point at which a model cannot go on has no value
    return false;
  }
}

bool Rollout::all_residuals(const VectorXd& x, VectorXd& residuals, MatrixXd* jacobian) {
  if (jacobian != nullptr) {
    jacobian->setZero();
    is_grid_ = false;
    of_grid_.reset();
  }
  for (std::size_t e = 0; e < problem_.experiments.size(); ++e) {
    std::vector<Index> columns;
    if (jacobian != nullptr) {  // a state's column at start 0 stands for those at the restarts, too
      columns = columns_of(e);
      std::erase_if(columns, [&](Index column) { return column >= state_column(e, 1, 0); });
    }
    // Plain also where derivatives are asked for, and there is nothing to derive by.
    if (columns.empty() ? !plain_pass(x, e, residuals) : !derivative_passes(x, e, columns, residuals, *jacobian)) {
      return false;
    }
  }
  return true;
}

bool Rollout::plain_pass(const VectorXd& x, std::size_t experiment, VectorXd& residuals) {
  const Replay replay = is_grid_ ? of_grid(x, experiment) : of_unreached(experiment);
  Machine<double>& machine = replay.played != nullptr ? replay.played->machines.plain : whole_.plain;
  return pass<double>(machine, x, experiment, {}, replay, residuals, nullptr);
}

bool Rollout::keeping_pass(const VectorXd& x, std::size_t experiment, Kept& kept, VectorXd& residuals) {
  return pass<double>(whole_.plain, x, experiment, {}, {.kept = &kept}, residuals, nullptr);
}

std::vector<Index> Rollout::columns_of(std::size_t experiment) const {
  std::vector<Index> columns;
  for (std::size_t j = 0; j < problem_.parameters.size(); ++j) {
    if (acts_in(problem_.parameters[j], experiment)) {
      columns.push_back(static_cast<Index>(j));
    }
  }
  for (Index column = first_state_[experiment]; column < first_state_[experiment + 1]; ++column) {
    columns.push_back(column);
  }
  return columns;
}

Rollout::Replay Rollout::of_unreached(std::size_t experiment) {
  if (unreached_ == nullptr) {
    return {};
  }
  return unreached_->records[experiment].filled ? Replay{.played = unreached_.get()} : Replay{.kept = unreached_.get()};
}

bool Rollout::holds(const Kept& kept, const VectorXd& x, std::size_t experiment) const {
  const Kept::OfRecord& record = kept.records[experiment];
  return record.filled && std::ranges::all_of(columns_of(experiment), [&](Index column) {
           return x[column] == record.x[column] || reach_.leaves(column, kept.still);
         });
}

void Rollout::make_ready(std::unique_ptr<Kept>& kept, std::vector<bool> still, std::size_t experiment) const {
  if (kept == nullptr || kept->still != still) {
    kept = std::make_unique<Kept>(problem_.program, sample_time_of(problem_), std::move(still),
                                  problem_.experiments.size());
  }
  kept->records[experiment].filled = false;
}

Rollout::Replay Rollout::of_grid(const VectorXd& x, std::size_t experiment) {
  const Replay before = of_unreached(experiment);
  const VectorXd last = std::exchange(last_x_[experiment], x);
  if (last.size() == 0 || before.kept != nullptr) {
    return before;
  }
  const bool held = of_grid_ != nullptr && holds(*of_grid_, x, experiment);
  std::vector<Index> changed = columns_of(experiment);
  std::erase_if(changed, [&](Index column) { return x[column] == last[column]; });
  std::vector<bool> still = reach_.unreached(changed);
  const auto count = [](const std::vector<bool>& nodes) { return std::ranges::count(nodes, true); };
  const auto played = held ? count(of_grid_->still) : before.played != nullptr ? count(before.played->still) : 0;
  if (changed.empty() || count(still) <= played) {
    return held ? Replay{.played = of_grid_.get()} : before;
  }
  make_ready(of_grid_, std::move(still), experiment);
  return {.kept = of_grid_.get()};
}

bool Rollout::derivative_passes(const VectorXd& x, std::size_t experiment, std::span<const Index> columns,
                                VectorXd& residuals, MatrixXd& jacobian) {
  for (std::span<const Index> left = columns; !left.empty();) {
    const auto part = left.first(width_of_pass(left.size()));
    const Replay replay = of_unreached(experiment);
    Machines& machines = replay.played != nullptr ? unreached_->machines : whole_;
    const bool finite = machines.with_derivatives(
        part.size(), [&](auto& machine) { return pass(machine, x, experiment, part, replay, residuals, &jacobian); });
    if (!finite) {
      return false;
    }
    left = left.subspan(part.size());
  }
  return true;
}

std::vector<Signal> Rollout::outputs(const VectorXd& x, std::size_t experiment) {
  const auto of = unknowns_at<double>(x, {});
  prepare(whole_.plain, experiment, of);
  const Drive& inputs = problem_.experiments[experiment].drive;
  std::vector<Signal> result(problem_.outputs.size(), Signal(inputs.steps));
  std::size_t start = 0;
  for (std::size_t step = 0; step < inputs.steps; ++step) {
    (void)restarts(whole_.plain, experiment, step, start, of);
    set_inputs(whole_.plain, inputs, step);
    whole_.plain.step();
    for (std::size_t i = 0; i < problem_.outputs.size(); ++i) {
      result[i][step] = whole_.plain.output(problem_.outputs[i]);
    }
  }
  return result;
}

std::vector<double> Rollout::own_states(const VectorXd& parameters) {
  std::vector<double> values;
  const auto keep = [&] {
    for (const FreeState& state : problem_.initial_states) {
      values.push_back(*whole_.plain.real_state(state.path));
    }
  };
  for (std::size_t e = 0; e < problem_.experiments.size(); ++e) {
    const Experiment& experiment = problem_.experiments[e];
    set_parameters(whole_.plain, e, unknowns_at<double>(parameters, {}));
    whole_.plain.reset();
    keep();
    std::size_t step = 0;
    for (const std::size_t restart : experiment.restarts) {
      for (; step < restart; ++step) {
        set_inputs(whole_.plain, experiment.drive, step);
        whole_.plain.step();
      }
      keep();
    }
  }
  return values;
}

}  // namespace hysteron::detail
