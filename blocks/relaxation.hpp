// HY_RELAXATION: XOUT = XIN + GAIN·(XIN behind a lag T1)
#pragma once

#include "blocks/effect_term.hpp"
#include "blocks/filtered_rate.hpp"

namespace hysteron {

struct Relaxation {
  static constexpr About about{
      .name = "HY_RELAXATION",
      .title = "Relaxation",
      .group = Group::Dynamics,
      .equation = "XOUT = XIN + GAIN·x, T1·x' + x = XIN; with SINCE_START x less what it is in the first step",
      .meaning =
          "After a step of s the output is s at once and approaches s·(1 + GAIN) with the time constant T1: s·(1 + "
          "GAIN·(1 − exp(−t/T1))). One exponential, of a viscoelastic mount or of an amplifier's thermal tail; "
          "HY_CREEP has all time scales. Exact for an input that runs straight between its samples.",

      .effect = "relaxation",
      .family = Family::SlowMemory,
      .simpler = "lag"};

  template <class S>
  struct Params {
    S GAIN;
    S T1;
    Bool<S> SETTLED;
    Bool<S> SINCE_START;
    using Self = Params;
    static constexpr auto fields() {
      return Fields{
          HY_FIELD(GAIN).in("1").otherwise(0.0).neutral_at(0.0).effect_within(-1.0, 1.0).means(
              "share of a step that follows slowly"),
          HY_FIELD(T1).in("s").at_least(0.0).otherwise(1.0).means("time constant"),
          HY_FIELD(SETTLED).otherwise(1.0).means("starts as if the first input had stood for ever; FALSE: as if 0 had"),
          HY_FIELD(SINCE_START)
              .otherwise(0.0)
              .either_way()
              .means("TRUE: what has followed before the first step is in XIN already, and XOUT starts as XIN")};
    }
  };
  template <class S>
  struct State : RateState<S, "rate of the lagged input one sample ago"> {
    S FIRST;
    using Self = State;
    static constexpr auto fields() {
      return concatenate(RateState<S, "rate of the lagged input one sample ago">::fields(),
                         Fields{HY_FIELD(FIRST).in("'x").otherwise(0.0).means("x in the first step")});
    }
  };
  template <class S>
  using In = Xin<S, "'x", "signal">;
  template <class S>
  using Out = Xout<S, "'x", "signal with what follows slowly">;

  template <class S>
  using Coefficients = RateCoefficients<S>;

  template <class S>
  static Coefficients<S> coefficients(const Params<S>& params, const S& ts) {
    return {.forgotten = forgotten_part(params.T1, ts)};
  }

  /// The rate of the lagged input at the present sample.
  template <class S>
  static S rate(const Params<S>& params, const Coefficients<S>& coefficients, const State<S>& state, const In<S>& in,
                const S& ts) {
    const S before = select(state.STARTED, state.X1, in.XIN);
    return started_rate<S>(
        {.start = !state.STARTED, .settled = params.SETTLED, .rate = state.RATE1, .slope = (in.XIN - before) / ts},
        in.XIN, params.T1, coefficients.forgotten);
  }

  template <class S>
  static State<S> initial(const Params<S>& /*params*/) {
    State<S> state{};
    state.X1 = S(0.0);
    state.RATE1 = S(0.0);
    state.STARTED = Bool<S>(false);
    state.FIRST = S(0.0);
    return state;
  }
  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& state, const In<S>& in, const S& ts) {
    return output(params, coefficients(params, ts), state, in, ts);
  }
  template <class S>
  static Out<S> output(const Params<S>& params, const Coefficients<S>& coefficients, const State<S>& state,
                       const In<S>& in, const S& ts) {
    const S lagged = in.XIN - params.T1 * rate(params, coefficients, state, in, ts);
    const S followed = since_start(params.SINCE_START, state, lagged);
    return {.XOUT = with_term<S>(in.XIN, params.GAIN * followed)};
  }
  template <class S>
  static void update(const Params<S>& params, State<S>& state, const In<S>& in, const Out<S>& out, const S& ts) {
    update(params, coefficients(params, ts), state, in, out, ts);
  }
  template <class S>
  static void update(const Params<S>& params, const Coefficients<S>& coefficients, State<S>& state, const In<S>& in,
                     const Out<S>& /*out*/, const S& ts) {
    const S now = rate(params, coefficients, state, in, ts);
    state.FIRST = select(state.STARTED, state.FIRST, in.XIN - params.T1 * now);
    state.RATE1 = now;
    state.X1 = in.XIN;
    state.STARTED = Bool<S>(true);
  }
};

}  // namespace hysteron
