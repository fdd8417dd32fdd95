// What a hysteresis loop does that Y(p) of the paper does not: asymmetry, dependence on bias and on rate, another
// shape. Shared by HY_HYSTERESIS_GENERAL and HY_M_GENERAL.
//
// On a branch that left u_i the loop's rise over the distance d = u − u_i, with p = |d| (2|d| on the skeleton), is
//   (C1·d + (1 ± A)·G(d) + B(d))·(1 + b·m),   G(d) = d·C2·p^C3/(C3+1),   B(d) = SHAPE·C1·d·z·exp(2(1 − z)),  z =
//   p/DEPTH
// with + upwards and − downwards, and m the middle of the branch so far, (u_i + u)/2, from the origin. Since m is the
// same for the way up and the way down, a loop that closes without b closes with it. B is 0 at the branching point and
// again far from it, and highest at p = DEPTH: Y(p), whose slope is monotone, cannot have that shape.
// With Duhem's form of the bias, y' = f(u)·M(p)·u', f = 1 + h·(u − origin), the slope follows the input itself, and
// the rise has in addition
//   h·((u_i − origin)·(C1·d + G(d)) + d²·(C1/2 + C2·p^C3/(C3+2)))
// which differs on the way up and the way down: such a loop wanders by the difference in each cycle.
// The growth is faster by the share R·log10(1 + |u'|/r) of what it grows within a sample.
#pragma once

#include "blocks/ports.hpp"
#include "blocks/ramberg_osgood.hpp"

namespace hysteron {

template <class S>
struct LoopEffects {
  S asymmetry;
  S bias;    ///< b, over the unit of the input
  S duhem;   ///< h, over the unit of the input
  S origin;  ///< where the bias is 0
  S shape;
  S depth;
};

/// The parameters of these effects, beside those of the block that they enrich.
template <class S, class Enriched, Label rate_unit, Label rate, Label distance_unit, Label origin, Label momentum_unit>
struct RichParams : Enriched {
  S ASYMMETRY;
  S RATE;
  S RATE_REFERENCE;
  S BIAS;
  S BIAS_REFERENCE;
  S DUHEM;
  S DUHEM_REFERENCE;
  S SHAPE;
  S SHAPE_DEPTH;
  using Self = RichParams;
  static constexpr auto fields() {
    return std::tuple_cat(
        Enriched::fields(),
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
                .means(joined<"share by which C2 grows per decade of ", rate>),
            HY_FIELD(RATE_REFERENCE)
                .in(rate_unit)
                .above(0.0)
                .otherwise(1.0)
                .means("rate above which the decades count"),
            HY_FIELD(BIAS)
                .in("1")
                .otherwise(0.0)
                .neutral_at(0.0)
                .effect("bias_dependence")
                .means(joined<"share by which the slopes are larger on a branch whose middle is BIAS_REFERENCE above ",
                              origin>),
            HY_FIELD(BIAS_REFERENCE)
                .in(distance_unit)
                .above(0.0)
                .otherwise(1.0)
                .means("distance at which BIAS is that share"),
            HY_FIELD(DUHEM)
                .in("1")
                .otherwise(0.0)
                .neutral_at(0.0)
                .effect("bias_dependence")
                .means(joined<"share by which the slope is larger where the input is DUHEM_REFERENCE above ", origin>),
            HY_FIELD(DUHEM_REFERENCE)
                .in(distance_unit)
                .above(0.0)
                .otherwise(1.0)
                .means("distance at which DUHEM is that share"),
            HY_FIELD(SHAPE)
                .in("1")
                .within(-0.5, 0.5)
                .otherwise(0.0)
                .neutral_at(0.0)
                .effect("curve_shape")
                .means("bend of the branch, over C1*SHAPE_DEPTH"),
            HY_FIELD(SHAPE_DEPTH)
                .in(momentum_unit)
                .above(0.0)
                .otherwise(1.0)
                .means("momentum at which the bend is largest")});
  }
  /// The effects, with the bias counted from where the input has the value `origin_of_bias`.
  [[nodiscard]] LoopEffects<S> effects(const S& origin_of_bias) const {
    return {.asymmetry = ASYMMETRY,
            .bias = BIAS / BIAS_REFERENCE,
            .duhem = DUHEM / DUHEM_REFERENCE,
            .origin = origin_of_bias,
            .shape = SHAPE,
            .depth = SHAPE_DEPTH};
  }
};

/// What the effects add on a branch: 0 where they are neutral.
template <class S>
struct RichRise {
  S plain;         ///< C1·d + G(d), as the paper has it, one branch from its start
  S excess;        ///< what asymmetry, bias of either form and shape add to that
  S growth;        ///< the part that grows with rate
  S slope;         ///< what they add to M
  S growth_slope;  ///< the derivative of `growth`
};

template <class S>
RichRise<S> rich_rise(const LoopConstants<S>& loop, const LoopEffects<S>& effects, const S& start, const S& distance,
                      const S& momentum, const Bool<S>& downwards) {
  const LoopSlopes<S> slopes = loop_slopes(loop, momentum);
  const S m_growth = slopes.tangent - loop.c1;
  const S growth = distance * (m_growth / (loop.c3 + S(1.0)));
  const S z = momentum / effects.depth;
  const S bell = effects.shape * loop.c1 * z * exp(S(2.0) * (S(1.0) - z));
  const S bend = distance * bell;
  const S m_bend = S(2.0) * (S(1.0) - z) * bell;
  const S skew = select(downwards, -effects.asymmetry, effects.asymmetry);
  const S middle = effects.bias * (start + S(0.5) * distance - effects.origin);
  const S skewed = growth * (S(1.0) + skew);
  const S m_skewed = m_growth * (S(1.0) + skew);
  const S whole = loop.c1 * distance + skewed + bend;
  const S half = S(0.5) * effects.bias;
  const S from = start - effects.origin;
  const S wander = effects.duhem * (from * (loop.c1 * distance + growth) +
                                    distance * distance * (S(0.5) * loop.c1 + m_growth / (loop.c3 + S(2.0))));
  return {.plain = distance * slopes.chord,
          .excess = growth * skew + bend + whole * middle + wander,
          .growth = skewed * (S(1.0) + middle),
          .slope = m_growth * skew + m_bend + (loop.c1 + m_skewed + m_bend) * middle + whole * half +
                   effects.duhem * (from + distance) * slopes.tangent,
          .growth_slope = m_skewed * (S(1.0) + middle) + skewed * half};
}

/// R·log10(1 + |rate|/reference): by what share the growth is faster.
template <class S>
S rate_share(const S& per_decade, const S& rate, const S& reference) {
  return per_decade * (log(S(1.0) + abs(rate) / reference) * S(0.4342944819032518));
}

}  // namespace hysteron
