// HY_VISCOUS_FRICTION: XOUT = XIN − COEFFICIENT·V − QUADRATIC·V·|V|
#pragma once

#include "blocks/effect_term.hpp"
#include "blocks/friction.hpp"

namespace hysteron {

struct ViscousFriction {
  static constexpr About about{
      .name = "HY_VISCOUS_FRICTION",
      .title = "Viscous friction",
      .group = Group::Dynamics,
      .equation = "XOUT(k) = XIN(k) − COEFFICIENT·V − QUADRATIC·V·|V|, V = V(k−1)",
      .meaning =
          "Friction in proportion to the velocity, and drag with its square, taken off a driving force; a QUADRATIC "
          "below 0 is a friction that grows less and less, within the speeds it was fitted at. V is that of the step "
          "before, so that "
          "the block closes the loop of force and velocity; it begins with 0.",

      .effect = "viscous_friction"};

  template <class S>
  struct Params {
    S COEFFICIENT;
    S QUADRATIC;
    using Self = Params;
    static constexpr auto fields() {
      return std::tuple{
          HY_FIELD(COEFFICIENT).in("'x/'v").at_least(0.0).otherwise(0.0).neutral_at(0.0).means("force over velocity"),
          HY_FIELD(QUADRATIC).in("'x/'v^2").otherwise(0.0).neutral_at(0.0).means("force over the square of it")};
    }
  };
  template <class S>
  struct State {
    S V1;
    using Self = State;
    static constexpr auto fields() {
      return std::tuple{HY_FIELD(V1).in("'v").otherwise(0.0).means("velocity one step ago")};
    }
  };
  template <class S>
  using In = FrictionIn<S>;
  template <class S>
  using Out = FrictionOut<S>;

  template <class S>
  static State<S> initial(const Params<S>& /*params*/) {
    return {.V1 = S(0.0)};
  }
  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& state, const In<S>& in, const S& /*ts*/) {
    return {.XOUT =
                with_term<S>(in.XIN, -(params.COEFFICIENT * state.V1 + params.QUADRATIC * (state.V1 * abs(state.V1))))};
  }
  template <class S>
  static void update(const Params<S>& /*params*/, State<S>& state, const In<S>& in, const Out<S>& /*out*/,
                     const S& /*ts*/) {
    state.V1 = in.V;
  }
};

}  // namespace hysteron
