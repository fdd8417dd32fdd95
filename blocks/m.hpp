// HY_M: XOUT = M(P)·XIN, M(P) = C1 + C2·P^C3
#pragma once

#include "blocks/mem_element.hpp"

namespace hysteron {

struct SlopeM {
  static constexpr About about{
      .name = "HY_M",
      .title = "Slope by momentum",
      .group = Group::Memory,
      .equation = "XOUT = M(P)·XIN, M(P) = C1 + C2·P^C3; for P < 0, M(P) = C1 − C2·|P|^C3",
      .meaning =
          "The memory function of a MEM element: the slope of a hysteresis loop after the input has travelled P "
          "since the last branching point. XIN is the rate of the input and XOUT the rate of the output. From the "
          "Ramberg-Osgood constants y*, u*, α, γ: C1 = y*/u*, C2 = C1·α·γ/(2u*)^(γ−1), C3 = γ − 1.",
      .source = "Strijbosch and Oomen, equations (5) and (17)"};

  template <class S>
  using Params = MemSlopeParams<S>;
  template <class S>
  using State = NoFields<S>;
  template <class S>
  using In = SlopeIn<S, "'u", "rate of the input">;
  template <class S>
  struct Out {
    S XOUT;
    S M;
    using Self = Out;
    static constexpr auto fields() {
      return Fields{HY_FIELD(XOUT).in("'y").means("rate of the output"),
                    HY_FIELD(M).in("'y/'u").means("slope at this momentum")};
    }
  };

  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& /*state*/, const In<S>& in, const S& /*ts*/) {
    const S slope = mem_slope(params.C1, params.C2, params.C3, in.momentum());  // (17)
    return {.XOUT = slope * in.XIN, .M = slope};                                // (5)
  }
};

}  // namespace hysteron
