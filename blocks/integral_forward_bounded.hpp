// HY_INTEGRAL_FORWARD_BOUNDED: HY_INTEGRAL_FORWARD that stops at its bounds, without feedthrough
#pragma once

#include "blocks/integral_bounded.hpp"
#include "blocks/integral_forward.hpp"

namespace hysteron {

struct IntegralForwardBounded : OfBoundedIntegral {
  static constexpr About about{
      .name = "HY_INTEGRAL_FORWARD_BOUNDED",
      .title = "Integral between bounds, without feedthrough",
      .group = Group::Dynamics,
      .equation = "XOUT(k+1) = min(max(XOUT(k) + TS·XIN(k), MN), MX) where RUN, X0 in place of XOUT(k) where R1",
      .meaning =
          "HY_INTEGRAL_FORWARD, to the bit, where no bound is set, and between bounds as HY_INTEGRAL_BOUNDED: the "
          "state "
          "of a plant that has end stops, a tank with a brim. A bound counts from the first step on, and for X0 too.",
      .delay = "That of HY_INTEGRAL_FORWARD.",
      .source = "IEC 61131-3, INTEGRAL and LIMIT",
      .enriches = "HY_INTEGRAL_FORWARD"};

  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& state, const In<S>& in, const S& /*ts*/) {
    return shown(params, IntegralForward::present(state, in), in);
  }
  /// The sum is kept as it came, and held at the start of the next interval, where the bounds of that step count.
  template <class S>
  static void update(const Params<S>& params, State<S>& state, const In<S>& in, const Out<S>& /*out*/, const S& ts) {
    const CompensatedSum<S> present = params.held(IntegralForward::present(state, in));
    state = State<S>::of(add<S>(present, select(in.RUN, in.XIN * ts, S(0.0))));
  }
};

}  // namespace hysteron
