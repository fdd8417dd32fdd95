// What the frictions share: the force that drives and the velocity; for the dry ones, HY_COULOMB_FRICTION and
// HY_STRIBECK_FRICTION, the stop operator, which does not chatter.
#pragma once

#include "blocks/ports.hpp"

namespace hysteron {

template <class S>
struct FrictionIn {
  S XIN;
  S V;
  using Self = FrictionIn;
  static constexpr auto fields() {
    return std::tuple{HY_FIELD(XIN).in("'x").means("driving force, torque, or a voltage in proportion to it"),
                      HY_FIELD(V).in("'v").otherwise(0.0).means("velocity; not of this step's XOUT")};
  }
};

template <class S>
using FrictionOut = Xout<S, "'x", "force that is left for the motion">;

/// The part of the dry friction that acts, −1 to 1, after one that did a step ago. It follows the travel ∫V dt with the
/// slope 1/preslide, and stops at ±1 (L. Prandtl's elasto-plastic element): at rest it holds any force up to the whole
/// friction, and a reversal turns it over within a travel of 2·preslide. The velocity is that of the same step: a step
/// late, an axis at rest would swing about it, the more the stiffer it is held.
template <class S>
S stop_operator(const S& acting, const S& velocity, const S& preslide, const S& ts) {
  return max(min(acting + velocity * ts / preslide, S(1.0)), S(-1.0));
}

}  // namespace hysteron
