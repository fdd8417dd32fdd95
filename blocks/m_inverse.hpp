// HY_M_INVERSE: XOUT = XIN/M(P), M(P) = C1 + C2·P^C3
#pragma once

#include "blocks/mem_element.hpp"

namespace hysteron {

struct SlopeMInverse {
  static constexpr About about{
      .name = "HY_M_INVERSE",
      .title = "Inverse of the slope by momentum",
      .group = Group::Memory,
      .equation = "XOUT = XIN/M(P), M(P) = C1 + C2·P^C3; 0 where M(P) is not above 0",
      .meaning =
          "The rate of the input that gives a wanted rate of the output: the heart of the feedforward. Where M(P) is "
          "0, negative or not a number (C2 < 0 and P too large), there is no inverse: ERROR is TRUE and XOUT is 0.",
      .source = "Strijbosch and Oomen, equations (13) and (15)"};

  template <class S>
  using Params = MemSlopeParams<S>;
  template <class S>
  using State = NoFields<S>;
  template <class S>
  using In = SlopeIn<S, "'y", "wanted rate of the output">;
  template <class S>
  using Out =
      CheckedSlopeOut<S, "'u", "rate of the input", "the slope is not above 0", "0 no error, 4 slope not above 0">;

  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& /*state*/, const In<S>& in, const S& /*ts*/) {
    const InverseOfSlope<S> inverse =
        invert_slope(mem_slope(params.C1, params.C2, params.C3, in.momentum()), in.XIN);  // (15)
    return {.XOUT = inverse.input, .M = inverse.slope, .ERROR = inverse.failed, .ERRORID = inverse.reason};
  }
};

}  // namespace hysteron
