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
      .equation = "XOUT = XIN − COEFFICIENT·V − QUADRATIC·V·|V|",
      .meaning =
          "Friction in proportion to the velocity, and drag with its square, taken off a driving force; a QUADRATIC "
          "below 0 is a friction that grows less and less, within the speeds it was fitted at. V is the velocity that "
          "has come about up to this step; where it depends on XOUT in the same step, a HY_DELAY before V closes the "
          "loop.",

      .effect = "viscous_friction",
      .family = Family::ViscousFriction};

  template <class S>
  struct Params {
    S COEFFICIENT;
    S QUADRATIC;
    using Self = Params;
    static constexpr auto fields() {
      return Fields{
          HY_FIELD(COEFFICIENT).in("'x/'v").at_least(0.0).otherwise(0.0).neutral_at(0.0).means("force over velocity"),
          HY_FIELD(QUADRATIC).in("'x/'v^2").otherwise(0.0).neutral_at(0.0).means("force over the square of it")};
    }
  };
  template <class S>
  using State = NoFields<S>;
  template <class S>
  using In = FrictionIn<S>;
  template <class S>
  using Out = FrictionOut<S>;

  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& /*state*/, const In<S>& in, const S& /*ts*/) {
    return {.XOUT = with_term<S>(in.XIN, -(params.COEFFICIENT * in.V + params.QUADRATIC * (in.V * abs(in.V))))};
  }
};

}  // namespace hysteron
