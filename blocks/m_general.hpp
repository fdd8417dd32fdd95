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
          "BIAS·m/BIAS_REFERENCE)), d = ±P by the sign of XIN, m = u − d/2, u the integral of XIN, r = "
          "RATE·log10(1 + |XIN|/RATE_REFERENCE); G and B as in HY_HYSTERESIS_GENERAL",
      .meaning =
          "HY_M, to the bit, where all its further parameters are 0: for diagrams that compose the hysteresis of rate, "
          "branching point, momentum and integral. The effects are those of HY_HYSTERESIS_GENERAL, in slopes: "
          "ASYMMETRY by the sign of XIN, RATE by its size, SHAPE by P. BIAS needs the hysteresis' input itself and "
          "integrates XIN for it, from 0 at the start; m is then the middle of the branch so far. Return points need "
          "the output and are left to HY_HYSTERESIS_GENERAL. For P < 0 the effects see |P|.",
      .source = "Strijbosch and Oomen, equations (5) and (17)",
      .enriches = "HY_M"};

  template <class S>
  struct Params : SlopeM::Params<S> {
    S ASYMMETRY;
    S RATE;
    S RATE_REFERENCE;
    S BIAS;
    S BIAS_REFERENCE;
    S SHAPE;
    S SHAPE_DEPTH;
    using Self = Params;
    static constexpr auto fields() {
      return std::tuple_cat(
          SlopeM::Params<S>::fields(),
          std::tuple{
              HY_FIELD(ASYMMETRY)
                  .in("1")
                  .within(-1.0, 1.0)
                  .otherwise(0.0)
                  .neutral_at(0.0)
                  .effect("asymmetry")
                  .means("C2 is larger by this share upwards and smaller downwards"),
              HY_FIELD(RATE)
                  .in("1")
                  .otherwise(0.0)
                  .neutral_at(0.0)
                  .effect("rate_dependence")
                  .means("share by which C2 grows per decade of XIN"),
              HY_FIELD(RATE_REFERENCE).in("'u").above(0.0).otherwise(1.0).means("rate above which the decades count"),
              HY_FIELD(BIAS)
                  .in("1")
                  .otherwise(0.0)
                  .neutral_at(0.0)
                  .effect("bias_dependence")
                  .means("share by which the slopes are larger on a branch whose middle is BIAS_REFERENCE above the "
                         "start"),
              HY_FIELD(BIAS_REFERENCE)
                  .in("'u*s")
                  .above(0.0)
                  .otherwise(1.0)
                  .means("distance at which BIAS is that share"),
              HY_FIELD(SHAPE)
                  .in("1")
                  .within(-0.5, 0.5)
                  .otherwise(0.0)
                  .neutral_at(0.0)
                  .effect("curve_shape")
                  .means("bend of the branch, over C1*SHAPE_DEPTH"),
              HY_FIELD(SHAPE_DEPTH).in("'p").above(0.0).otherwise(1.0).means("momentum at which the bend is largest")});
    }
  };
  template <class S>
  struct State {
    S SUM;
    S LOST;
    using Self = State;
    static constexpr auto fields() {
      return std::tuple{HY_FIELD(SUM).in("'u*s").otherwise(0.0).means("integral of XIN up to the step before"),
                        HY_FIELD(LOST).in("'u*s").otherwise(0.0).means("what rounding took from the sum")};
    }
  };
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
    const RichRise<S> rise = rich_rise<S>({.c1 = params.C1, .c2 = params.C2, .c3 = params.C3},
                                          {.asymmetry = params.ASYMMETRY,
                                           .bias = params.BIAS / params.BIAS_REFERENCE,
                                           .origin = S(0.0),
                                           .shape = params.SHAPE,
                                           .depth = params.SHAPE_DEPTH},
                                          state.SUM - distance, distance, abs(p), in.XIN < S(0.0));
    const S share = rate_share<S>(params.RATE, in.XIN, params.RATE_REFERENCE);
    const S slope = with_term<S>(mem_slope(params.C1, params.C2, params.C3, p), rise.slope + share * rise.growth_slope);
    return {.XOUT = slope * in.XIN, .M = slope};  // (5)
  }
  template <class S>
  static void update(const Params<S>& /*params*/, State<S>& state, const In<S>& in, const Out<S>& /*out*/,
                     const S& ts) {
    const CompensatedSum<S> next = add<S>({.high = state.SUM, .low = state.LOST}, in.XIN * ts);
    state = {.SUM = next.high, .LOST = next.low};
  }
};

}  // namespace hysteron
