// HY_MEM: XOUT = M(p)·XIN, p' = g(XIN): the general MEM element
#pragma once

#include "blocks/mem_element.hpp"
#include "blocks/momentum.hpp"

namespace hysteron {

struct Mem {
  static constexpr About about{
      .name = "HY_MEM",
      .title = "MEM element",
      .group = Group::Memory,
      .equation = "XOUT = M(P)·XIN, P' = g(XIN), P = P0 where R1; M(P) = C1 + C2·P^C3; g(u) = |u| (G = 0) or u (G = 1)",
      .meaning =
          "An element whose gain depends on what has passed through it. G = 1 without resets: memristor (XIN "
          "current, XOUT voltage), memcapacitor, meminductor, MEM damper (XIN force, XOUT velocity). G = 0 with a "
          "reset at each branching point: the rates of a hysteresis. Its loop is pinched: XIN = 0 gives XOUT = 0. "
          "For P < 0 the power is continued oddly, so that M stays one-to-one: C3 = 1 is the straight line C1 + "
          "C2·P. Any other M or g: HY_MOMENTUM with HY_M_TABLE.",
      .delay = "P is the momentum at the start of the sampling interval (forward Euler).",
      .source = "Strijbosch and Oomen, equations (5), (6), Examples 2 and 3, Table I"};

  template <class S>
  struct Params {
    S C1;
    S C2;
    S C3;
    Int<S> G;
    using Self = Params;
    static constexpr auto fields() {
      return std::tuple{
          HY_FIELD(C1).in("'y/'x").above(0.0).otherwise(1.0).means("gain at momentum 0; above 0, so that an inverse "
                                                                   "exists there"),
          HY_FIELD(C2).in("'y/'x/('x*s)^C3").otherwise(0.0).means("growth of the gain"),
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
      return std::tuple{HY_FIELD(XIN).in("'x").means("input: current, force, or rate of a hysteresis' input"),
                        HY_FIELD(R1).otherwise(0.0).means("reset: the momentum begins anew at P0"),
                        HY_FIELD(P0).in("'x*s").otherwise(0.0).means("momentum after a reset")};
    }
  };
  template <class S>
  struct Out {
    S XOUT;
    S P;
    S M;
    using Self = Out;
    static constexpr auto fields() {
      return std::tuple{HY_FIELD(XOUT).in("'y").means("output: voltage, velocity, or rate of the output"),
                        HY_FIELD(P).in("'x*s").means("momentum at the start of the sampling interval"),
                        HY_FIELD(M).in("'y/'x").means("gain at this momentum")};
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
    const S gain = mem_slope(params.C1, params.C2, params.C3, p);  // (17)
    return {.XOUT = gain * in.XIN, .P = p, .M = gain};             // (5)
  }
  template <class S>
  static void update(const Params<S>& params, State<S>& state, const In<S>& in, const Out<S>& out, const S& ts) {
    Momentum::update<S>({.G = params.G}, state, momentum_input(in, in.XIN), {.XOUT = out.P}, ts);  // (6)
  }

  /// What the momentum inside sees: the resets, and the element's own input as its rate.
  template <class S>
  static Momentum::In<S> momentum_input(const In<S>& in, const S& rate) {
    return {.XIN = rate, .R1 = in.R1, .P0 = in.P0};
  }
};

}  // namespace hysteron
