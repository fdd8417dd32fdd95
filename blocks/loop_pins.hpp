// The parameters and pins of a hysteresis loop and of its inverse: shared by HY_HYSTERESIS_RO and
// HY_HYSTERESIS_RO_INVERSE.
#pragma once

#include "blocks/ports.hpp"
#include "blocks/ramberg_osgood.hpp"

namespace hysteron {

/// `u` and `y` are the units of the loop's own input and output, which the inverse has the other way round.
template <class S, Label u, Label y, Label input, Label output, Label slope_at_start>
struct LoopParams {
  S C1;
  S C2;
  S C3;
  S EPS;
  Int<S> START;
  S U0;
  S Y0;
  using Self = LoopParams;
  static constexpr auto fields() {
    return Fields{
        HY_FIELD(C1).in(joined<y, "/", u>).above(0.0).otherwise(1.0).means(slope_at_start),
        HY_FIELD(C2).in(joined<y, "/", u, "^(1+C3)">).at_least(0.0).otherwise(0.0).means("growth of the slope"),
        HY_FIELD(C3).in("1").within(0.0, 10.0).otherwise(1.0).means("exponent of the momentum"),
        HY_FIELD(EPS)
            .in("'x")
            .at_least(0.0)
            .otherwise(0.0)
            .neutral_at(0.0)
            .effect("branch_chatter", Family::Hysteresis)
            .means("dead band of the branching detector"),
        HY_FIELD(START).within(-1.0, 1.0).otherwise(0.0).means(
            "0: on the skeleton; 1, -1: on a rising, falling branch"),
        HY_FIELD(U0)
            .role(FieldRole::StartValue)
            .in(u)
            .otherwise(0.0)
            .means(joined<input, " at the origin of the skeleton or of the first branch">),
        HY_FIELD(Y0).role(FieldRole::StartValue).in(y).otherwise(0.0).means(joined<output, " at that origin">)};
  }
  [[nodiscard]] LoopConstants<S> loop() const { return {.c1 = C1, .c2 = C2, .c3 = C3}; }
};

template <class S, Label meaning>
struct LoopIn {
  S XIN;
  Bool<S> R1;
  using Self = LoopIn;
  static constexpr auto fields() {
    return Fields{HY_FIELD(XIN).in("'x").means(meaning),
                  HY_FIELD(R1).otherwise(0.0).means("reset: begins again at U0, Y0")};
  }
};

template <class S, Label u, Label y, Label meaning, Label travel>
struct LoopOut {
  S XOUT;
  S P;
  S SLOPE;
  Bool<S> Q;
  using Self = LoopOut;
  static constexpr auto fields() {
    return Fields{
        HY_FIELD(XOUT).in("'y").means(meaning),
        HY_FIELD(P).in(u).means(joined<"momentum: ", travel, " since the branching point, twice that on the skeleton">),
        HY_FIELD(SLOPE).in(joined<y, "/", u>).means("slope of the loop, M(P)"),
        HY_FIELD(Q).means("TRUE in the step in which a reversal is declared")};
  }
};

}  // namespace hysteron
