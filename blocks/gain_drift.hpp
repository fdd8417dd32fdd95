// HY_GAIN_DRIFT: XOUT = XIN·(1 + RATE·t)
#pragma once

#include "blocks/clock_time.hpp"
#include "blocks/effect_term.hpp"
#include "blocks/ports.hpp"

namespace hysteron {

struct GainDrift : OfClockTime {
  static constexpr About about{.name = "HY_GAIN_DRIFT",
                               .title = "Drift of the gain",
                               .group = Group::Dynamics,
                               .equation = "XOUT = XIN·(1 + RATE·t)",
                               .meaning =
                                   "A gain that changes evenly with the clock time t: 1 in the first step, where t is "
                                   "0. At XIN = 0 nothing drifts, which tells it from HY_DRIFT.",
                               .effect = "gain_drift"};

  template <class S>
  struct Params {
    S RATE;
    using Self = Params;
    static constexpr auto fields() {
      return std::tuple{HY_FIELD(RATE).in("1/s").otherwise(0.0).neutral_at(0.0).means("change of the gain per second")};
    }
  };
  template <class S>
  using In = Xin<S, "'x", "signal">;
  template <class S>
  using Out = Xout<S, "'x", "signal times the gain">;

  template <class S>
  static State<S> initial(const Params<S>& /*params*/) {
    return initial_count<S>();
  }
  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& state, const In<S>& in, const S& ts) {
    return {.XOUT = with_term<S>(in.XIN, in.XIN * (params.RATE * clock_time(state, ts)))};
  }
};

}  // namespace hysteron
