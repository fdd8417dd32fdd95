// A harmonic of a phase in periods: what the effects that repeat themselves add.
#pragma once

#include "blocks/ports.hpp"

namespace hysteron {

/// A harmonic over a position.
template <class S, Label unit, Label period>
struct RippleParams {
  S SINE;
  S COSINE;
  S PITCH;
  using Self = RippleParams;
  static constexpr auto fields() {
    return Fields{HY_FIELD(SINE).in("'x").otherwise(0.0).neutral_at(0.0).means("amplitude of the sine"),
                  HY_FIELD(COSINE).in("'x").otherwise(0.0).neutral_at(0.0).means("amplitude of the cosine"),
                  HY_FIELD(PITCH).role(FieldRole::Period).in(unit).above(0.0).otherwise(1.0).means(period)};
  }
};

/// sine·sin(2π·turns) + cosine·cos(2π·turns). Whole turns are taken off first, so that a large position keeps the
/// digits of its place within the period; beyond 2^31 turns that place is lost.
template <class S>
S ripple(const S& sine, const S& cosine, const S& turns) {
  const S angle = S(6.283185307179586) * (turns - to_real<S>(to_int(turns)));
  return sine * sin(angle) + cosine * cos(angle);
}

}  // namespace hysteron
