// HY_COULOMB_FRICTION: XOUT = XIN − LEVEL·z, z the stop operator of ∫V dt
#pragma once

#include "blocks/effect_term.hpp"
#include "blocks/friction.hpp"

namespace hysteron {

struct CoulombFriction {
  static constexpr About about{
      .name = "HY_COULOMB_FRICTION",
      .title = "Coulomb friction",
      .group = Group::Dynamics,
      .equation = "XOUT(k) = XIN(k) − LEVEL·z(k), z(k) = max(−1, min(1, z(k−1) + TS·(3·V(k) − V(k−1))/(2·PRESLIDE)))",
      .meaning =
          "Dry friction, taken off a driving force: LEVEL against the motion once the travel after a reversal exceeds "
          "2·PRESLIDE, and elastic before that, so that it holds at rest without chatter. V is the velocity that "
          "has come about up to this step, of a HY_INTEGRAL_FORWARD say; where it depends on XOUT in the same step, a "
          "HY_DELAY before V closes the loop. A PRESLIDE of less than some steps of travel lets the friction jump.",

      .source = "L. Prandtl, ZAMM 8 (1928) 85: Ein Gedankenmodell zur kinetischen Theorie der festen Körper",
      .effect = "coulomb_friction",
      .family = Family::DryFriction};

  template <class S>
  struct Params {
    S LEVEL;
    S PRESLIDE;
    using Self = Params;
    static constexpr auto fields() {
      return Fields{
          HY_FIELD(LEVEL).in("'x").at_least(0.0).otherwise(0.0).neutral_at(0.0).means("friction while sliding"),
          HY_FIELD(PRESLIDE).in("'v*s").above(0.0).otherwise(0.001).means("travel from rest to the whole friction")};
    }
  };
  template <class S>
  using State = DryFrictionState<S>;
  template <class S>
  using In = FrictionIn<S>;
  template <class S>
  using Out = FrictionOut<S>;

  template <class S>
  static State<S> initial(const Params<S>& /*params*/) {
    return {.STOP = S(0.0), .V1 = S(0.0)};
  }
  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& state, const In<S>& in, const S& ts) {
    return {.XOUT = with_term<S>(in.XIN, -(params.LEVEL * stop_operator(state, in.V, params.PRESLIDE, ts)))};
  }
  template <class S>
  static void update(const Params<S>& params, State<S>& state, const In<S>& in, const Out<S>& /*out*/, const S& ts) {
    state = {.STOP = stop_operator(state, in.V, params.PRESLIDE, ts), .V1 = in.V};
  }
};

}  // namespace hysteron
