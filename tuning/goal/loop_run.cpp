#include "tuning/goal/loop_run.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "codegen/cosimulation/session.hpp"
#include "tuning/dual_value.hpp"

namespace hysteron {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Of the largest |v|: small against any curvature, large against rounding.
constexpr double share_put_in = 1e-6;
/// Of the peak in the third quarter: what has become less than this share of it in the last is dying away.
constexpr double dying_away = 0.999;

/// What is to be said of a response that has not died away over the time that it was given.
LoopState without_end(const Signal& impulse) {
  const auto quarter = std::ssize(impulse) / 4;
  const auto peak = [](auto begin, auto end) {
    return std::accumulate(begin, end, 0.0, [](double most, double h) { return std::max(most, std::fabs(h)); });
  };
  const double before = peak(impulse.end() - 2 * quarter, impulse.end() - quarter);
  return peak(impulse.end() - quarter, impulse.end()) < dying_away * before ? LoopState::TooSlow : LoopState::Unstable;
}

template <class Row>
void keep_derivatives(const double& /*value*/, std::span<const Index> /*columns*/, double /*scale*/, Row&& /*row*/) {}
template <int N, int W, class Row>
void keep_derivatives(const Dual<N, W>& value, std::span<const Index> columns, double scale, Row&& row) {
  for (std::size_t k = 0; k < columns.size(); ++k) {
    row[columns[k]] = scale * value.derivative(static_cast<int>(k));
  }
}

}  // namespace

LoopRun::LoopRun(const LoopPlant& plant, const Drive& drive, const std::vector<FreeParameter>& parameters)
    : plant_(plant), drive_(drive), parameters_(parameters), machines_(plant.program, drive.sample_time) {}

template <class S>
bool LoopRun::take_test(Machine<S>& machine, const VectorXd& x, std::span<const Index> columns,
                        LoopResponse& response) {
  machine.use_directions(columns.size());
  for (std::size_t j = 0; j < parameters_.size(); ++j) {
    const auto column = static_cast<Index>(j);
    machine.set_parameter(parameters_[j].parameter, seeded<S>(x[column], column, columns), parameters_[j].element);
  }
  machine.reset();
  if (plant_.cut) {
    machine.set_input(plant_.cut->input, 0.0);
  }
  largest_ = 0.0;
  for (std::size_t step = 0; step < drive_.steps; ++step) {
    set_inputs(machine, drive_, step);
    machine.step();
    const S y = machine.value(plant_.output);
    const S u = plant_.effort ? machine.value(*plant_.effort) : S(0.0);
    const double v = plant_.cut ? value_of(machine.value(plant_.cut->behind)) : 0.0;
    response.output[step] = value_of(y);
    response.effort[step] = value_of(u);
    largest_ = std::max(largest_, std::fabs(v));
    if (!std::isfinite(response.output[step]) || !std::isfinite(response.effort[step]) || !std::isfinite(v)) {
      return false;
    }
    if (!columns.empty()) {
      keep_derivatives(y, columns, 1.0, response.output_by.row(static_cast<Index>(step)));
      keep_derivatives(u, columns, 1.0, response.effort_by.row(static_cast<Index>(step)));
    }
  }
  return true;
}

template <class S>
LoopState LoopRun::take_impulse(Machine<S>& machine, std::span<const Index> columns, std::size_t steps,
                                LoopResponse& response) {
  constexpr std::size_t block = 256;
  const double put_in = share_put_in * (largest_ > 0.0 ? largest_ : 1.0);
  const std::size_t most = steps > 0 ? steps : steps_watched(drive_);
  std::array<std::vector<std::byte>, 2> states;  // of the run with +ε, of that with −ε
  for (std::vector<std::byte>& state : states) {
    state.resize(machine.saved_size());
    machine.save(state);
  }
  std::vector<S> above;
  double peak = 0.0;
  for (std::size_t first = 0; first < most; first += block) {
    const std::size_t last = std::min(first + block, most);
    above.resize(last - first);
    for (std::size_t run = 0; run < 2; ++run) {
      machine.restore(states[run]);
      for (std::size_t step = first; step < last; ++step) {
        machine.set_input(plant_.cut->input, step > 0 ? 0.0 : run == 0 ? put_in : -put_in);
        machine.step();
        const S v = machine.value(plant_.cut->behind);
        if (run == 0) {
          above[step - first] = v;
          continue;
        }
        const S difference = above[step - first] - v;
        const double h = value_of(difference) / (2.0 * put_in);
        if (columns.empty()) {
          response.impulse.push_back(h);
        } else {
          keep_derivatives(difference, columns, 0.5 / put_in, response.impulse_by.row(static_cast<Index>(step)));
        }
        peak = std::max(peak, std::fabs(h));
      }
      machine.save(states[run]);
    }
    if (!std::isfinite(peak) || peak > 1e9) {
      return LoopState::Unstable;
    }
    const auto tail = static_cast<std::ptrdiff_t>(last / 4);
    const bool is_small = std::all_of(response.impulse.end() - tail, response.impulse.end(),
                                      [&](double h) { return std::fabs(h) < died_away * peak; });
    if (steps == 0 && is_small) {
      return LoopState::Settles;
    }
  }
  return steps > 0 ? LoopState::Settles : without_end(response.impulse);
}

LoopState LoopRun::respond(const VectorXd& x, bool with_derivatives, LoopResponse& response) {
  response = {.output = Signal(drive_.steps), .effort = Signal(drive_.steps)};
  try {
    if (!take_test(machines_.plain, x, {}, response)) {
      return LoopState::NotFinite;
    }
    if (plant_.cut) {
      if (const LoopState ended = take_impulse(machines_.plain, {}, 0, response); ended != LoopState::Settles) {
        return ended;
      }
    }
    if (!with_derivatives) {
      return LoopState::Settles;
    }
    const auto rows = static_cast<Index>(drive_.steps);
    response.output_by = Eigen::MatrixXd::Zero(rows, x.size());
    response.effort_by = Eigen::MatrixXd::Zero(rows, x.size());
    response.impulse_by = Eigen::MatrixXd::Zero(std::ssize(response.impulse), x.size());
    std::vector<Index> columns(parameters_.size());
    std::iota(columns.begin(), columns.end(), Index{0});
    for (std::span<const Index> left(columns); !left.empty();) {
      const auto part = left.first(width_of_pass(left.size()));
      const bool finite = machines_.with_derivatives(part.size(), [&](auto& machine) {
        return take_test(machine, x, part, response) &&
               (!plant_.cut || take_impulse(machine, part, response.impulse.size(), response) == LoopState::Settles);
      });
      if (!finite) {
        return LoopState::NotFinite;
      }
      left = left.subspan(part.size());
    }
  } catch (const cosimulation::FmuRefusal&) {  // a point at which a model cannot go on has no value
    return LoopState::NotFinite;
  }
  return LoopState::Settles;
}

}  // namespace hysteron
