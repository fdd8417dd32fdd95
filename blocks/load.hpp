// HY_LOAD: XOUT = XIN − SIZE from T_ON to T_OFF
#pragma once

#include "blocks/clock_time.hpp"
#include "blocks/effect_term.hpp"
#include "blocks/ports.hpp"

namespace hysteron {

struct Load : OfClockTime {
  static constexpr About about{
      .name = "HY_LOAD",
      .title = "Load for a time",
      .group = Group::Dynamics,
      .equation = "XOUT = XIN − SIZE for T_ON < t ≤ T_OFF, else XIN; t the clock time",
      .meaning =
          "A load that is put on at T_ON and taken off at T_OFF: a force on an actuator, a torque on a drive, a level "
          "on a signal. A sample counts the part of the interval before it in which the load was on, so that the "
          "result has a derivative by both times. t is 0 in the first step. T_OFF before T_ON is no load at all.",
      .effect = "load",
      .family = Family::SlowChange};

  template <class S>
  struct Params {
    S SIZE;
    S T_ON;
    S T_OFF;
    using Self = Params;
    static constexpr auto fields() {
      return Fields{HY_FIELD(SIZE).in("'x").otherwise(0.0).neutral_at(0.0).means("what the load takes off"),
                    HY_FIELD(T_ON)
                        .role(FieldRole::Instant)
                        .in("s")
                        .at_least(0.0)
                        .otherwise(0.0)
                        .means("clock time at which it is put on"),
                    HY_FIELD(T_OFF)
                        .role(FieldRole::Instant)
                        .in("s")
                        .at_least(0.0)
                        .otherwise(std::numeric_limits<double>::infinity())
                        .means("clock time at which it is taken off")};
    }
  };
  template <class S>
  using In = Xin<S, "'x", "signal">;
  template <class S>
  using Out = Xout<S, "'x", "signal without the load">;

  template <class S>
  static State<S> initial(const Params<S>& /*params*/) {
    return initial_count<S>();
  }
  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& state, const In<S>& in, const S& ts) {
    const S time = clock_time(state, ts);
    const S on = max(passed_part(time, params.T_ON, ts) - passed_part(time, params.T_OFF, ts), S(0.0));
    return {.XOUT = with_term<S>(in.XIN, -(params.SIZE * on))};
  }
};

}  // namespace hysteron
