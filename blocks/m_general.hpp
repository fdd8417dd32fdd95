// HY_M_GENERAL: HY_M with asymmetry, dependence on rate and bias, and another shape
#pragma once

#include "blocks/compensated_sum.hpp"
#include "blocks/effect_term.hpp"
#include "blocks/m.hpp"
#include "blocks/rich_loop.hpp"

namespace hysteron {

struct SlopeMGeneral {
  static constexpr About about{
      .name = "HY_M_GENERAL",
      .title = "Slope by momentum with the effects it lacks",
      .group = Group::Memory,
      .equation =
          "XOUT = M·XIN, M the derivative by u of ((C1·d + (1 ± ASYMMETRY)·(1 + r)·G(d) + B(d))·(1 + "
          "BIAS·m/BIAS_REFERENCE)) + ((C1 + C2·P^C3)·DUHEM/DUHEM_REFERENCE + "
          "C2·P^C3·HARDENING/HARDENING_REFERENCE)·u, d = ±P by the sign of XIN, m = u − d/2, u the integral of XIN, r "
          "= RATE·log10(1 + |XIN|/RATE_REFERENCE); G and B as in HY_HYSTERESIS_GENERAL",
      .meaning =
          "HY_M, to the bit, where all its further parameters are 0: for diagrams that compose the hysteresis of "
          "rate, branching point, momentum and integral. The effects are those of HY_HYSTERESIS_GENERAL, in slopes: "
          "ASYMMETRY and its exponent by the sign of XIN, RATE by its size, SHAPE by P. BIAS, DUHEM and HARDENING "
          "need the hysteresis' input itself and integrate XIN for it, from 0 at the start; m is then the middle of "
          "the branch so far. Return points need the output and are left to HY_HYSTERESIS_GENERAL. For P < 0 the "
          "effects see |P|.",
      .source = "Strijbosch and Oomen, equations (5) and (17)",
      .enriches = "HY_M"};

  template <class S>
  using Params = RichParams<S, SlopeM::Params<S>, "'u", "XIN", "'u*s", "the start", "'p">;
  template <class S>
  using State = SumState<S, "'u*s", "integral of XIN up to the step before">;
  template <class S>
  using In = SlopeM::In<S>;
  template <class S>
  using Out = SlopeM::Out<S>;

  template <class S>
  static State<S> initial(const Params<S>& /*params*/) {
    return {.SUM = S(0.0), .LOST = S(0.0)};
  }
  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& state, const In<S>& in, const S& /*ts*/) {
    const S p = in.momentum();
    const S distance = select(in.XIN < S(0.0), -abs(p), abs(p));
    const RichRise<S> rise = rich_rise<S>({.c1 = params.C1, .c2 = params.C2, .c3 = params.C3}, params.effects(S(0.0)),
                                          state.SUM - distance, distance, abs(p), in.XIN < S(0.0));
    const S share = rate_share<S>(params.RATE, in.XIN, params.RATE_REFERENCE);
    const S slope = with_term<S>(mem_slope(params.C1, params.C2, params.C3, p), rise.slope + share * rise.growth_slope);
    return {.XOUT = slope * in.XIN, .M = slope};  // (5)
  }
  template <class S>
  static void update(const Params<S>& /*params*/, State<S>& state, const In<S>& in, const Out<S>& /*out*/,
                     const S& ts) {
    const CompensatedSum<S> next = add(state.sum(), in.XIN * ts);
    state = State<S>::of(next);
  }
};

}  // namespace hysteron
