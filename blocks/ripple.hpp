// A harmonic of a phase in periods: what the effects that repeat themselves add.
#pragma once

#include "blocks/scalar.hpp"

namespace hysteron {

/// sine·sin(2π·turns) + cosine·cos(2π·turns). Whole turns are taken off first, so that a large position keeps the
/// digits of its place within the period; beyond 2^31 turns that place is lost.
template <class S>
S ripple(const S& sine, const S& cosine, const S& turns) {
  const S angle = S(6.283185307179586) * (turns - to_real<S>(to_int(turns)));
  return sine * sin(angle) + cosine * cos(angle);
}

}  // namespace hysteron
