// Dry friction without chatter: the stop operator, shared by HY_COULOMB_FRICTION and HY_STRIBECK_FRICTION.
#pragma once

#include "blocks/scalar.hpp"

namespace hysteron {

/// The part of the dry friction that acts, −1 to 1, one step later. It follows the travel ∫V dt with the slope
/// 1/preslide, and stops at ±1 (L. Prandtl's elasto-plastic element): at rest it holds any force up to the whole
/// friction, and a reversal turns it over within a travel of 2·preslide.
template <class S>
S stop_operator(const S& acting, const S& velocity, const S& preslide, const S& ts) {
  return max(min(acting + velocity * ts / preslide, S(1.0)), S(-1.0));
}

}  // namespace hysteron
