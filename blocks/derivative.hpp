// HY_DERIVATIVE: XOUT(k) = (XIN(k) − XIN(k−1))/TS
#pragma once

#include "blocks/description.hpp"

namespace hysteron {

struct Derivative {
  static constexpr About about{
      .name = "HY_DERIVATIVE",
      .title = "Derivative, two-point",
      .group = Group::Dynamics,
      .equation = "XOUT(k) = (XIN(k) − XIN(k−1))/TS where RUN; else 0",
      .meaning =
          "Rate of change from the last two samples: the least delay, and all of the noise. In the first sample "
          "there is no history and XOUT is 0. RUN FALSE gives 0 and keeps the history up to date.",
      .delay =
          "Delay 0.5 samples at every frequency; gain sin(w/2)/(w/2) times the ideal ω at w = ωTS: 0.96 at 1 "
          "rad/sample.",
      .source = "backward difference; pins of IEC 61131-3 DERIVATIVE"};

  template <class S>
  using Params = NoFields<S>;
  template <class S>
  struct State {
    S X1;
    Bool<S> STARTED;
    using Self = State;
    static constexpr auto fields() {
      return Fields{HY_FIELD(X1).in("'x").otherwise(0.0).means("signal one sample ago"),
                    HY_FIELD(STARTED).otherwise(0.0).means("a sample has been seen")};
    }
  };
  template <class S>
  struct In {
    S XIN;
    Bool<S> RUN;
    using Self = In;
    static constexpr auto fields() {
      return Fields{HY_FIELD(XIN).in("'x").means("signal"),
                    HY_FIELD(RUN).otherwise(1.0).means("FALSE resets the output to 0")};
    }
  };
  template <class S>
  struct Out {
    S XOUT;
    using Self = Out;
    static constexpr auto fields() { return Fields{HY_FIELD(XOUT).in("'x/s").means("rate of change of the signal")}; }
  };

  template <class S>
  static State<S> initial(const Params<S>& /*params*/) {
    return {.X1 = S(0.0), .STARTED = Bool<S>(false)};
  }
  template <class S>
  static Out<S> output(const Params<S>& /*params*/, const State<S>& state, const In<S>& in, const S& ts) {
    return {.XOUT = select(in.RUN && state.STARTED, (in.XIN - state.X1) / ts, S(0.0))};
  }
  template <class S>
  static void update(const Params<S>& /*params*/, State<S>& state, const In<S>& in, const Out<S>& /*out*/,
                     const S& /*ts*/) {
    state = {.X1 = in.XIN, .STARTED = Bool<S>(true)};
  }
};

}  // namespace hysteron
