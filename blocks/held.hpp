// HY_HELD: XOUT(t) = XIN(τ), τ the last of the times (n − PHASE)·PERIOD
#pragma once

#include "blocks/clock_time.hpp"
#include "blocks/effect_term.hpp"
#include "blocks/ports.hpp"

namespace hysteron {

struct Held {
  static constexpr About about{
      .name = "HY_HELD",
      .title = "Values held by a slower task",
      .group = Group::Dynamics,
      .equation =
          "XOUT(t) = XIN(τ), τ = (n − PHASE)·PERIOD the last such time up to t, 0 before the first; XIN straight "
          "between its samples",
      .meaning =
          "What passes through a task that runs once a PERIOD: it takes a value and holds it until the next. PERIOD "
          "need not be a whole number of samples; the age of the values then beats with the sampling. PHASE is the age "
          "of the first value in periods: the task next runs (1 - PHASE)*PERIOD after the first step, which passes as "
          "it is. t is 0 in the first step. A PERIOD of 0 passes every value.",
      .delay = "PERIOD/2 in the mean; gain sin(ωPERIOD/2)/(ωPERIOD/2) at frequencies below the images.",
      .source = "zero-order hold; K. J. Åström and B. Wittenmark, Computer-Controlled Systems, 3rd ed.",
      .effect = "held_values",
      .family = Family::Logging,
      .untried = "repeats in a record are counted before any effect is tried",
      .of_record = true};

  template <class S>
  struct Params {
    S PERIOD;
    S PHASE;
    using Self = Params;
    static constexpr auto fields() {
      return Fields{
          HY_FIELD(PERIOD).in("s").at_least(0.0).otherwise(0.0).neutral_at(0.0).means(
              "time from one value to the next"),
          HY_FIELD(PHASE).in("1").within(0.0, 1.0).otherwise(0.0).means("age of the first value, in periods")};
    }
  };
  template <class S>
  struct State {
    Int<S> COUNT;
    Int<S> TURN;
    S X1;
    S LAST;
    using Self = State;
    static constexpr auto fields() {
      return Fields{HY_FIELD(COUNT).otherwise(0.0).means("steps since the start; the first step has 0"),
                    HY_FIELD(TURN).otherwise(0.0).means("runs of the task since the start"),
                    HY_FIELD(X1).role(FieldRole::PastInput).in("'x").otherwise(0.0).means("input one sample ago"),
                    HY_FIELD(LAST).in("'x").otherwise(0.0).means("value that is held")};
    }
  };
  template <class S>
  using In = Xin<S, "'x", "signal">;
  template <class S>
  using Out = Xout<S, "'x", "signal that the slower task gives">;

  template <class S>
  static State<S> initial(const Params<S>& /*params*/) {
    return {.COUNT = Int<S>(0), .TURN = Int<S>(0), .X1 = S(0.0), .LAST = S(0.0)};
  }
  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& state, const In<S>& in, const S& ts) {
    return {.XOUT = now(params, state, in, ts).value};
  }
  template <class S>
  static void update(const Params<S>& params, State<S>& state, const In<S>& in, const Out<S>& /*out*/, const S& ts) {
    const Now<S> next = now(params, state, in, ts);
    state = {.COUNT = one_more(state.COUNT), .TURN = next.turn, .X1 = in.XIN, .LAST = next.value};
  }

 private:
  template <class S>
  struct Now {
    S value;
    Int<S> turn;
  };
  template <class S>
  static Now<S> now(const Params<S>& params, const State<S>& state, const In<S>& in, const S& ts) {
    // A run that falls on a sample counts there, although the quotient is rounded.
    constexpr double rounded = 1e-6;
    const Bool<S> holds = params.PERIOD > S(0.0);
    const S period = select(holds, params.PERIOD, ts);
    const S time = to_real<S>(state.COUNT) * ts;
    const Int<S> turn = to_int(time / period + params.PHASE + S(rounded));
    const Bool<S> first = state.COUNT < Int<S>(1);
    const S age = max(time - (to_real<S>(turn) - params.PHASE) * period, S(0.0));
    const S part = min(age / ts, S(1.0));
    const S taken = select(holds, with_term<S>(in.XIN, part * (state.X1 - in.XIN)), in.XIN);
    const S passed = select(first, in.XIN, taken);
    return {.value = select(first || turn > state.TURN || !holds, passed, state.LAST), .turn = turn};
  }
};

}  // namespace hysteron
