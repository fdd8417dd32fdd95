// HY_DAHL_FRICTION: XOUT = XIN − LEVEL·z, dz/dx = (1 − z·sgn V)/PRESLIDE
#pragma once

#include "blocks/effect_term.hpp"
#include "blocks/filtered_rate.hpp"
#include "blocks/friction.hpp"

namespace hysteron {

struct DahlFriction {
  static constexpr About about{
      .name = "HY_DAHL_FRICTION",
      .title = "Dry friction with presliding (Dahl)",
      .group = Group::Dynamics,
      .equation = "XOUT = XIN − LEVEL·z, z' = V·(1 − z·sgn V)/PRESLIDE",
      .meaning =
          "Dry friction that builds up over a travel, as the asperities of two surfaces bend before they slide: after "
          "a reversal it turns over along an exponential of the travel and comes within 5 % of LEVEL after "
          "3.7*PRESLIDE. HY_COULOMB_FRICTION does so in a straight line that ends. It is the LuGre model without its "
          "viscous part and without a Stribeck curve. Exact for a velocity that does not turn within a sample. V is "
          "the velocity that has come about up to this step; where it depends on XOUT in the same step, a HY_DELAY "
          "before V closes the loop.",
      .source =
          "P. R. Dahl, AIAA J. 14 (1976) 1675, with exponent 1; C. Canudas de Wit, H. Olsson, K. J. Åström, P. "
          "Lischinsky, IEEE Trans. Autom. Control 40 (1995) 419",
      .effect = "presliding_friction",
      .family = Family::DryFriction,
      .untried = beside_its_family};

  template <class S>
  struct Params {
    S LEVEL;
    S PRESLIDE;
    using Self = Params;
    static constexpr auto fields() {
      return Fields{
          HY_FIELD(LEVEL).in("'x").at_least(0.0).otherwise(0.0).neutral_at(0.0).means("friction while sliding"),
          HY_FIELD(PRESLIDE).in("'v*s").above(0.0).otherwise(0.001).means("travel over which it builds up to 63 %")};
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
    return {.XOUT = with_term<S>(in.XIN, -(params.LEVEL * built_up(params, state, in, ts)))};
  }
  template <class S>
  static void update(const Params<S>& params, State<S>& state, const In<S>& in, const Out<S>& /*out*/, const S& ts) {
    state = {.STOP = built_up(params, state, in, ts), .V1 = in.V};
  }

 private:
  /// z after the travel of the sample: 1 − z·sgn V falls by exp(−travel/PRESLIDE).
  template <class S>
  static S built_up(const Params<S>& params, const State<S>& state, const In<S>& in, const S& ts) {
    const S travel = travel_of_sample(state, in.V, ts);
    const S way = select(travel < S(0.0), S(-1.0), S(1.0));
    return state.STOP + (way - state.STOP) * decayed_part(abs(travel) / params.PRESLIDE);
  }
};

}  // namespace hysteron
