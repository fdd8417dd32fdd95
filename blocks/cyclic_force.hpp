// HY_CYCLIC_FORCE: XOUT = XIN + Σ SINE_n·sin(2πn·POS/PITCH) + COSINE_n·cos(2πn·POS/PITCH), n = 1 … 4
#pragma once

#include "blocks/cogging.hpp"
#include "blocks/harmonics.hpp"

namespace hysteron {

struct CyclicForce {
  static constexpr About about{
      .name = "HY_CYCLIC_FORCE",
      .title = "Cyclic force over a position, with harmonics",
      .group = Group::Dynamics,
      .equation =
          "XOUT(k) = XIN(k) + Σ SINE_n·sin(2πn·POS(k−1)/PITCH) + COSINE_n·cos(2πn·POS(k−1)/PITCH), n = 1 … 4; SINE_1 "
          "is SINE",
      .meaning =
          "What a motor or a gear adds to a force periodically in its position, in four harmonics: magnets and slots "
          "give a cogging that is no sine. HY_COGGING has the first alone. POS is that of the step before, so that the "
          "block closes the loop of force and position; it begins with 0. Of a sensor over its own position, "
          "HY_CYCLIC_ERROR.",
      .source = "D. C. Hanselman, Brushless Permanent Magnet Motor Design, 2nd ed., 2003, for the series of a cogging",
      .effect = "cyclic_error",
      .family = Family::PeriodicOverPosition,
      .enriches = "HY_COGGING",
      .untried = "harmonics are added to a cogging that was found"};

  template <class S>
  using Params = CycleParams<S, "'p", "period in the position">;
  template <class S>
  using State = Cogging::State<S>;
  template <class S>
  using In = Cogging::In<S>;
  template <class S>
  using Out = Xout<S, "'x", "signal with the cycle">;

  template <class S>
  static State<S> initial(const Params<S>& /*params*/) {
    return {.POS1 = S(0.0)};
  }
  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& state, const In<S>& in, const S& /*ts*/) {
    return {.XOUT = with_term<S>(in.XIN, params.cycle(state.POS1 / params.PITCH))};
  }
  template <class S>
  static void update(const Params<S>& /*params*/, State<S>& state, const In<S>& in, const Out<S>& /*out*/,
                     const S& /*ts*/) {
    state.POS1 = in.POS;
  }
};

}  // namespace hysteron
