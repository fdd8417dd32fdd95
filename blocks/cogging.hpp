// HY_COGGING: XOUT = XIN + SINE·sin(2π·POS/PITCH) + COSINE·cos(2π·POS/PITCH)
#pragma once

#include "blocks/effect_term.hpp"
#include "blocks/ripple.hpp"

namespace hysteron {

struct Cogging {
  static constexpr About about{
      .name = "HY_COGGING",
      .title = "Cogging",
      .group = Group::Dynamics,
      .equation = "XOUT(k) = XIN(k) + SINE·sin(2π·POS(k−1)/PITCH) + COSINE·cos(2π·POS(k−1)/PITCH)",
      .meaning =
          "What a machine adds to a force or to a signal periodically in its position: the cogging of a motor, the "
          "pitch error of a screw. POS is that of the step before, so that the block closes the loop of force and "
          "position; it begins with 0. An error over the measured position itself is HY_PERIODIC_ERROR.",

      .effect = "cogging",
      .family = Family::PeriodicOverPosition};

  template <class S>
  using Params = RippleParams<S, "'p", "period in the position">;
  template <class S>
  struct State {
    S POS1;
    using Self = State;
    static constexpr auto fields() {
      return Fields{HY_FIELD(POS1).in("'p").otherwise(0.0).means("position one step ago")};
    }
  };
  template <class S>
  struct In {
    S XIN;
    S POS;
    using Self = In;
    static constexpr auto fields() {
      return Fields{HY_FIELD(XIN).in("'x").means("signal"),
                    HY_FIELD(POS).in("'p").otherwise(0.0).means("position; counts in the step after")};
    }
  };
  template <class S>
  using Out = Xout<S, "'x", "signal with the ripple">;

  template <class S>
  static State<S> initial(const Params<S>& /*params*/) {
    return {.POS1 = S(0.0)};
  }
  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& state, const In<S>& in, const S& /*ts*/) {
    return {.XOUT = with_term<S>(in.XIN, ripple<S>(params.SINE, params.COSINE, state.POS1 / params.PITCH))};
  }
  template <class S>
  static void update(const Params<S>& /*params*/, State<S>& state, const In<S>& in, const Out<S>& /*out*/,
                     const S& /*ts*/) {
    state.POS1 = in.POS;
  }
};

}  // namespace hysteron
