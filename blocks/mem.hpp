// HY_MEM: XOUT = M(p)·XIN, p' = g(XIN): the general MEM element
#pragma once

#include "blocks/mem_pins.hpp"

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
  using Params = MemParams<S, "'x", "'y", "gain at momentum 0; above 0, so that an inverse exists there">;
  template <class S>
  using State = Momentum::State<S>;
  template <class S>
  using In = MemIn<S, "'x", "input: current, force, or rate of a hysteresis' input">;
  template <class S>
  struct Out {
    S XOUT;
    S P;
    S M;
    using Self = Out;
    static constexpr auto fields() {
      return Fields{HY_FIELD(XOUT).in("'y").means("output: voltage, velocity, or rate of the output"),
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
    const CompensatedSum<S> momentum = Momentum::present(state, in.of_momentum(in.XIN));
    const S p = momentum.high;
    const S gain = mem_slope(params.C1, params.C2, params.C3, p);  // (17)
    return {.XOUT = gain * in.XIN, .P = p, .M = gain};             // (5)
  }
  template <class S>
  static void update(const Params<S>& params, State<S>& state, const In<S>& in, const Out<S>& out, const S& ts) {
    Momentum::update<S>({.G = params.G}, state, in.of_momentum(in.XIN), {.XOUT = out.P}, ts);  // (6)
  }
};

}  // namespace hysteron
