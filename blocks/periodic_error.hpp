// HY_PERIODIC_ERROR: XOUT = XIN + SINE·sin(2π·XIN/PITCH) + COSINE·cos(2π·XIN/PITCH)
#pragma once

#include "blocks/effect_term.hpp"
#include "blocks/ripple.hpp"

namespace hysteron {

struct PeriodicError : Stateless {
  static constexpr About about{.name = "HY_PERIODIC_ERROR",
                               .title = "Periodic error of an encoder",
                               .group = Group::Shaping,
                               .equation = "XOUT = XIN + SINE·sin(2π·XIN/PITCH) + COSINE·cos(2π·XIN/PITCH)",
                               .meaning =
                                   "An error that repeats itself over the measured position itself: the interpolation "
                                   "error of an encoder, the nonlinearity of an interferometer. Where the position is "
                                   "another signal, a motor's torque over its angle, HY_COGGING has an input for it.",

                               .effect = "cogging",
                               .family = Family::PeriodicOverPosition};

  template <class S>
  using Params = RippleParams<S, "'x", "period of the error in XIN">;
  template <class S>
  using In = Xin<S, "'x", "signal">;
  template <class S>
  using Out = Xout<S, "'x", "position with the error">;

  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& /*state*/, const In<S>& in, const S& /*ts*/) {
    return {.XOUT = with_term<S>(in.XIN, ripple<S>(params.SINE, params.COSINE, in.XIN / params.PITCH))};
  }
};

}  // namespace hysteron
