// HY_INTEGRAL: XOUT(k) = XOUT(k−1) + TS·XIN(k), with a compensated sum
#pragma once

#include "blocks/compensated_sum.hpp"

namespace hysteron {

struct Integral {
  static constexpr About about{
      .name = "HY_INTEGRAL",
      .title = "Integral",
      .group = Group::Dynamics,
      .equation = "XOUT(k) = X0 where R1; else XOUT(k−1) + TS·XIN(k) where RUN; else XOUT(k−1)",
      .meaning =
          "Integral by the backward Euler rule, as the standard's INTEGRAL: the present input counts at once. The "
          "sum is compensated (Kahan), so that small increments are not lost: a plain REAL sum of 1 over 100 s at 50 "
          "µs gives 101.97. RUN FALSE holds the value; R1 dominates and loads X0. Starts at 0. Where it must close a "
          "loop, use HY_INTEGRAL_FORWARD.",
      .delay = "Ideal integral times (ωTS/2)/sin(ωTS/2), ahead by half a sample.",
      .source = "IEC 61131-3, INTEGRAL; W. Kahan, CACM 8 (1965) 40"};

  template <class S>
  using Params = NoFields<S>;

  template <class S>
  using State = SumState<S, "'x*s", "running sum">;
  template <class S>
  struct In {
    S XIN;
    Bool<S> RUN;
    Bool<S> R1;
    S X0;
    using Self = In;
    static constexpr auto fields() {
      return Fields{
          HY_FIELD(XIN).in("'x").means("signal to be integrated"),
          HY_FIELD(RUN).otherwise(1.0).means("integrates while TRUE, holds while FALSE"),
          HY_FIELD(R1).otherwise(0.0).means("reset, dominant: loads X0"),
          HY_FIELD(X0).role(FieldRole::StartValue).in("'x*s").otherwise(0.0).means("value that a reset loads")};
    }
  };
  template <class S>
  struct Out {
    S XOUT;
    Bool<S> Q;
    using Self = Out;
    static constexpr auto fields() {
      return Fields{HY_FIELD(XOUT).in("'x*s").means("integral"), HY_FIELD(Q).means("NOT R1")};
    }
  };

  /// The sum after the present input.
  template <class S>
  static CompensatedSum<S> advance(const State<S>& state, const In<S>& in, const S& ts) {
    const S increment = select(in.RUN, in.XIN * ts, S(0.0));
    const CompensatedSum<S> sum = add(state.sum(), increment);
    return select_sum<S>(in.R1, {.high = in.X0, .low = S(0.0)}, sum);
  }

  template <class S>
  static State<S> initial(const Params<S>& /*params*/) {
    return {.SUM = S(0.0), .LOST = S(0.0)};
  }
  template <class S>
  static Out<S> output(const Params<S>& /*params*/, const State<S>& state, const In<S>& in, const S& ts) {
    const CompensatedSum<S> next = advance(state, in, ts);
    return {.XOUT = next.high, .Q = !in.R1};
  }
  template <class S>
  static void update(const Params<S>& /*params*/, State<S>& state, const In<S>& in, const Out<S>& /*out*/,
                     const S& ts) {
    state = State<S>::of(advance(state, in, ts));
  }
};

}  // namespace hysteron
