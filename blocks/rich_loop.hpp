// What a hysteresis loop does that Y(p) of the paper does not: asymmetry, dependence on bias and on rate, another
// shape. Shared by HY_HYSTERESIS_GENERAL and HY_M_GENERAL.
//
// On a branch that left u_i the loop's rise over the distance d = u − u_i, with p = |d| (2|d| on the skeleton), is
//   (C1·d + (1 ± A)·G(d) + B(d))·(1 + b·m),   G(d) = d·C2·p^C3·(p/r)^±E/(C3±E+1),
//   B(d) = SHAPE·C1·d·(1 − (1 − exp(−z))/z),   z = p/DEPTH
// with + upwards and − downwards, so that C2 and C3 differ between the two by A and E, and m the middle of the branch
// so far, (u_i + u)/2, from the origin. Since m is the same for the way up and the way down, a loop that closes without
// b closes with it. B's slope SHAPE·C1·(1 − exp(−z)) is 0 at the branching point and saturates: Y(p), whose slope goes
// on as a power of p, cannot have that shape. With Duhem's form of the bias, y' = f(u)·M(p)·u', f = 1 + h·(u − origin),
// the slope follows the input itself, and the rise has in addition
//   h·((u_i − origin)·(C1·d + G(d)) + d²·(C1/2 + C2·p^C3/(C3+2)))
// which differs on the way up and the way down: such a loop wanders by the difference in each cycle. Where the growth
// alone follows the input, y' = (C1 + f(u)·C2·p^C3)·u', the terms in C1 are left out of that.
// The growth is faster by the share R·log10(1 + |u'|/r) of what it grows within a sample.
#pragma once

#include "blocks/ports.hpp"
#include "blocks/ramberg_osgood.hpp"

namespace hysteron {

template <class S>
struct LoopEffects {
  S asymmetry;
  S exponent;   ///< E
  S reach;      ///< r, the momentum at which E changes nothing
  S bias;       ///< b, over the unit of the input
  S duhem;      ///< h, over the unit of the input
  S hardening;  ///< the same of the growth alone
  S origin;     ///< where the bias is 0
  S shape;
  S depth;
};

/// The parameters of these effects, beside those of the block that they enrich.
template <class S, class Enriched, Label rate_unit, Label rate, Label distance_unit, Label origin, Label momentum_unit>
struct RichParams : Enriched {
  S ASYMMETRY;
  S ASYMMETRY_EXPONENT;
  S ASYMMETRY_REFERENCE;
  S RATE;
  S RATE_REFERENCE;
  S BIAS;
  S BIAS_REFERENCE;
  S DUHEM;
  S DUHEM_REFERENCE;
  S HARDENING;
  S HARDENING_REFERENCE;
  S SHAPE;
  S SHAPE_DEPTH;
  using Self = RichParams;
  static constexpr auto fields() {
    return concatenate(
        Enriched::fields(),
        Fields{
            HY_FIELD(ASYMMETRY)
                .in("1")
                .within(-1.0, 1.0)
                .otherwise(0.0)
                .neutral_at(0.0)
                .effect("asymmetry", Family::Hysteresis)
                .means("C2 is larger by this share upwards and smaller downwards"),
            HY_FIELD(ASYMMETRY_EXPONENT)
                .shapes("ASYMMETRY")
                .in("1")
                .within(-0.9, 0.9)
                .otherwise(0.0)
                .neutral_at(0.0)
                .means("C3 is larger by this upwards and smaller downwards"),
            HY_FIELD(ASYMMETRY_REFERENCE)
                .shapes("ASYMMETRY")
                .role(FieldRole::ReferenceSize)
                .in(momentum_unit)
                .above(0.0)
                .otherwise(1.0)
                .means("momentum at which ASYMMETRY_EXPONENT changes no slope"),
            HY_FIELD(RATE)
                .in("1")
                .otherwise(0.0)
                .neutral_at(0.0)
                .effect("rate_dependence", Family::Hysteresis)
                .means(joined<"share by which C2 grows per decade of ", rate>),
            HY_FIELD(RATE_REFERENCE)
                .shapes("RATE")
                .role(FieldRole::ReferenceSize)
                .in(rate_unit)
                .above(0.0)
                .otherwise(1.0)
                .means("rate above which the decades count"),
            HY_FIELD(BIAS)
                .in("1")
                .otherwise(0.0)
                .neutral_at(0.0)
                .effect("bias_dependence", Family::Hysteresis)
                .means(joined<"share by which the slopes are larger on a branch whose middle is BIAS_REFERENCE above ",
                              origin>),
            HY_FIELD(BIAS_REFERENCE)
                .shapes("BIAS")
                .role(FieldRole::ReferenceSize)
                .in(distance_unit)
                .above(0.0)
                .otherwise(1.0)
                .means("distance at which BIAS is that share"),
            HY_FIELD(DUHEM)
                .in("1")
                .otherwise(0.0)
                .neutral_at(0.0)
                .effect("bias_dependence", Family::Hysteresis)
                .means(joined<"share by which the slope is larger where the input is DUHEM_REFERENCE above ", origin>),
            HY_FIELD(DUHEM_REFERENCE)
                .shapes("DUHEM")
                .role(FieldRole::ReferenceSize)
                .in(distance_unit)
                .above(0.0)
                .otherwise(1.0)
                .means("distance at which DUHEM is that share"),
            HY_FIELD(HARDENING)
                .in("1")
                .otherwise(0.0)
                .neutral_at(0.0)
                .effect("bias_dependence", Family::Hysteresis)
                .means(joined<"share by which the growth of the slope, C2*p^C3, is larger where the input is "
                              "HARDENING_REFERENCE above ",
                              origin>),
            HY_FIELD(HARDENING_REFERENCE)
                .shapes("HARDENING")
                .role(FieldRole::ReferenceSize)
                .in(distance_unit)
                .above(0.0)
                .otherwise(1.0)
                .means("distance at which HARDENING is that share"),
            HY_FIELD(SHAPE)
                .in("1")
                .within(-1.0, 4.0)
                .otherwise(0.0)
                .neutral_at(0.0)
                .effect("curve_shape", Family::Hysteresis)
                .means("share of C1 by which the slope is larger far from the branching point"),
            HY_FIELD(SHAPE_DEPTH)
                .shapes("SHAPE")
                .in(momentum_unit)
                .above(0.0)
                .otherwise(1.0)
                .means("momentum within which the slope gets there")});
  }
  /// The effects, with the bias counted from where the input has the value `origin_of_bias`.
  [[nodiscard]] LoopEffects<S> effects(const S& origin_of_bias) const {
    return {.asymmetry = ASYMMETRY,
            .exponent = ASYMMETRY_EXPONENT,
            .reach = ASYMMETRY_REFERENCE,
            .bias = BIAS / BIAS_REFERENCE,
            .duhem = DUHEM / DUHEM_REFERENCE,
            .hardening = HARDENING / HARDENING_REFERENCE,
            .origin = origin_of_bias,
            .shape = SHAPE,
            .depth = SHAPE_DEPTH};
  }
};

/// The growth of a branch, as asymmetry and its exponent change it.
template <class S>
struct RichGrowth {
  LoopSlopes<S> slopes;  ///< of the paper's loop
  S plain;               ///< G(d) without asymmetry
  S plain_slope;         ///< C2·p^C3
  S changed;             ///< by what G(d) is multiplied
  S changed_slope;       ///< and by what its slope
  S middle;              ///< b·m

  [[nodiscard]] S skewed() const { return plain * changed; }
  [[nodiscard]] S whole() const { return skewed() * (S(1.0) + middle); }
};

template <class S>
RichGrowth<S> rich_growth(const LoopConstants<S>& loop, const LoopEffects<S>& effects, const S& start,
                          const S& distance, const S& momentum, const Bool<S>& downwards) {
  const LoopSlopes<S> slopes = loop_slopes(loop, momentum);
  const S m_growth = slopes.tangent - loop.c1;
  const S one_way = select(downwards, S(-1.0), S(1.0));
  const S tilt = one_way * effects.exponent;
  // A falling exponent makes the slope infinite where a branch begins, and it is left so soon that nothing is lost.
  constexpr double soon = 1e-9;
  const S steeper = unless_zero(tilt, S(1.0), [&] { return power(max(momentum / effects.reach, S(soon)), tilt); });
  const S order = unless_zero(tilt, S(1.0), [&] { return (loop.c3 + S(1.0)) / (loop.c3 + tilt + S(1.0)); });
  const S tilted = steeper * (S(1.0) + one_way * effects.asymmetry);
  return {.slopes = slopes,
          .plain = distance * (m_growth / (loop.c3 + S(1.0))),
          .plain_slope = m_growth,
          .changed = tilted * order,
          .changed_slope = tilted,
          .middle = effects.bias * (start + S(0.5) * distance - effects.origin)};
}

/// What the effects add on a branch: 0 where they are neutral.
template <class S>
struct RichRise {
  S plain;         ///< C1·d + G(d), as the paper has it, one branch from its start
  S plain_slope;   ///< M(p)
  S excess;        ///< what asymmetry, bias of either form and shape add to the rise
  S growth;        ///< the part that grows with rate
  S slope;         ///< what they add to M
  S growth_slope;  ///< the derivative of `growth`
};

/// A term of a rise and its derivative.
template <class S>
struct RiseTerm {
  S rise;
  S slope;
};

template <class S>
RiseTerm<S> select(const Bool<S>& condition, const RiseTerm<S>& a, const RiseTerm<S>& b) {
  return {.rise = select(condition, a.rise, b.rise), .slope = select(condition, a.slope, b.slope)};
}

template <class S>
RichRise<S> rich_rise(const LoopConstants<S>& loop, const LoopEffects<S>& effects, const S& start, const S& distance,
                      const S& momentum, const Bool<S>& downwards) {
  const RichGrowth<S> growth = rich_growth<S>(loop, effects, start, distance, momentum, downwards);
  const S m_growth = growth.plain_slope;
  const S skewed = growth.skewed();
  const S m_skewed = m_growth * growth.changed_slope;
  const RiseTerm<S> none{.rise = S(0.0), .slope = S(0.0)};
  const RiseTerm<S> bend = unless_zero(effects.shape, none, [&] {
    constexpr double soon = 1e-9;  // nothing has risen yet
    const S z = max(momentum / effects.depth, S(soon));
    const S there = S(1.0) - exp(-z);
    const S most = effects.shape * loop.c1;
    return RiseTerm<S>{.rise = distance * (most * (S(1.0) - there / z)), .slope = most * there};
  });
  const S half = S(0.5) * effects.bias;
  const RiseTerm<S> biased = unless_zero(effects.bias, none, [&] {
    const S whole = loop.c1 * distance + skewed + bend.rise;
    return RiseTerm<S>{.rise = whole * growth.middle,
                       .slope = (loop.c1 + m_skewed + bend.slope) * growth.middle + whole * half};
  });
  const S from = start - effects.origin;
  const S square = distance * distance;
  const auto hardened = [&] { return from * growth.plain + square * (m_growth / (loop.c3 + S(2.0))); };
  const RiseTerm<S> duhem = unless_zero(effects.duhem, none, [&] {
    return RiseTerm<S>{.rise = effects.duhem * (hardened() + loop.c1 * (from * distance + S(0.5) * square)),
                       .slope = (from + distance) * (effects.duhem * growth.slopes.tangent)};
  });
  const RiseTerm<S> hardening = unless_zero(effects.hardening, none, [&] {
    return RiseTerm<S>{.rise = effects.hardening * hardened(),
                       .slope = (from + distance) * (effects.hardening * m_growth)};
  });
  return {
      .plain = distance * growth.slopes.chord,
      .plain_slope = growth.slopes.tangent,
      .excess = growth.plain * (growth.changed - S(1.0)) + bend.rise + biased.rise + duhem.rise + hardening.rise,
      .growth = growth.whole(),
      .slope = m_growth * (growth.changed_slope - S(1.0)) + bend.slope + biased.slope + duhem.slope + hardening.slope,
      .growth_slope = m_skewed * (S(1.0) + growth.middle) + skewed * half};
}

/// R·log10(1 + |rate|/reference): by what share the growth is faster.
template <class S>
S rate_share(const S& per_decade, const S& rate, const S& reference) {
  return unless_zero(per_decade, S(0.0),
                     [&] { return per_decade * (log(S(1.0) + abs(rate) / reference) * S(0.4342944819032518)); });
}

}  // namespace hysteron
