// HY_MEM_INVERSE: XOUT = XIN/M(p), p' = g(XOUT): the feedforward of a MEM element
#pragma once

#include "blocks/mem_pins.hpp"

namespace hysteron {

struct MemInverse {
  static constexpr About about{
      .name = "HY_MEM_INVERSE",
      .title = "Inverse of the MEM element",
      .group = Group::Memory,
      .equation =
          "XOUT = XIN/M(P), P' = g(XOUT), P = P0 where R1; M(P) = C1 + C2·P^C3; g(u) = |u| (G = 0) or u (G = 1)",
      .meaning =
          "The input that makes HY_MEM of the same parameters and resets follow XIN, sample by sample. Where M(P) is "
          "not above 0 there is no inverse: ERROR is TRUE and XOUT is 0, so that a momentum with g(u) stays where it "
          "is until a reset.",
      .delay = "P is the momentum at the start of the sampling interval (forward Euler).",
      .source = "Strijbosch and Oomen, Theorem 6, equations (13) and (14)"};

  template <class S>
  using Params = MemParams<S, "'y", "'x", "gain of the element at momentum 0">;
  template <class S>
  using State = Momentum::State<S>;
  template <class S>
  using In = MemIn<S, "'y", "wanted output of the element">;
  template <class S>
  struct Out {
    S XOUT;
    S P;
    S M;
    Bool<S> ERROR;
    Word<S> ERRORID;
    using Self = Out;
    static constexpr auto fields() {
      return Fields{HY_FIELD(XOUT).in("'y").means("input for the element"),
                    HY_FIELD(P).in("'y*s").means("momentum at the start of the sampling interval"),
                    HY_FIELD(M).in("'x/'y").means("gain of the element at this momentum"),
                    HY_FIELD(ERROR).means("the gain is not above 0"),
                    HY_FIELD(ERRORID).means("0 no error, 4 gain not above 0")};
    }
  };

  template <class S>
  static State<S> initial(const Params<S>& /*params*/) {
    return {.SUM = S(0.0), .LOST = S(0.0)};
  }
  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& state, const In<S>& in, const S& /*ts*/) {
    const CompensatedSum<S> momentum = Momentum::present(state, in.of_momentum(in.XIN));
    const S p = momentum.high;
    const InverseOfSlope<S> inverse = invert_slope(mem_slope(params.C1, params.C2, params.C3, p), in.XIN);  // (13)
    return {.XOUT = inverse.input, .P = p, .M = inverse.slope, .ERROR = inverse.failed, .ERRORID = inverse.reason};
  }
  template <class S>
  static void update(const Params<S>& params, State<S>& state, const In<S>& in, const Out<S>& out, const S& ts) {
    Momentum::update<S>({.G = params.G}, state, in.of_momentum(out.XOUT), {.XOUT = out.P}, ts);  // (14)
  }
};

}  // namespace hysteron
