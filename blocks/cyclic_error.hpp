// HY_CYCLIC_ERROR: XOUT = XIN + Σ SINE_n·sin(2πn·XIN/PITCH) + COSINE_n·cos(2πn·XIN/PITCH), n = 1 … 4
#pragma once

#include "blocks/effect_term.hpp"
#include "blocks/harmonics.hpp"

namespace hysteron {

struct CyclicError : Stateless {
  static constexpr About about{
      .name = "HY_CYCLIC_ERROR",
      .title = "Cyclic error of a sensor, with harmonics",
      .group = Group::Shaping,
      .equation = "XOUT = XIN + Σ SINE_n·sin(2πn·XIN/PITCH) + COSINE_n·cos(2πn·XIN/PITCH), n = 1 … 4; SINE_1 is SINE",
      .meaning =
          "The error of a resolver, an encoder or an interferometer over its own position, in four harmonics: what "
          "offsets, unequal amplitudes and a phase error of its two tracks leave has one and two cycles a period, "
          "their distortion three and four. HY_PERIODIC_ERROR has the first alone. Of a force over a position, "
          "HY_CYCLIC_FORCE.",
      .source = "D. C. Hanselman, IEEE Trans. Ind. Electron. 37 (1990) 556, Resolver signal requirements",
      .effect = "cyclic_error",
      .family = Family::PeriodicOverPosition,
      .enriches = "HY_PERIODIC_ERROR",
      .untried = "harmonics are added to a cogging that was found"};

  template <class S>
  using Params = CycleParams<S, "'x", "period of the error in XIN">;
  template <class S>
  using In = Xin<S, "'x", "signal">;
  template <class S>
  using Out = Xout<S, "'x", "position with the error">;

  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& /*state*/, const In<S>& in, const S& /*ts*/) {
    return {.XOUT = with_term<S>(in.XIN, params.cycle(in.XIN / params.PITCH))};
  }
};

}  // namespace hysteron
