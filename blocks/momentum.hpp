// HY_MOMENTUM: p' = g(u), p = P0 at a reset
#pragma once

#include "blocks/compensated_sum.hpp"
#include "blocks/mem_element.hpp"

namespace hysteron {

struct Momentum {
  static constexpr About about{
      .name = "HY_MOMENTUM",
      .title = "Momentum",
      .group = Group::Memory,
      .equation = "XOUT(k+1) = XOUT(k) + TS·g(XIN(k)), where R1: P0 + TS·g(XIN(k)); g(u) = |u| (G = 0) or u (G = 1)",
      .meaning =
          "How far the input has travelled since the last reset. XIN is the rate of the input, R1 the branching "
          "point. XOUT is the momentum at the start of the sampling interval and depends on the state alone, so that "
          "XIN may be computed from it: the loop of HY_M_INVERSE and HY_MOMENTUM closes without a delay block. The "
          "interval in which R1 is TRUE is the first of the new branch; HY_M and HY_M_INVERSE take the same R1 and "
          "count P as 0 in it. The sum is compensated. Starts at 0.",
      .delay = "Forward Euler: the integral up to the start of the interval.",
      .source = "Strijbosch and Oomen, equations (6) and (11)"};

  template <class S>
  struct Params {
    Int<S> G;
    using Self = Params;
    static constexpr auto fields() {
      return Fields{HY_FIELD(G).within(0.0, 1.0).otherwise(0.0).means(
          "0: g(u) = |u|, momentum of a hysteresis; 1: g(u) = u, charge, flux or impulse of a MEM element")};
    }
  };
  template <class S>
  using State = SumState<S, "'x*s", "momentum">;
  template <class S>
  struct In {
    S XIN;
    Bool<S> R1;
    S P0;
    using Self = In;
    static constexpr auto fields() {
      return Fields{HY_FIELD(XIN).in("'x").means("rate of the input"),
                    HY_FIELD(R1).otherwise(0.0).means("branching point: the momentum begins anew at P0"),
                    HY_FIELD(P0).role(FieldRole::StartValue).in("'x*s").otherwise(0.0).means("momentum after a reset")};
    }
  };
  template <class S>
  struct Out {
    S XOUT;
    using Self = Out;
    static constexpr auto fields() {
      return Fields{HY_FIELD(XOUT).in("'x*s").means("momentum at the start of the sampling interval")};
    }
  };

  /// The momentum at the start of the interval, after a reset if there is one.
  template <class S>
  static CompensatedSum<S> present(const State<S>& state, const In<S>& in) {
    return select_sum<S>(in.R1, {.high = in.P0, .low = S(0.0)}, state.sum());
  }

  template <class S>
  static State<S> initial(const Params<S>& /*params*/) {
    return {.SUM = S(0.0), .LOST = S(0.0)};
  }
  template <class S>
  static Out<S> output(const Params<S>& /*params*/, const State<S>& state, const In<S>& /*in*/, const S& /*ts*/) {
    return {.XOUT = state.SUM};
  }
  template <class S>
  static void update(const Params<S>& params, State<S>& state, const In<S>& in, const Out<S>& /*out*/, const S& ts) {
    const CompensatedSum<S> next = add<S>(present(state, in), momentum_rate<S>(params.G, in.XIN) * ts);  // (11)
    state = State<S>::of(next);
  }
};

}  // namespace hysteron
