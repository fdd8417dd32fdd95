#include "diagnosis/search/stretches.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "diagnosis/search/start_states.hpp"

namespace hysteron::diagnosis {
namespace {

/// So many stretches all records together have, of so many samples at least each.
constexpr std::size_t stretches_wanted = 16;
constexpr std::size_t shortest = 100;
/// Of the largest change that a state's start makes, so much is left at the end of the record: it is kept.
constexpr double kept = 0.5;
/// The part of a state's trace, in energy, that is not a sum of those of the states taken before it.
constexpr double own_part = 0.05;
constexpr std::ptrdiff_t most_free = 4;

std::vector<std::vector<std::size_t>> restarts_of(const Task& task) {
  std::size_t total = 0;
  for (const records::Record& record : task.records) {
    total += record.size();
  }
  const std::size_t length = std::max(shortest, total / stretches_wanted);
  std::vector<std::vector<std::size_t>> restarts;
  for (const records::Record& record : task.records) {
    const std::size_t count = record.size() / length;
    restarts.emplace_back();
    for (std::size_t k = 1; k < count; ++k) {
      restarts.back().push_back(k * record.size() / count);
    }
  }
  return restarts;
}

/// Whether what one of the states had at the start of the first record is still there at its end, in any output.
bool keeps_its_start(const Task& task, const Model& model, const MatrixXd& jacobian, Index first, Index states) {
  const auto size = static_cast<Index>(task.records.front().size());
  const Index last = std::max<Index>(size / 10, 1);
  for (Index state = 0; state < states; ++state) {
    for (Index output = 0, row = 0; output < std::ssize(task.outputs); ++output) {
      const VectorXd trace = jacobian.col(first + state).segment(row, size).cwiseAbs();
      if (trace.maxCoeff() > 0.0 && trace.tail(last).mean() > kept * trace.maxCoeff()) {
        return true;
      }
      row += model.rows() / std::ssize(task.outputs);
    }
  }
  return false;
}

/// The states that show most, by what a start as large as the state usually is would change, and whose traces on the
/// stretches are not sums of each other's: what a delay hands on to an integral is a part of the integral's own.
std::vector<std::string> states_that_show(const Task& cut, const Model& model, const MatrixXd& jacobian) {
  const Index first = std::ssize(model.problem().parameters);
  const auto states = std::ssize(cut.initial_states);
  const auto starts = (model.unknowns() - first) / states;
  MatrixXd traces(model.rows(), states);
  for (Index state = 0; state < states; ++state) {
    const Eigen::Map<const VectorXd, 0, Eigen::InnerStride<>> values(model.start().data() + first + state, starts,
                                                                     Eigen::InnerStride<>(states));
    traces.col(state) = trace_of(jacobian, first, states, state) * values.norm();
  }
  std::vector<std::string> result;
  MatrixXd rest = traces;
  while (std::ssize(result) < most_free) {
    Index most = 0;
    const double energy = rest.colwise().squaredNorm().maxCoeff(&most);
    if (!(energy > own_part * traces.col(most).squaredNorm())) {
      break;
    }
    result.push_back(cut.initial_states[static_cast<std::size_t>(most)]);
    const VectorXd direction = rest.col(most) / std::sqrt(energy);
    rest -= direction * (direction.transpose() * rest);
  }
  return result;
}

}  // namespace

std::optional<Task> in_stretches(const Task& task, const Explanation& calibrated) {
  auto stretches = std::make_shared<Shooting>(Shooting{.restarts = restarts_of(task)});
  const Program& program = *calibrated.variant.program;
  Task cut = task;
  free_too(cut, dynamic_states(program.graph));
  if (std::ranges::all_of(stretches->restarts, [](const auto& one) { return one.empty(); }) ||
      cut.initial_states.empty()) {
    return std::nullopt;
  }
  VectorXd residuals;
  MatrixXd jacobian;
  Model whole(cut, program, calibrated.variant.further);
  if (!whole.residuals(start_from(whole, calibrated), residuals, &jacobian) ||
      !keeps_its_start(cut, whole, jacobian, std::ssize(whole.problem().parameters), std::ssize(cut.initial_states))) {
    return std::nullopt;
  }
  cut.shooting = stretches;
  Model model(cut, program, calibrated.variant.further);
  if (!model.residuals(start_from(model, calibrated), residuals, &jacobian)) {
    return std::nullopt;
  }
  cut.initial_states = states_that_show(cut, model, jacobian);
  const Model shown(cut, program, calibrated.variant.further);
  const VectorXd states = shown.start().tail(shown.unknowns() - std::ssize(shown.problem().parameters));
  stretches->states.assign(states.begin(), states.end());
  return cut;
}

Explanation over_whole_records(const Task& task, const Explanation& on_stretches) {
  Explanation whole{.variant = on_stretches.variant};
  Model model(task, *whole.variant.program, whole.variant.further);
  whole.fit.x = start_from(model, on_stretches);
  finish(task, whole, {.thoroughly = true});
  return whole;
}

}  // namespace hysteron::diagnosis
