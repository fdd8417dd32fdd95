// HY_DRIFT: XOUT = XIN + RATE·t
#pragma once

#include "blocks/clock_time.hpp"
#include "blocks/effect_term.hpp"
#include "blocks/ports.hpp"

namespace hysteron {

struct Drift : OfClockTime {
  static constexpr About about{.name = "HY_DRIFT",
                               .title = "Drift",
                               .group = Group::Dynamics,
                               .equation = "XOUT = XIN + RATE·t",
                               .meaning =
                                   "Adds what grows evenly with the clock time t, also while nothing moves: the drift "
                                   "of an amplifier or of a zero. t is 0 in the first step and is counted in steps, so "
                                   "that no rounding adds up; it stands still after 2^31 − 1 steps.",
                               .effect = "drift",
                               .family = Family::SlowChange};

  template <class S>
  struct Params {
    S RATE;
    using Self = Params;
    static constexpr auto fields() {
      return Fields{HY_FIELD(RATE).in("'x/s").otherwise(0.0).neutral_at(0.0).means("drift per second")};
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
    return {.XOUT = with_term<S>(in.XIN, params.RATE * clock_time(state, ts))};
  }
};

}  // namespace hysteron
