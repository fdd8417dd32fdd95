// HY_THERMAL_DRIFT: XOUT = XIN + SIZE·(1 − exp(−t/T1))
#pragma once

#include "blocks/clock_time.hpp"
#include "blocks/effect_term.hpp"
#include "blocks/ports.hpp"

namespace hysteron {

struct ThermalDrift : OfClockTime {
  static constexpr About about{.name = "HY_THERMAL_DRIFT",
                               .title = "Thermal drift",
                               .group = Group::Dynamics,
                               .equation = "XOUT = XIN + SIZE·(1 − exp(−t/T1))",
                               .meaning =
                                   "Adds what a machine drifts as it warms up after the start: an exponential of the "
                                   "clock time t, also while nothing moves. t is 0 in the first step.",
                               .effect = "thermal_drift",
                               .family = Family::SlowChange};

  template <class S>
  struct Params {
    S SIZE;
    S T1;
    using Self = Params;
    static constexpr auto fields() {
      return Fields{HY_FIELD(SIZE).in("'x").otherwise(0.0).neutral_at(0.0).means("drift when warm"),
                    HY_FIELD(T1).in("s").above(0.0).otherwise(60.0).means("time constant of the warming")};
    }
  };
  template <class S>
  using In = Xin<S, "'x", "signal">;
  template <class S>
  using Out = Xout<S, "'x", "signal with the drift">;

  template <class S>
  static State<S> initial(const Params<S>& /*params*/) {
    return initial_count<S>();
  }
  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& state, const In<S>& in, const S& ts) {
    return {.XOUT = with_term<S>(in.XIN, params.SIZE * (S(1.0) - exp(-(clock_time(state, ts) / params.T1))))};
  }
};

}  // namespace hysteron
