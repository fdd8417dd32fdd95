// What the frictions share: the force that drives and the velocity; for the dry ones, HY_COULOMB_FRICTION and its like,
// the stop operator, which does not chatter.
#pragma once

#include "blocks/ports.hpp"

namespace hysteron {

template <class S>
struct FrictionIn {
  S XIN;
  S V;
  using Self = FrictionIn;
  static constexpr auto fields() {
    return Fields{HY_FIELD(XIN).in("'x").means("driving force, torque, or a voltage in proportion to it"),
                  HY_FIELD(V).in("'v").otherwise(0.0).means("velocity; not of this step's XOUT")};
  }
};

template <class S>
using FrictionOut = Xout<S, "'x", "force that is left for the motion">;

template <class S>
struct DryFrictionState {
  S STOP;
  S V1;
  using Self = DryFrictionState;
  static constexpr auto fields() {
    return Fields{HY_FIELD(STOP).in("1").otherwise(0.0).means("part of the friction that acts, -1 to 1"),
                  HY_FIELD(V1).in("'v").otherwise(0.0).means("velocity one sample ago")};
  }
};

/// Why a diagnosis does not try every friction by itself.
inline constexpr std::string_view beside_its_family =
    "one dry friction stands for the family until the record tells its members apart";

/// The travel of a sample. What a friction does in it is right on average with the velocity in the middle of the step,
/// (3·V(k) − V(k−1))/2 (J. C. Adams' extrapolation). With that of the beginning a reversal would come half a step late,
/// and an axis at rest would swing about it, undamped.
template <class S>
S travel_of_sample(const DryFrictionState<S>& state, const S& velocity, const S& ts) {
  return (S(1.5) * velocity - S(0.5) * state.V1) * ts;
}

/// The part of the dry friction that acts, −1 to 1. It follows the travel ∫V dt with the slope 1/preslide, and stops at
/// ±1 (L. Prandtl's elasto-plastic element): at rest it holds any force up to the whole friction, and a reversal turns
/// it over within a travel of 2·preslide.
template <class S>
S stop_operator(const DryFrictionState<S>& state, const S& velocity, const S& preslide, const S& ts) {
  return max(min(state.STOP + travel_of_sample(state, velocity, ts) / preslide, S(1.0)), S(-1.0));
}

}  // namespace hysteron
