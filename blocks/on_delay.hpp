// HY_TON: Q = IN has been TRUE for PT
#pragma once

#include "blocks/timer.hpp"

namespace hysteron {

struct OnDelay : Timer {
  static constexpr About about{
      .name = "HY_TON",
      .title = "On-delay timer",
      .group = Group::Time,
      .equation = "Q = IN AND n·TS >= PT, ET = min(n·TS, PT), n = steps since IN rose",
      .meaning =
          "Q follows IN, but rises only once IN has been TRUE for PT. With PT = n·TS, Q rises "
          "exactly n steps after IN, also where n·TS cannot be represented; with PT = 0 it "
          "rises at once. ET is 0 while IN is FALSE. PT may change while the timer runs; once Q is "
          "TRUE, it stays so until IN is FALSE, and ET is the PT of the step.",
      .source = "IEC 61131-3, TON"};

  template <class S>
  struct State {
    Int<S> COUNT;
    using Self = State;
    static constexpr auto fields() {
      return Fields{HY_FIELD(COUNT).otherwise(-1.0).means(
          "steps since IN rose, -1 while it is FALSE, 2^31 - 1 once PT has passed")};
    }
  };

  template <class S>
  static State<S> initial(const Params<S>& /*params*/) {
    return {.COUNT = Int<S>(-1)};
  }
  template <class S>
  static Out<S> output(const Params<S>& /*params*/, const State<S>& state, const In<S>& in, const S& ts) {
    const Int<S> steps = steps_in(in.PT, ts);
    const Int<S> count = advance(state, in, steps);
    return {.Q = count >= steps, .ET = elapsed_time(count, steps, in.PT, ts)};
  }
  template <class S>
  static void update(const Params<S>& /*params*/, State<S>& state, const In<S>& in, const Out<S>& /*out*/,
                     const S& ts) {
    state.COUNT = advance(state, in, steps_in(in.PT, ts));
  }

 private:
  template <class S>
  static Int<S> advance(const State<S>& state, const In<S>& in, const Int<S>& steps) {
    return select(in.IN, count_on<S>(state.COUNT, steps), Int<S>(-1));
  }
};

}  // namespace hysteron
