// HY_CLOCK: XOUT(t) = XIN(t − SKEW·t − LOST·[t > T_LOST])
#pragma once

#include "blocks/clock_time.hpp"
#include "blocks/effect_term.hpp"
#include "blocks/past_signal.hpp"

namespace hysteron {

struct Clock : PastSignal {
  static constexpr About about{
      .name = "HY_CLOCK",
      .title = "Clock that runs slow or fast",
      .group = Group::Dynamics,
      .equation = "XOUT(t) = XIN(t − SKEW·t − LOST·[t > T_LOST]), straight between samples and ahead of the last one",
      .meaning =
          "What a record shows whose clock runs slower than the other signals' by SKEW, and which missed LOST seconds "
          "of samples at T_LOST: a delay that grows, and one that steps. t is 0 in the first step. A SKEW below 0 is a "
          "clock that runs fast: what is not there yet goes on at the rate of the last sample, which holds for a few "
          "samples of a smooth signal. The delay can be "
          "up to 1024 samples; where it would be longer it is held there, with ERROR. The step of the delay takes one "
          "sample, so that the result has a derivative by T_LOST.",
      .delay = "SKEW·t, and LOST more after T_LOST; the gain between samples as in HY_DEAD_TIME.",
      .effect = "clock",
      .family = Family::Logging,
      .of_record = true};

  template <class S>
  struct Params {
    S SKEW;
    S LOST;
    S T_LOST;
    using Self = Params;
    static constexpr auto fields() {
      return Fields{HY_FIELD(SKEW).in("1").otherwise(0.0).neutral_at(0.0).effect_within(-0.1, 0.1).means(
                        "seconds lost per second, or won"),
                    HY_FIELD(LOST).in("s").at_least(0.0).otherwise(0.0).neutral_at(0.0).means("seconds lost at once"),
                    HY_FIELD(T_LOST)
                        .role(FieldRole::Instant)
                        .in("s")
                        .at_least(0.0)
                        .otherwise(0.0)
                        .means("time at which they are lost")};
    }
  };
  template <class S>
  struct State {
    Array<S, capacity> PAST;
    Int<S> HEAD;
    Int<S> HELD;
    S BEFORE;
    Bool<S> STARTED;
    Int<S> COUNT;
    using Self = State;
    static constexpr auto fields() {
      return Fields{HY_FIELD(PAST).role(FieldRole::PastInputs).in("'x").otherwise(0.0).means("past samples, in a ring"),
                    HY_FIELD(HEAD).otherwise(0.0).means("place of the next sample in the ring"),
                    HY_FIELD(HELD).otherwise(0.0).means("number of past samples that count"),
                    HY_FIELD(BEFORE).in("'x").otherwise(0.0).means("signal before those"),
                    HY_FIELD(STARTED).otherwise(0.0).means("a sample has been seen"),
                    HY_FIELD(COUNT).otherwise(0.0).means("steps since the start; the first step has 0")};
    }
  };
  template <class S>
  using In = Xin<S, "'x", "signal">;

  template <class S>
  static View<S> view(const State<S>& state, const In<S>& in) {
    return {.present = in.XIN, .earlier = select(state.STARTED, state.BEFORE, in.XIN), .count = state.HELD};
  }

  template <class S>
  static State<S> initial(const Params<S>& /*params*/) {
    State<S> state{};
    forget(state);
    state.COUNT = Int<S>(0);
    return state;
  }
  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& state, const In<S>& in, const S& ts) {
    const S time = to_real<S>(state.COUNT) * ts;
    const S behind = params.SKEW * time + params.LOST * passed_part(time, params.T_LOST, ts);
    Out<S> out = ago<S>(state, view(state, in), max(behind / ts, S(0.0)));
    // In this order: where SKEW is 0, ago has the derivative of either side, and this term none.
    const S ahead = max(S(0.0), S(0.0) - behind / ts);
    out.XOUT = with_term<S>(out.XOUT, ahead * (in.XIN - last(state, view(state, in))));
    return out;
  }
  template <class S>
  static void update(const Params<S>& /*params*/, State<S>& state, const In<S>& in, const Out<S>& /*out*/,
                     const S& /*ts*/) {
    keep<S>(state, view(state, in));
    state.COUNT = one_more(state.COUNT);
  }
};

}  // namespace hysteron
