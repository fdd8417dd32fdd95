// The diagram of feedforward.st as a step that an engineer would write by hand, with the same bits: what the generated
// step is measured against.
#pragma once

#include <cmath>

namespace hand_written {

struct Params {
  double c1 = 0.05;
  double c2 = 0.0013;
  double c3 = 0.7;
};

/// A running sum and what rounding took from it.
struct Sum {
  double value = 0.0;
  double lost = 0.0;

  void add(double term) {
    const double due = term + lost;
    const double next = value + due;
    lost = std::fabs(value) >= std::fabs(due) ? (value - next) + due : (due - next) + value;
    value = next;
  }
};

struct State {
  bool started = false;
  int heading = 0;
  double previous = 0.0;
  double extreme = 0.0;
  Sum momentum;
  Sum control;
};

/// Follows the reference; true where it has turned.
inline bool turned(State& state, double reference) {
  if (!state.started) {
    state.extreme = reference;
  }
  const double ahead = reference - state.extreme;
  if (state.heading > 0) {
    if (ahead < 0.0) {
      state.heading = -1;
      state.extreme = reference;
      return true;
    }
    state.extreme = reference;
  } else if (state.heading < 0) {
    if (ahead > 0.0) {
      state.heading = 1;
      state.extreme = reference;
      return true;
    }
    state.extreme = reference;
  } else if (ahead != 0.0) {
    state.heading = ahead > 0.0 ? 1 : -1;
    state.extreme = reference;
  }
  return false;
}

/// Control signal for one sample of the reference; `with_pow` is that of feedforward.st, else
/// feedforward_without_pow.st.
template <bool with_pow = true>
inline double step(const Params& params, State& state, double reference, bool reset) noexcept {
  constexpr double ts = 50e-6;
  const double rate = state.started ? (reference - state.previous) / ts : 0.0;
  const bool branching_point = turned(state, reference);
  state.previous = reference;
  state.started = true;

  const double p = branching_point ? 0.0 : state.momentum.value;
  const double slope = params.c1 + params.c2 * (with_pow ? std::pow(p, params.c3) : p);  // (17)
  const double control_rate = slope > 0.0 ? rate / slope : 0.0;                          // (15)
  if (branching_point || reset) {
    state.momentum = {};
  }
  state.momentum.add(std::fabs(control_rate) * ts);  // (16)
  if (reset) {
    state.control = {};
  } else {
    state.control.add(control_rate * ts);
  }
  return state.control.value;
}

}  // namespace hand_written
