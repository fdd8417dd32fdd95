// HY_DEAD_TIME: XOUT(t) = XIN(t − DEAD_TIME)
#pragma once

#include "blocks/ports.hpp"

namespace hysteron {

struct DeadTime {
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
      .effect = "delay"};

  static constexpr std::size_t capacity = 1024;

  template <class S>
  struct Params {
    S DEAD_TIME;
    Bool<S> SETTLED;
    S X0;
    using Self = Params;
    static constexpr auto fields() {
      return std::tuple{
          HY_FIELD(DEAD_TIME).in("s").at_least(0.0).otherwise(0.0).neutral_at(0.0).means("dead time"),
          HY_FIELD(SETTLED).otherwise(1.0).means(
              "starts as if the first input had stood for ever; FALSE: as if X0 had"),
          HY_FIELD(X0).in("'x").otherwise(0.0).means("signal before a reset, and before the start if not SETTLED")};
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
      return std::tuple{HY_FIELD(PAST).in("'x").otherwise(0.0).means("past samples, in a ring"),
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
      return std::tuple{HY_FIELD(XIN).in("'x").means("signal"),
                        HY_FIELD(R1).otherwise(0.0).means("reset: the past becomes X0")};
    }
  };
  template <class S>
  struct Out {
    S XOUT;
    Bool<S> ERROR;
    Word<S> ERRORID;
    using Self = Out;
    static constexpr auto fields() {
      return std::tuple{HY_FIELD(XOUT).in("'x").means("delayed signal"),
                        HY_FIELD(ERROR).means("the dead time is longer than 1024 samples, or below 0"),
                        HY_FIELD(ERRORID).means("0 no error, 5 dead time too long or below 0")};
    }
  };

  /// The signal before all samples that count.
  template <class S>
  static S before(const Params<S>& params, const State<S>& state, const In<S>& in) {
    const S start = select(params.SETTLED, in.XIN, params.X0);
    return select(in.R1, params.X0, select(state.STARTED, state.BEFORE, start));
  }
  template <class S>
  static Int<S> held(const State<S>& state, const In<S>& in) {
    return select(in.R1, Int<S>(0), state.HELD);
  }
  /// The sample `age` steps ago, for an age of at least 1.
  template <class S>
  static S past(const State<S>& state, const Int<S>& age, const Int<S>& count, const S& earlier) {
    const Int<S> place = state.HEAD - age;
    const Int<S> wrapped = select(place < Int<S>(0), place + Int<S>(std::int32_t{capacity}), place);
    return select(age <= count, at(state.PAST, wrapped), earlier);
  }

  template <class S>
  static State<S> initial(const Params<S>& /*params*/) {
    State<S> state{};
    fill(state.PAST, S(0.0));
    state.HEAD = Int<S>(0);
    state.HELD = Int<S>(0);
    state.BEFORE = S(0.0);
    state.STARTED = Bool<S>(false);
    return state;
  }
  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& state, const In<S>& in, const S& ts) {
    constexpr auto longest = static_cast<double>(capacity);
    const S wanted = params.DEAD_TIME / ts;
    const S steps = max(min(S(longest), wanted), S(0.0));
    const Int<S> whole = to_int(steps);
    const S fraction = steps - to_real<S>(whole);
    const S earlier = before(params, state, in);
    const Int<S> count = held(state, in);
    const S newer = select(whole < Int<S>(1), in.XIN, past<S>(state, whole, count, earlier));
    const S older = past<S>(state, whole + Int<S>(1), count, earlier);
    const Bool<S> held_back = !(wanted >= S(0.0) && wanted <= S(longest));
    return {.XOUT = newer + fraction * (older - newer),
            .ERROR = held_back,
            .ERRORID = select(held_back, Word<S>(fault::dead_time_too_long), Word<S>(std::uint16_t{0}))};
  }
  template <class S>
  static void update(const Params<S>& params, State<S>& state, const In<S>& in, const Out<S>& /*out*/,
                     const S& /*ts*/) {
    constexpr std::int32_t size{capacity};
    state.BEFORE = before(params, state, in);
    state.HELD = min(held(state, in) + Int<S>(1), Int<S>(size));
    store(state.PAST, state.HEAD, in.XIN);
    const Int<S> next = state.HEAD + Int<S>(1);
    state.HEAD = select(next < Int<S>(size), next, Int<S>(0));
    state.STARTED = Bool<S>(true);
  }
};

}  // namespace hysteron
