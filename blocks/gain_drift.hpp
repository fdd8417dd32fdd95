// HY_GAIN_DRIFT: XOUT = XIN·(1 + RATE·(1 − exp(−SETTLING·t))/SETTLING)
#pragma once

#include "blocks/clock_time.hpp"
#include "blocks/effect_term.hpp"
#include "blocks/filtered_rate.hpp"
#include "blocks/ports.hpp"

namespace hysteron {

struct GainDrift : OfClockTime {
  static constexpr About about{.name = "HY_GAIN_DRIFT",
                               .title = "Drift of the gain",
                               .group = Group::Dynamics,
                               .equation =
                                   "XOUT = XIN·(1 + RATE·(1 − exp(−SETTLING·t))/SETTLING), XIN·(1 + RATE·t) where "
                                   "SETTLING is 0",
                               .meaning =
                                   "A gain that changes with the clock time t, evenly or, as an amplifier does that "
                                   "warms up, less and less: 1 in the first step, where t is 0. At XIN = 0 nothing "
                                   "drifts, which tells it from HY_DRIFT.",
                               .effect = "gain_drift",
                               .family = Family::SlowChange};

  template <class S>
  struct Params {
    S RATE;
    S SETTLING;
    using Self = Params;
    static constexpr auto fields() {
      return Fields{
          HY_FIELD(RATE).in("1/s").otherwise(0.0).neutral_at(0.0).means("change of the gain per second, at first"),
          HY_FIELD(SETTLING).in("1/s").at_least(0.0).otherwise(0.0).means("one over the time in which it settles")};
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
    return {.XOUT = with_term<S>(in.XIN, in.XIN * (params.RATE * time_of_drift(params, clock_time(state, ts))))};
  }

 private:
  /// (1 − exp(−s·t))/s, by its series where the difference would cancel.
  template <class S>
  static S time_of_drift(const Params<S>& params, const S& time) {
    const S z = params.SETTLING * time;
    const Bool<S> slow = z < S(small_decay);
    return select(slow, time * decayed_share(z), (S(1.0) - exp(-z)) / select(slow, S(1.0), params.SETTLING));
  }
};

}  // namespace hysteron
