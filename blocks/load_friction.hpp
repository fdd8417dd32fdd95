// HY_LOAD_FRICTION: XOUT = XIN − (LEVEL + COEFFICIENT·|W|)·z, z the stop operator of ∫V dt
#pragma once

#include "blocks/effect_term.hpp"
#include "blocks/friction.hpp"

namespace hysteron {

struct LoadFriction {
  static constexpr About about{
      .name = "HY_LOAD_FRICTION",
      .title = "Dry friction in proportion to a load",
      .group = Group::Dynamics,
      .equation =
          "XOUT(k) = XIN(k) − (LEVEL + COEFFICIENT·|W(k)|)·z(k), z(k) = max(−1, min(1, z(k−1) + TS·(3·V(k) − "
          "V(k−1))/(2·PRESLIDE)))",
      .meaning =
          "Dry friction that grows with the size of what presses two surfaces together: a seal under pressure, the "
          "gears of a joint under its load. W is that load, a force, torque, pressure or current, and LEVEL what is "
          "there without it. With COEFFICIENT = 0 it is HY_COULOMB_FRICTION. V is the velocity that has come about up "
          "to this step; where V or W depends on XOUT in the same step, a HY_DELAY before it closes the loop.",
      .source =
          "G. Amontons 1699, the first law of dry friction; A. C. Bittencourt, S. Gunnarsson, J. Dyn. Syst. Meas. "
          "Control 134 (2012) 051013, for joints of robots",
      .effect = "load_friction",
      .family = Family::DryFriction,
      .simpler = "coulomb_friction",
      .untried = "it needs two further signals, and a search wires one"};

  template <class S>
  struct Params {
    S LEVEL;
    S COEFFICIENT;
    S PRESLIDE;
    using Self = Params;
    static constexpr auto fields() {
      return Fields{
          HY_FIELD(LEVEL).in("'x").at_least(0.0).otherwise(0.0).neutral_at(0.0).means("friction without a load"),
          HY_FIELD(COEFFICIENT)
              .in("'x/'w")
              .at_least(0.0)
              .otherwise(0.0)
              .neutral_at(0.0)
              .means("friction over the size of the load"),
          HY_FIELD(PRESLIDE).in("'v*s").above(0.0).otherwise(0.001).means("travel from rest to the whole friction")};
    }
  };
  template <class S>
  using State = DryFrictionState<S>;
  template <class S>
  struct In : FrictionIn<S> {
    S W;
    using Self = In;
    static constexpr auto fields() {
      return concatenate(FrictionIn<S>::fields(),
                         Fields{HY_FIELD(W).in("'w").otherwise(0.0).means("load; its size counts")});
    }
  };
  template <class S>
  using Out = FrictionOut<S>;

  template <class S>
  static State<S> initial(const Params<S>& /*params*/) {
    return {.STOP = S(0.0), .V1 = S(0.0)};
  }
  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& state, const In<S>& in, const S& ts) {
    const S level = params.LEVEL + params.COEFFICIENT * abs(in.W);
    return {.XOUT = with_term<S>(in.XIN, -(level * stop_operator(state, in.V, params.PRESLIDE, ts)))};
  }
  template <class S>
  static void update(const Params<S>& params, State<S>& state, const In<S>& in, const Out<S>& /*out*/, const S& ts) {
    state = {.STOP = stop_operator(state, in.V, params.PRESLIDE, ts), .V1 = in.V};
  }
};

}  // namespace hysteron
