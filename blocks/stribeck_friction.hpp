// HY_STRIBECK_FRICTION: XOUT = XIN − LEVEL·(1 + STICTION·exp(−(V/V_STRIBECK)²))·z
#pragma once

#include "blocks/effect_term.hpp"
#include "blocks/friction.hpp"

namespace hysteron {

struct StribeckFriction {
  static constexpr About about{
      .name = "HY_STRIBECK_FRICTION",
      .title = "Stribeck friction",
      .group = Group::Dynamics,
      .equation =
          "XOUT(k) = XIN(k) − LEVEL·(1 + STICTION·exp(−(V(k)/V_STRIBECK)²))·z(k), "
          "z(k) = max(−1, min(1, z(k−1) + TS·(3·V(k) − V(k−1))/(2·PRESLIDE)))",
      .meaning =
          "Dry friction that is larger by the share STICTION at low velocity, as of a lubricated guide: it is the "
          "cause of stick-slip. With STICTION = 0 it is HY_COULOMB_FRICTION. V is the velocity that has come about "
          "up to this step; where it depends on XOUT in the same step, a HY_DELAY before V closes the loop.",

      .source = "B. Armstrong-Hélouvry, P. Dupont, C. Canudas de Wit, Automatica 30 (1994) 1083",
      .effect = "stribeck_friction",
      .family = Family::DryFriction,
      .simpler = "coulomb_friction"};

  template <class S>
  struct Params {
    S LEVEL;
    S STICTION;
    S V_STRIBECK;
    S PRESLIDE;
    using Self = Params;
    static constexpr auto fields() {
      return Fields{
          HY_FIELD(LEVEL).in("'x").at_least(0.0).otherwise(0.0).neutral_at(0.0).means("friction at high velocity"),
          HY_FIELD(STICTION).in("1").at_least(0.0).otherwise(0.5).means("additional share of LEVEL at velocity 0"),
          HY_FIELD(V_STRIBECK)
              .in("'v")
              .above(0.0)
              .otherwise(0.01)
              .means("velocity at which that share has fallen to 1/e"),
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
    const S slip = in.V / params.V_STRIBECK;
    const S sticking = S(1.0) + params.STICTION * exp(-(slip * slip));
    const S acting = stop_operator(state, in.V, params.PRESLIDE, ts);
    return {.XOUT = with_term<S>(in.XIN, -(params.LEVEL * sticking * acting))};
  }
  template <class S>
  static void update(const Params<S>& params, State<S>& state, const In<S>& in, const Out<S>& /*out*/, const S& ts) {
    state = {.STOP = stop_operator(state, in.V, params.PRESLIDE, ts), .V1 = in.V};
  }
};

}  // namespace hysteron
