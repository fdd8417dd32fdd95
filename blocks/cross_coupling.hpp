// HY_CROSS_COUPLING: XOUT = XIN + GAIN·(Z − Z_REFERENCE) behind a lag T1
#pragma once

#include "blocks/effect_term.hpp"
#include "blocks/filtered_rate.hpp"
#include "blocks/ports.hpp"

namespace hysteron {

struct CrossCoupling {
  static constexpr About about{
      .name = "HY_CROSS_COUPLING",
      .title = "Cross coupling",
      .group = Group::Dynamics,
      .equation = "XOUT(k) = XIN(k) + GAIN·(z(k−1) − Z_REFERENCE), T1·z' + z = Z",
      .meaning =
          "What another axis, a temperature or any second signal Z adds, behind a first-order lag (ramp-invariant, as "
          "HY_LAG; T1 = 0 for none). Z is that of the step before, so that the block closes loops; in the first step "
          "nothing is added, and the lag starts as if the first Z had stood for ever.",
      .effect = "cross_coupling",
      .family = Family::Coupling};

  template <class S>
  struct Params {
    S GAIN;
    S T1;
    S Z_REFERENCE;
    using Self = Params;
    static constexpr auto fields() {
      return Fields{
          HY_FIELD(GAIN).in("'x/'z").otherwise(0.0).neutral_at(0.0).means("what a unit of Z adds"),
          HY_FIELD(T1).in("s").at_least(0.0).otherwise(0.0).means("time constant of the lag"),
          HY_FIELD(Z_REFERENCE).role(FieldRole::ReferenceSize).in("'z").otherwise(0.0).means("Z that adds nothing")};
    }
  };
  template <class S>
  struct State {
    S LAGGED;
    S Z1;
    S RATE1;
    Bool<S> STARTED;
    using Self = State;
    static constexpr auto fields() {
      return Fields{HY_FIELD(LAGGED).in("'z").otherwise(0.0).means("Z behind the lag, one step ago"),
                    HY_FIELD(Z1).in("'z").otherwise(0.0).means("Z one step ago"),
                    HY_FIELD(RATE1).in("'z/s").otherwise(0.0).means("rate of LAGGED"),
                    HY_FIELD(STARTED).otherwise(0.0).means("a sample has been seen")};
    }
  };
  template <class S>
  struct In {
    S XIN;
    S Z;
    using Self = In;
    static constexpr auto fields() {
      return Fields{HY_FIELD(XIN).in("'x").means("signal"),
                    HY_FIELD(Z).in("'z").otherwise(0.0).means("other signal; counts in the step after")};
    }
  };
  template <class S>
  using Out = Xout<S, "'x", "signal with what the other adds">;

  template <class S>
  using Coefficients = RateCoefficients<S>;

  template <class S>
  static Coefficients<S> coefficients(const Params<S>& params, const S& ts) {
    return {.forgotten = forgotten_part(params.T1, ts)};
  }
  template <class S>
  static State<S> initial(const Params<S>& params) {
    return {.LAGGED = params.Z_REFERENCE, .Z1 = S(0.0), .RATE1 = S(0.0), .STARTED = Bool<S>(false)};
  }
  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& state, const In<S>& in, const S& /*ts*/) {
    return {.XOUT = with_term<S>(in.XIN, params.GAIN * (state.LAGGED - params.Z_REFERENCE))};
  }
  template <class S>
  static void update(const Params<S>& params, State<S>& state, const In<S>& in, const Out<S>& out, const S& ts) {
    update(params, coefficients(params, ts), state, in, out, ts);
  }
  template <class S>
  static void update(const Params<S>& params, const Coefficients<S>& coefficients, State<S>& state, const In<S>& in,
                     const Out<S>& /*out*/, const S& ts) {
    const S slope = (in.Z - select(state.STARTED, state.Z1, in.Z)) / ts;
    const S rate = filtered_rate(state.RATE1, slope, coefficients.forgotten);
    state = {.LAGGED = in.Z - params.T1 * rate, .Z1 = in.Z, .RATE1 = rate, .STARTED = Bool<S>(true)};
  }
};

}  // namespace hysteron
