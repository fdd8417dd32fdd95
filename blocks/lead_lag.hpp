// HY_LEAD_LAG: XOUT = (1 + T1·s)/(1 + T2·s)·XIN
#pragma once

#include "blocks/filtered_rate.hpp"

namespace hysteron {

struct LeadLag {
  static constexpr About about{
      .name = "HY_LEAD_LAG",
      .title = "Lead-lag",
      .group = Group::Dynamics,
      .equation = "T2·XOUT' + XOUT = T1·XIN' + XIN",
      .meaning =
          "Lead T1 over lag T2, exact at the samples for an input that runs straight between them (ramp-invariant). "
          "T1 = T2 passes the input through; T2 = 0 is a pure lead, XIN + T1·XIN', with the two-point derivative. "
          "The first sample, and R1, settle it: XOUT = XIN.",
      .delay = "T2 − T1 at low frequency; high frequencies are raised by T1/T2.",
      .source = "ramp-invariant discretisation; K. J. Åström and B. Wittenmark, Computer-Controlled Systems, 3rd ed."};

  template <class S>
  struct Params {
    S T1;
    S T2;
    using Self = Params;
    static constexpr auto fields() {
      return Fields{HY_FIELD(T1).in("s").at_least(0.0).otherwise(0.0).means("lead time constant"),
                    HY_FIELD(T2).in("s").at_least(0.0).otherwise(0.0).means("lag time constant")};
    }
  };
  template <class S>
  using State = RateState<S, "filtered rate one sample ago">;
  template <class S>
  struct In {
    S XIN;
    Bool<S> R1;
    using Self = In;
    static constexpr auto fields() {
      return Fields{HY_FIELD(XIN).in("'x").means("signal"),
                    HY_FIELD(R1).otherwise(0.0).means("reset: settles at the present input")};
    }
  };
  template <class S>
  struct Out {
    S XOUT;
    S RATE;
    using Self = Out;
    static constexpr auto fields() {
      return Fields{HY_FIELD(XOUT).in("'x").means("signal with lead and lag"),
                    HY_FIELD(RATE).role(FieldRole::Rate).in("'x/s").means("rate of the input behind the lag T2")};
    }
  };

  template <class S>
  using Coefficients = RateCoefficients<S>;

  template <class S>
  static Coefficients<S> coefficients(const Params<S>& params, const S& ts) {
    return {.forgotten = forgotten_part(params.T2, ts)};
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
    const Bool<S> settle = in.R1 || !state.STARTED;
    const S going_on = filtered_rate(state.RATE1, (in.XIN - state.X1) / ts, coefficients.forgotten);
    const S rate = select(settle, S(0.0), going_on);
    return {.XOUT = in.XIN + (params.T1 - params.T2) * rate, .RATE = rate};
  }
  template <class S>
  static void update(const Params<S>& /*params*/, State<S>& state, const In<S>& in, const Out<S>& out,
                     const S& /*ts*/) {
    state = {.X1 = in.XIN, .RATE1 = out.RATE, .STARTED = Bool<S>(true)};
  }
};

}  // namespace hysteron
