// HY_LAG: T1·XOUT' + XOUT = XIN
#pragma once

#include "blocks/filtered_rate.hpp"

namespace hysteron {

struct Lag {
  static constexpr About about{
      .name = "HY_LAG",
      .title = "First-order lag",
      .group = Group::Dynamics,
      .equation = "T1·XOUT' + XOUT = XIN",
      .meaning =
          "First-order lag, exact at the samples for an input that runs straight between them (ramp-invariant); T1 = "
          "0 passes the input through. It starts as if the first input had stood for ever, so that a record which "
          "begins away from 0 gives no transient; with SETTLED FALSE it starts at X0, as a plant at rest does. R1 "
          "loads X0. A rate below 1e-36 counts as 0, so that no denormal numbers arise. XOUT depends on the present "
          "input: to close a loop, put HY_DELAY in it.",
      .delay = "T1 at low frequency; gain 1/√(1 + (ωT1)²) up to factors (sin(ωTS/2)/(ωTS/2))² of the straight line.",
      .source = "ramp-invariant discretisation; K. J. Åström and B. Wittenmark, Computer-Controlled Systems, 3rd ed.",
      .effect = "lag",
      .family = Family::LinearDynamics};

  template <class S>
  struct Params {
    S T1;
    Bool<S> SETTLED;
    using Self = Params;
    static constexpr auto fields() {
      return Fields{
          HY_FIELD(T1).in("s").at_least(0.0).otherwise(0.0).neutral_at(0.0).means("time constant"),
          HY_FIELD(SETTLED).otherwise(1.0).means("starts as if the first input had stood for ever; FALSE: at X0")};
    }
  };
  template <class S>
  using State = RateState<S, "rate of the output one sample ago">;
  template <class S>
  struct In {
    S XIN;
    Bool<S> R1;
    S X0;
    using Self = In;
    static constexpr auto fields() {
      return Fields{HY_FIELD(XIN).in("'x").means("signal"), HY_FIELD(R1).otherwise(0.0).means("reset: loads X0"),
                    HY_FIELD(X0)
                        .role(FieldRole::StartValue)
                        .in("'x")
                        .otherwise(0.0)
                        .means("output at a reset, and at the start if not SETTLED")};
    }
  };
  template <class S>
  struct Out {
    S XOUT;
    S RATE;
    using Self = Out;
    static constexpr auto fields() {
      return Fields{HY_FIELD(XOUT).in("'x").means("lagged signal"),
                    HY_FIELD(RATE).role(FieldRole::Rate).in("'x/s").means("its rate of change, (XIN - XOUT)/T1")};
    }
  };

  template <class S>
  using Coefficients = RateCoefficients<S>;

  template <class S>
  static Coefficients<S> coefficients(const Params<S>& params, const S& ts) {
    return {.forgotten = forgotten_part(params.T1, ts)};
  }
  template <class S>
  static State<S> initial(const Params<S>& /*params*/) {
    return {.X1 = S(0.0), .RATE1 = S(0.0), .STARTED = Bool<S>(false)};
  }
  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& state, const In<S>& in, const S& ts) {
    return output(params, coefficients(params, ts), state, in, ts);
  }
  template <class S>
  static Out<S> output(const Params<S>& params, const Coefficients<S>& coefficients, const State<S>& state,
                       const In<S>& in, const S& ts) {
    const Bool<S> load = in.R1 || (!state.STARTED && !params.SETTLED);
    const Bool<S> lags = params.T1 > S(0.0);
    const S before = select(state.STARTED, state.X1, in.XIN);
    const S rate = either<S>(
        load, [&] { return select(lags, (in.XIN - in.X0) / select(lags, params.T1, S(1.0)), S(0.0)); },
        [&] { return filtered_rate(state.RATE1, (in.XIN - before) / ts, coefficients.forgotten); });
    return {.XOUT = select(load, in.X0, in.XIN - params.T1 * rate), .RATE = rate};
  }
  template <class S>
  static void update(const Params<S>& /*params*/, State<S>& state, const In<S>& in, const Out<S>& out,
                     const S& /*ts*/) {
    state = {.X1 = in.XIN, .RATE1 = out.RATE, .STARTED = Bool<S>(true)};
  }
};

}  // namespace hysteron
