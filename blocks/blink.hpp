// HY_BLINK: Q is TRUE for THIGH and FALSE for TLOW, in turn, while RUN
#pragma once

#include "blocks/ports.hpp"
#include "blocks/ticks.hpp"

namespace hysteron {

struct Blink {
  static constexpr About about{
      .name = "HY_BLINK",
      .title = "Square wave",
      .group = Group::Time,
      .equation = "Q = RUN AND (n·TS modulo THIGH + TLOW) < THIGH, n = steps since RUN rose",
      .meaning =
          "TRUE for THIGH and FALSE for TLOW, in turn, beginning with TRUE in the step in which RUN rises; FALSE while "
          "RUN is. Both times are exact in steps and at least one step, so the edges neither drift nor jitter. With "
          "HY_SWITCH it makes a square wave."};

  template <class S>
  struct Params {
    S THIGH;
    S TLOW;
    using Self = Params;
    static constexpr auto fields() {
      return Fields{HY_FIELD(THIGH).in("s").otherwise(0.5).at_least(0.0).means("time TRUE"),
                    HY_FIELD(TLOW).in("s").otherwise(0.5).at_least(0.0).means("time FALSE")};
    }
  };
  template <class S>
  struct State {
    Bool<S> HIGH;
    Int<S> COUNT;
    using Self = State;
    static constexpr auto fields() {
      return Fields{HY_FIELD(HIGH).otherwise(1.0).means("TRUE in the part of THIGH"),
                    HY_FIELD(COUNT).otherwise(0.0).means("steps since this part began")};
    }
  };
  template <class S>
  struct In {
    Bool<S> RUN;
    using Self = In;
    static constexpr auto fields() {
      return Fields{HY_FIELD(RUN).otherwise(1.0).means("TRUE: blinks; FALSE: Q is FALSE and the time starts again")};
    }
  };
  template <class S>
  using Out = Truth<S, "square wave">;

  template <class S>
  static State<S> initial(const Params<S>& /*params*/) {
    return {.HIGH = Bool<S>(true), .COUNT = Int<S>(0)};
  }
  template <class S>
  static Out<S> output(const Params<S>& /*params*/, const State<S>& state, const In<S>& in, const S& /*ts*/) {
    return {.Q = in.RUN && state.HIGH};
  }
  template <class S>
  static void update(const Params<S>& params, State<S>& state, const In<S>& in, const Out<S>& /*out*/, const S& ts) {
    const Int<S> count = one_more(state.COUNT);
    const Bool<S> over = count >= steps_in(select(state.HIGH, params.THIGH, params.TLOW), ts);
    state.HIGH = !in.RUN || (state.HIGH != over);
    state.COUNT = select(in.RUN && !over, count, Int<S>(0));
  }
};

}  // namespace hysteron
