// HY_ASYMMETRIC_FRICTION: XOUT = XIN − UP·max(z, 0) − DOWN·min(z, 0), z the stop operator of ∫V dt
#pragma once

#include "blocks/effect_term.hpp"
#include "blocks/friction.hpp"

namespace hysteron {

struct AsymmetricFriction {
  static constexpr About about{
      .name = "HY_ASYMMETRIC_FRICTION",
      .title = "Coulomb friction with a level for each direction",
      .group = Group::Dynamics,
      .equation =
          "XOUT(k) = XIN(k) − UP·max(z(k), 0) − DOWN·min(z(k), 0), z(k) = max(−1, min(1, z(k−1) + TS·(3·V(k) − "
          "V(k−1))/(2·PRESLIDE)))",
      .meaning =
          "Dry friction that is UP while V is above 0 and DOWN while it is below: a preloaded screw, an axis whose "
          "amplifier has an offset. While it slides it is a HY_COULOMB_FRICTION of (UP + DOWN)/2 and an offset of (UP "
          "- DOWN)/2, in one effect; at the start, before any motion, neither acts. With UP = DOWN it is "
          "HY_COULOMB_FRICTION. V is the velocity that has come about up to this step; where it depends on XOUT in the "
          "same step, a HY_DELAY before V closes the loop.",
      .source =
          "B. Armstrong-Hélouvry, Control of Machines with Friction, 1991, for levels that differ by direction; A. "
          "Janot, M. Gautier, M. Brunot, EMPS, Workshop on Nonlinear System Identification Benchmarks, 2019",
      .effect = "asymmetric_friction",
      .family = Family::DryFriction,
      .untried = beside_its_family};

  template <class S>
  struct Params {
    S UP;
    S DOWN;
    S PRESLIDE;
    using Self = Params;
    static constexpr auto fields() {
      return Fields{
          HY_FIELD(UP).in("'x").at_least(0.0).otherwise(0.0).neutral_at(0.0).means("friction while V is above 0"),
          HY_FIELD(DOWN).in("'x").at_least(0.0).otherwise(0.0).neutral_at(0.0).means("friction while V is below 0"),
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
    const S acting = stop_operator(state, in.V, params.PRESLIDE, ts);
    const S level = select(acting < S(0.0), params.DOWN, params.UP);
    return {.XOUT = with_term<S>(in.XIN, -(level * acting))};
  }
  template <class S>
  static void update(const Params<S>& params, State<S>& state, const In<S>& in, const Out<S>& /*out*/, const S& ts) {
    state = {.STOP = stop_operator(state, in.V, params.PRESLIDE, ts), .V1 = in.V};
  }
};

}  // namespace hysteron
