// The parameters and inputs of a MEM element and of its inverse: shared by HY_MEM and HY_MEM_INVERSE.
#pragma once

#include "blocks/momentum.hpp"

namespace hysteron {

/// `u` and `y` are the units of the element's own input and output, which the inverse has the other way round.
template <class S, Label u, Label y, Label gain_at_zero>
struct MemParams {
  S C1;
  S C2;
  S C3;
  Int<S> G;
  using Self = MemParams;
  static constexpr auto fields() {
    return Fields{HY_FIELD(C1).in(joined<y, "/", u>).above(0.0).otherwise(1.0).means(gain_at_zero),
                  HY_FIELD(C2).in(joined<y, "/", u, "/(", u, "*s)^C3">).otherwise(0.0).means("growth of the gain"),
                  HY_FIELD(C3).in("1").within(0.0, 10.0).otherwise(1.0).means("exponent of the momentum"),
                  HY_FIELD(G).within(0.0, 1.0).otherwise(1.0).means("0: g(u) = |u|; 1: g(u) = u")};
  }
};

template <class S, Label u, Label meaning>
struct MemIn {
  S XIN;
  Bool<S> R1;
  S P0;
  using Self = MemIn;
  static constexpr auto fields() {
    return Fields{
        HY_FIELD(XIN).in("'x").means(meaning),
        HY_FIELD(R1).otherwise(0.0).means("reset: the momentum begins anew at P0"),
        HY_FIELD(P0).role(FieldRole::StartValue).in(joined<u, "*s">).otherwise(0.0).means("momentum after a reset")};
  }
  /// What the momentum inside sees: the resets, and the element's own input as its rate.
  [[nodiscard]] Momentum::In<S> of_momentum(const S& rate) const { return {.XIN = rate, .R1 = R1, .P0 = P0}; }
};

}  // namespace hysteron
