// HY_DERIVATIVE4: XOUT(k) = (3·(XIN(k) − XIN(k−3)) + XIN(k−1) − XIN(k−2))/(10·TS)
#pragma once

#include "blocks/derivative.hpp"

namespace hysteron {

struct Derivative4 {
  static constexpr About about{
      .name = "HY_DERIVATIVE4",
      .title = "Derivative, four-point",
      .group = Group::Dynamics,
      .equation = "XOUT(k) = (3·(XIN(k) − XIN(k−3)) + XIN(k−1) − XIN(k−2))/(10·TS) where RUN; else 0",
      .meaning =
          "Rate of change as the standard's DERIVATIVE: the slope of the least-squares line through four samples. Of "
          "white noise it passes a variance 0.1 times that of HY_DERIVATIVE. The history begins with the first "
          "sample, so that a ramp gives 0, 0.3, 0.7 and from then on 1 times its slope; while RUN is FALSE "
          "it gives 0, and the last of those samples counts as the first.",
      .delay =
          "Delay 1.5 samples at every frequency; gain (3·sin(3w/2) + sin(w/2))/(5w) times the ideal ω at w = ωTS: "
          "0.69 at 1 rad/sample.",
      .source = "IEC 61131-3, DERIVATIVE"};

  template <class S>
  using Params = NoFields<S>;
  template <class S>
  struct State {
    S X1;
    S X2;
    S X3;
    Bool<S> STARTED;
    using Self = State;
    static constexpr auto fields() {
      return Fields{HY_FIELD(X1).in("'x").otherwise(0.0).means("signal one sample ago"),
                    HY_FIELD(X2).in("'x").otherwise(0.0).means("signal two samples ago"),
                    HY_FIELD(X3).in("'x").otherwise(0.0).means("signal three samples ago"),
                    HY_FIELD(STARTED).otherwise(0.0).means("a sample has been seen")};
    }
  };
  template <class S>
  using In = Derivative::In<S>;
  template <class S>
  using Out = Derivative::Out<S>;

  template <class S>
  static State<S> initial(const Params<S>& /*params*/) {
    return {.X1 = S(0.0), .X2 = S(0.0), .X3 = S(0.0), .STARTED = Bool<S>(false)};
  }
  template <class S>
  static Out<S> output(const Params<S>& /*params*/, const State<S>& state, const In<S>& in, const S& ts) {
    const S slope = (S(3.0) * (in.XIN - state.X3) + state.X1 - state.X2) / (S(10.0) * ts);
    return {.XOUT = select(in.RUN && state.STARTED, slope, S(0.0))};
  }
  template <class S>
  static void update(const Params<S>& /*params*/, State<S>& state, const In<S>& in, const Out<S>& /*out*/,
                     const S& /*ts*/) {
    const Bool<S> running = in.RUN && state.STARTED;
    state = {.X1 = in.XIN,
             .X2 = select(running, state.X1, in.XIN),
             .X3 = select(running, state.X2, in.XIN),
             .STARTED = Bool<S>(true)};
  }
};

}  // namespace hysteron
