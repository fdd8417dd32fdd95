// HY_DERIVATIVE_FILTERED: XOUT = s/(1 + T1·s)·XIN
#pragma once

#include "blocks/derivative.hpp"
#include "blocks/filtered_rate.hpp"

namespace hysteron {

struct DerivativeFiltered {
  static constexpr About about{
      .name = "HY_DERIVATIVE_FILTERED",
      .title = "Derivative behind a first-order filter",
      .group = Group::Dynamics,
      .equation = "XOUT(k) = a·XOUT(k−1) + (1 − a)·(XIN(k) − XIN(k−1))/TS, a = exp(−TS/T1), where RUN; else 0",
      .meaning =
          "Rate of change of a noisy signal: s/(1 + T1·s), exact for a signal that runs straight between its "
          "samples. T1 = 0 is HY_DERIVATIVE. In the first sample there is no history and XOUT is 0; RUN FALSE gives "
          "0, from which the filter starts again.",
      .delay =
          "At low frequency 0.5 samples + a/(1 − a) samples, together T1 + TS²/(12·T1) for T1 above TS; gain "
          "sin(w/2)/(w/2)·(1 − a)/√(1 − 2a·cos(w) + a²) times the ideal ω at w = ωTS.",
      .source = "ramp-invariant discretisation; K. J. Åström and B. Wittenmark, Computer-Controlled Systems, 3rd ed."};

  template <class S>
  struct Params {
    S T1;
    using Self = Params;
    static constexpr auto fields() {
      return Fields{HY_FIELD(T1).in("s").at_least(0.0).otherwise(0.0).means("time constant of the filter")};
    }
  };
  template <class S>
  struct State {
    S X1;
    S RATE;
    Bool<S> STARTED;
    using Self = State;
    static constexpr auto fields() {
      return Fields{HY_FIELD(X1).in("'x").otherwise(0.0).means("signal one sample ago"),
                    HY_FIELD(RATE).in("'x/s").otherwise(0.0).means("output one sample ago"),
                    HY_FIELD(STARTED).otherwise(0.0).means("a sample has been seen")};
    }
  };
  template <class S>
  using In = Derivative::In<S>;
  template <class S>
  using Out = Derivative::Out<S>;

  template <class S>
  using Coefficients = RateCoefficients<S>;

  template <class S>
  static Coefficients<S> coefficients(const Params<S>& params, const S& ts) {
    return {.forgotten = forgotten_part(params.T1, ts)};
  }
  template <class S>
  static State<S> initial(const Params<S>& /*params*/) {
    return {.X1 = S(0.0), .RATE = S(0.0), .STARTED = Bool<S>(false)};
  }
  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& state, const In<S>& in, const S& ts) {
    return output(params, coefficients(params, ts), state, in, ts);
  }
  template <class S>
  static Out<S> output(const Params<S>& /*params*/, const Coefficients<S>& coefficients, const State<S>& state,
                       const In<S>& in, const S& ts) {
    const S rate = filtered_rate(state.RATE, (in.XIN - state.X1) / ts, coefficients.forgotten);
    return {.XOUT = select(in.RUN && state.STARTED, rate, S(0.0))};
  }
  template <class S>
  static void update(const Params<S>& /*params*/, State<S>& state, const In<S>& in, const Out<S>& out,
                     const S& /*ts*/) {
    state = {.X1 = in.XIN, .RATE = out.XOUT, .STARTED = Bool<S>(true)};
  }
};

}  // namespace hysteron
