// HY_TRIANGLE: XOUT = OFFSET + AMPLITUDE·tri(FREQUENCY·t + PHASE), tri(0) = 0 rising, tri(1/4) = 1, tri(3/4) = −1
#pragma once

#include "blocks/periodic.hpp"

namespace hysteron {

struct TriangleWave : Periodic {
  static constexpr About about{
      .name = "HY_TRIANGLE",
      .title = "Triangle reference",
      .group = Group::Control,
      .equation = "XOUT = OFFSET + AMPLITUDE·tri(FREQUENCY·t + PHASE), tri(p) = 4·|frac(p + 3/4) - 1/2| - 1",
      .meaning =
          "A triangle of constant rate 4·AMPLITUDE·FREQUENCY, the usual reference for measuring hysteresis. It begins "
          "at OFFSET, rising, as HY_SINE does, and its phase does not drift. A change of FREQUENCY while it runs goes "
          "on from the present phase."};

  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& state, const In<S>& in, const S& /*ts*/) {
    const S shifted = phase(params, state) + S(1.75);
    const S turn = shifted - to_real<S>(to_int(shifted));
    return shaped(params, in, S(4.0) * abs(turn - S(0.5)) - S(1.0));
  }
};

}  // namespace hysteron
