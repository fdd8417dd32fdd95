// HY_DEAD_TIME: XOUT(t) = XIN(t − DEAD_TIME)
#pragma once

#include "blocks/past_signal.hpp"

namespace hysteron {

struct DeadTime : PastSignal {
  static constexpr About about{
      .name = "HY_DEAD_TIME",
      .title = "Dead time",
      .group = Group::Dynamics,
      .equation = "XOUT(t) = XIN(t − DEAD_TIME), straight between samples",
      .meaning =
          "Transport delay of any length up to 1024 samples, whole or not. Before the first sample the signal is "
          "taken to have stood at its first value (SETTLED) or at X0. R1 empties the delay: all that came before the "
          "present sample is then X0. A longer dead time is held at 1024 samples, with ERROR.",
      .delay =
          "DEAD_TIME; between samples, at the fraction f, the gain falls to |1 − f + f·exp(−jw)|: at the worst, f = "
          "½, cos(w/2) at w = ωTS.",
      .source = "linear interpolation of the sampled signal",
      .effect = "delay",
      .family = Family::LinearDynamics};

  template <class S>
  struct Params {
    S DEAD_TIME;
    Bool<S> SETTLED;
    S X0;
    using Self = Params;
    static constexpr auto fields() {
      return Fields{HY_FIELD(DEAD_TIME)
                        .role(FieldRole::DeadTime)
                        .in("s")
                        .at_least(0.0)
                        .otherwise(0.0)
                        .neutral_at(0.0)
                        .means("dead time"),
                    HY_FIELD(SETTLED).otherwise(1.0).means(
                        "starts as if the first input had stood for ever; FALSE: as if X0 had"),
                    HY_FIELD(X0)
                        .role(FieldRole::StartValue)
                        .in("'x")
                        .otherwise(0.0)
                        .means("signal before a reset, and before the start if not SETTLED")};
    }
  };
  template <class S>
  struct State {
    Array<S, capacity> PAST;
    Int<S> HEAD;
    Int<S> HELD;
    S BEFORE;
    Bool<S> STARTED;
    using Self = State;
    static constexpr auto fields() {
      return Fields{HY_FIELD(PAST).role(FieldRole::PastInputs).in("'x").otherwise(0.0).means("past samples, in a ring"),
                    HY_FIELD(HEAD).otherwise(0.0).means("place of the next sample in the ring"),
                    HY_FIELD(HELD).otherwise(0.0).means("number of past samples that count"),
                    HY_FIELD(BEFORE).in("'x").otherwise(0.0).means("signal before those"),
                    HY_FIELD(STARTED).otherwise(0.0).means("a sample has been seen")};
    }
  };
  template <class S>
  struct In {
    S XIN;
    Bool<S> R1;
    using Self = In;
    static constexpr auto fields() {
      return Fields{HY_FIELD(XIN).in("'x").means("signal"),
                    HY_FIELD(R1).otherwise(0.0).means("reset: the past becomes X0")};
    }
  };

  /// The past as a reset leaves it.
  template <class S>
  static View<S> view(const Params<S>& params, const State<S>& state, const In<S>& in) {
    const S start = select(params.SETTLED, in.XIN, params.X0);
    return {.present = in.XIN,
            .earlier = select(in.R1, params.X0, select(state.STARTED, state.BEFORE, start)),
            .count = select(in.R1, Int<S>(0), state.HELD)};
  }

  template <class S>
  static State<S> initial(const Params<S>& /*params*/) {
    State<S> state{};
    forget(state);
    return state;
  }
  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& state, const In<S>& in, const S& ts) {
    return ago<S>(state, view(params, state, in), params.DEAD_TIME / ts);
  }
  template <class S>
  static void update(const Params<S>& params, State<S>& state, const In<S>& in, const Out<S>& /*out*/,
                     const S& /*ts*/) {
    keep<S>(state, view(params, state, in));
  }
};

}  // namespace hysteron
