// HY_INTEGRAL_FORWARD: XOUT(k+1) = XOUT(k) + TS·XIN(k), with a compensated sum and no feedthrough
#pragma once

#include "blocks/integral.hpp"

namespace hysteron {

struct IntegralForward {
  static constexpr About about{
      .name = "HY_INTEGRAL_FORWARD",
      .title = "Integral without feedthrough",
      .group = Group::Dynamics,
      .equation = "XOUT(k) = X0 where R1; XOUT(k+1) = XOUT(k) + TS·XIN(k) where RUN; else XOUT(k)",
      .meaning =
          "Integral by the forward Euler rule: the output is the integral up to the start of the present sampling "
          "interval, so that it does not depend on the present input and may close a loop. The state of a plant is "
          "such an integral. Compensated as HY_INTEGRAL is. RUN FALSE holds the value; R1 dominates and loads X0, "
          "from which the same interval already integrates. Starts at 0.",
      .delay = "Ideal integral times (ωTS/2)/sin(ωTS/2), behind by half a sample.",
      .source = "W. Kahan, CACM 8 (1965) 40"};

  template <class S>
  using Params = NoFields<S>;
  template <class S>
  using State = Integral::State<S>;
  template <class S>
  using In = Integral::In<S>;
  template <class S>
  using Out = Integral::Out<S>;

  /// The sum at the start of the interval.
  template <class S>
  static CompensatedSum<S> present(const State<S>& state, const In<S>& in) {
    return select_sum<S>(in.R1, {.high = in.X0, .low = S(0.0)}, state.sum());
  }

  template <class S>
  static State<S> initial(const Params<S>& /*params*/) {
    return {.SUM = S(0.0), .LOST = S(0.0)};
  }
  template <class S>
  static Out<S> output(const Params<S>& /*params*/, const State<S>& state, const In<S>& in, const S& /*ts*/) {
    const CompensatedSum<S> sum = present(state, in);
    return {.XOUT = sum.high, .Q = !in.R1};
  }
  template <class S>
  static void update(const Params<S>& /*params*/, State<S>& state, const In<S>& in, const Out<S>& /*out*/,
                     const S& ts) {
    const CompensatedSum<S> next = add<S>(present(state, in), select(in.RUN, in.XIN * ts, S(0.0)));
    state = State<S>::of(next);
  }
};

}  // namespace hysteron
