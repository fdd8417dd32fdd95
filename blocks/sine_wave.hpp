// HY_SINE: XOUT = OFFSET + AMPLITUDE·sin(2π·(FREQUENCY·t + PHASE))
#pragma once

#include "blocks/periodic.hpp"

namespace hysteron {

struct SineWave : Periodic {
  static constexpr About about{.name = "HY_SINE",
                               .title = "Sine reference",
                               .group = Group::Control,
                               .equation = "XOUT = OFFSET + AMPLITUDE·sin(2π·(FREQUENCY·t + PHASE))",
                               .meaning =
                                   "A sine that can run for years: its phase is kept in twice the working precision "
                                   "and does not drift. A change of FREQUENCY while it runs goes on from the present "
                                   "phase, without a jump. The first step has t = 0."};

  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& state, const In<S>& in, const S& /*ts*/) {
    return shaped(params, in, sin(S(6.283185307179586) * phase(params, state)));
  }
};

}  // namespace hysteron
