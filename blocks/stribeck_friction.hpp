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
          "XOUT = XIN − LEVEL·(1 + STICTION·exp(−(V/V_STRIBECK)²))·z, z(k+1) = max(−1, min(1, z(k) + "
          "TS·V(k)/PRESLIDE))",
      .meaning =
          "Dry friction that is larger by the share STICTION at low velocity, as of a lubricated guide: it is the "
          "cause of stick-slip. With STICTION = 0 it is HY_COULOMB_FRICTION. V is that of the step before, so that the "
          "block closes the loop of force and velocity; it begins with 0.",

      .source = "B. Armstrong-Hélouvry, P. Dupont, C. Canudas de Wit, Automatica 30 (1994) 1083",
      .effect = "stribeck_friction"};

  template <class S>
  struct Params {
    S LEVEL;
    S STICTION;
    S V_STRIBECK;
    S PRESLIDE;
    using Self = Params;
    static constexpr auto fields() {
      return std::tuple{
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
  struct State {
    S STOP;
    S V1;
    using Self = State;
    static constexpr auto fields() {
      return std::tuple{HY_FIELD(STOP).in("1").otherwise(0.0).means("part of the friction that acts, -1 to 1"),
                        HY_FIELD(V1).in("'v").otherwise(0.0).means("velocity one step ago")};
    }
  };
  template <class S>
  using In = FrictionIn<S>;
  template <class S>
  using Out = FrictionOut<S>;

  template <class S>
  static State<S> initial(const Params<S>& /*params*/) {
    return {.STOP = S(0.0), .V1 = S(0.0)};
  }
  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& state, const In<S>& in, const S& /*ts*/) {
    const S slip = state.V1 / params.V_STRIBECK;
    const S sticking = S(1.0) + params.STICTION * exp(-(slip * slip));
    return {.XOUT = with_term<S>(in.XIN, -(params.LEVEL * sticking * state.STOP))};
  }
  template <class S>
  static void update(const Params<S>& params, State<S>& state, const In<S>& in, const Out<S>& /*out*/, const S& ts) {
    state = {.STOP = stop_operator(state.STOP, in.V, params.PRESLIDE, ts), .V1 = in.V};
  }
};

}  // namespace hysteron
