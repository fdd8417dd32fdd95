// HY_PID: XOUT = KP·(E + ∫E dt/TR − TD·d(PV)/dt), E = SP − PV, between MN and MX
#pragma once

#include "blocks/ports.hpp"

namespace hysteron {

struct Pid {
  static constexpr About about{
      .name = "HY_PID",
      .title = "PID controller",
      .group = Group::Control,
      .equation =
          "XOUT = min(max(KP·E + I - KP·TD·R, MN), MX), E = SP - PV, I(k) = I(k-1) + KP·E·TS/TR, R = d(PV)/dt through "
          "a lag of TD/N",
      .meaning =
          "The standard's PID, with what a real loop needs. A positive KP belongs to a process that rises with XOUT: E "
          "is SP - PV, where the standard's text has PV - SP. The derivative acts on PV alone, so a jump of SP does "
          "not kick, and is filtered by a lag of TD/N. Anti-windup by clamping: the integral moves towards a bound "
          "only until the output reaches it, so the output leaves the bound in the step in which the error turns. "
          "While AUTO is FALSE the output is X0, within the bounds; the first automatic sample repeats the last manual "
          "one, whatever the error is. For the way back, wire X0 to the output through a delay. If AUTO is TRUE from "
          "the start, the integral starts at X0. A change of KP, TR, TD or N while running does not make the output "
          "jump.",
      .delay = "Backward Euler, as the standard's INTEGRAL: the present error counts at once; no delay.",
      .source = "IEC 61131-3, PID; K. J. Åström, T. Hägglund, PID Controllers, 1995, 3.2-3.6"};

  template <class S>
  struct Params {
    S KP;
    S TR;
    S TD;
    S N;
    S MN;
    S MX;
    using Self = Params;
    static constexpr auto fields() {
      constexpr double unbounded = std::numeric_limits<double>::infinity();
      return Fields{
          HY_FIELD(KP).in("'u/'e").otherwise(1.0).means("proportional gain"),
          HY_FIELD(TR).in("s").otherwise(unbounded).above(0.0).means(
              "reset time of the integral; infinite: no integral"),
          HY_FIELD(TD).in("s").otherwise(0.0).at_least(0.0).means("derivative time; 0: no derivative"),
          HY_FIELD(N).in("1").otherwise(10.0).above(0.0).means("derivative gain limit: the filter's time is TD/N"),
          HY_FIELD(MN).role(FieldRole::LowerBound).in("'u").otherwise(-unbounded).means("lower bound of the output"),
          HY_FIELD(MX).role(FieldRole::UpperBound).in("'u").otherwise(unbounded).means("upper bound of the output")};
    }
  };
  template <class S>
  struct State {
    S INTEGRAL;
    S RATE;
    S LAST_PV;
    S LAST_OUT;
    S LAST_KP;
    S LAST_KD;
    Bool<S> STARTED;
    Bool<S> LAST_AUTO;
    using Self = State;
    static constexpr auto fields() {
      return Fields{HY_FIELD(INTEGRAL).in("'u").otherwise(0.0).means("integral part of the output"),
                    HY_FIELD(RATE).in("'e/s").otherwise(0.0).means("filtered rate of PV"),
                    HY_FIELD(LAST_PV).in("'e").otherwise(0.0).means("PV of the step before"),
                    HY_FIELD(LAST_OUT).in("'u").otherwise(0.0).means("XOUT of the step before"),
                    HY_FIELD(LAST_KP).in("'u/'e").otherwise(0.0).means("KP of the step before"),
                    HY_FIELD(LAST_KD).in("'u*s/'e").otherwise(0.0).means("KP·TD of the step before"),
                    HY_FIELD(STARTED).otherwise(0.0).means("TRUE after the first step"),
                    HY_FIELD(LAST_AUTO).otherwise(0.0).means("AUTO of the step before")};
    }
  };
  template <class S>
  struct In {
    Bool<S> AUTO;
    S PV;
    S SP;
    S X0;
    using Self = In;
    static constexpr auto fields() {
      return Fields{HY_FIELD(AUTO).otherwise(1.0).means("TRUE: controls; FALSE: the output is X0"),
                    HY_FIELD(PV).in("'e").means("process value, measured"), HY_FIELD(SP).in("'e").means("set point"),
                    HY_FIELD(X0).in("'u").otherwise(0.0).means("manual output")};
    }
  };
  template <class S>
  struct Out {
    S XOUT;
    S E;
    Bool<S> QLOW;
    Bool<S> QHIGH;
    using Self = Out;
    static constexpr auto fields() {
      return Fields{HY_FIELD(XOUT).in("'u").means("controller output"),
                    HY_FIELD(E).in("'e").means("control error, SP - PV"),
                    HY_FIELD(QLOW).means("TRUE where XOUT is at MN or below"),
                    HY_FIELD(QHIGH).means("TRUE where XOUT is at MX or above")};
    }
  };

  template <class S>
  static State<S> initial(const Params<S>& params) {
    return {.INTEGRAL = S(0.0),
            .RATE = S(0.0),
            .LAST_PV = S(0.0),
            .LAST_OUT = S(0.0),
            .LAST_KP = params.KP,
            .LAST_KD = params.KP * params.TD,
            .STARTED = Bool<S>(false),
            .LAST_AUTO = Bool<S>(false)};
  }

  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& state, const In<S>& in, const S& ts) {
    const Parts<S> now = advance(params, state, in, ts);
    return {.XOUT = now.out, .E = now.error, .QLOW = now.out <= params.MN, .QHIGH = now.out >= params.MX};
  }
  template <class S>
  static void update(const Params<S>& params, State<S>& state, const In<S>& in, const Out<S>& out, const S& ts) {
    const Parts<S> now = advance(params, state, in, ts);
    state.INTEGRAL = now.integral;
    state.RATE = now.rate;
    state.LAST_PV = in.PV;
    state.LAST_OUT = out.XOUT;
    state.LAST_KP = params.KP;
    state.LAST_KD = params.KP * params.TD;
    state.STARTED = Bool<S>(true);
    state.LAST_AUTO = in.AUTO;
  }

 private:
  template <class S>
  struct Parts {
    S error;
    S rate;
    S integral;
    S out;
  };

  template <class S>
  static Parts<S> advance(const Params<S>& params, const State<S>& state, const In<S>& in, const S& ts) {
    const S error = in.SP - in.PV;

    // R(k) = (TF·R(k−1) + PV(k) − PV(k−1))/(TF + TS), TF = TD/N; no rate in the first step.
    const S filter_time = params.TD / params.N;
    const S change = select(state.STARTED, in.PV - state.LAST_PV, S(0.0));
    const S rate = (filter_time * state.RATE + change) / (filter_time + ts);
    const S kd = params.KP * params.TD;
    const S direct = params.KP * error - kd * rate;

    // Where KP or TD changed, the integral takes over what the other parts gave up.
    const S handed_over = (state.LAST_KP - params.KP) * error - (state.LAST_KD - kd) * rate;
    const S before = select(state.STARTED, state.INTEGRAL + handed_over, in.X0);

    // I(k) = I(k−1) + KP·E·TS/TR, but no further towards a bound than to where the output meets it.
    const S increment = params.KP * error * (ts / params.TR);
    const S whole = before + increment;
    const S up = max(before, min(whole, params.MX - direct));
    const S down = min(before, max(whole, params.MN - direct));
    const S controlled = select(increment > S(0.0), up, down);

    // In manual, and in the first automatic step after it, the integral is what makes the output what it was.
    const S manual = min(max(in.X0, params.MN), params.MX);
    const Bool<S> taken_over = in.AUTO && state.STARTED && !state.LAST_AUTO;
    const S integral = select(in.AUTO, select(taken_over, state.LAST_OUT - direct, controlled), manual - direct);
    const S automatic = min(max(direct + integral, params.MN), params.MX);
    return {.error = error, .rate = rate, .integral = integral, .out = select(in.AUTO, automatic, manual)};
  }
};

}  // namespace hysteron
