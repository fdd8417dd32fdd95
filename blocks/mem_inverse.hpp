// HY_MEM_INVERSE: XOUT = XIN/M(p), p' = g(XOUT): the feedforward of a MEM element
#pragma once

#include "blocks/mem_element.hpp"
#include "blocks/momentum.hpp"

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
  struct Params {
    S C1;
    S C2;
    S C3;
    Int<S> G;
    using Self = Params;
    static constexpr auto fields() {
      return std::tuple{HY_FIELD(C1).in("'x/'y").above(0.0).otherwise(1.0).means("gain of the element at momentum 0"),
                        HY_FIELD(C2).in("'x/'y/('y*s)^C3").otherwise(0.0).means("growth of the gain"),
                        HY_FIELD(C3).in("1").within(0.0, 10.0).otherwise(1.0).means("exponent of the momentum"),
                        HY_FIELD(G).within(0.0, 1.0).otherwise(1.0).means("0: g(u) = |u|; 1: g(u) = u")};
    }
  };
  template <class S>
  using State = Momentum::State<S>;
  template <class S>
  struct In {
    S XIN;
    Bool<S> R1;
    S P0;
    using Self = In;
    static constexpr auto fields() {
      return std::tuple{HY_FIELD(XIN).in("'x").means("wanted output of the element"),
                        HY_FIELD(R1).otherwise(0.0).means("reset: the momentum begins anew at P0"),
                        HY_FIELD(P0).in("'y*s").otherwise(0.0).means("momentum after a reset")};
    }
  };
  template <class S>
  struct Out {
    S XOUT;
    S P;
    S M;
    Bool<S> ERROR;
    Word<S> ERRORID;
    using Self = Out;
    static constexpr auto fields() {
      return std::tuple{HY_FIELD(XOUT).in("'y").means("input for the element"),
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
    const CompensatedSum<S> momentum = Momentum::present(state, momentum_input(in, in.XIN));
    const S p = momentum.high;
    const InverseOfSlope<S> inverse = invert_slope(mem_slope(params.C1, params.C2, params.C3, p), in.XIN);  // (13)
    return {.XOUT = inverse.input, .P = p, .M = inverse.slope, .ERROR = inverse.failed, .ERRORID = inverse.reason};
  }
  template <class S>
  static void update(const Params<S>& params, State<S>& state, const In<S>& in, const Out<S>& out, const S& ts) {
    Momentum::update<S>({.G = params.G}, state, momentum_input(in, out.XOUT), {.XOUT = out.P}, ts);  // (14)
  }

  /// What the momentum inside sees: the resets, and the computed input of the element as its rate.
  template <class S>
  static Momentum::In<S> momentum_input(const In<S>& in, const S& rate) {
    return {.XIN = rate, .R1 = in.R1, .P0 = in.P0};
  }
};

}  // namespace hysteron
