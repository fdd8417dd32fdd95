// HY_TOF: Q = IN is TRUE, or was within the last PT
#pragma once

#include "blocks/timer.hpp"

namespace hysteron {

struct OffDelay : Timer {
  static constexpr About about{
      .name = "HY_TOF",
      .title = "Off-delay timer",
      .group = Group::Time,
      .equation = "Q = IN OR n·TS < PT, ET = min(n·TS, PT), n = steps since IN fell",
      .meaning =
          "Q rises with IN and falls only once IN has been FALSE for PT: a fan that runs on. With PT = n·TS, Q falls "
          "exactly n steps after IN; with PT = 0 at once. It starts FALSE, with ET = 0, until IN has been TRUE. "
          "PT may change while the timer runs; once Q is FALSE, it stays so until IN is TRUE, and ET is the PT of the "
          "step.",
      .source = "IEC 61131-3, TOF"};

  template <class S>
  struct State {
    Int<S> COUNT;
    Bool<S> STARTED;
    using Self = State;
    static constexpr auto fields() {
      return Fields{HY_FIELD(COUNT).otherwise(-1.0).means(
                        "steps since IN fell, -1 while it is TRUE, 2^31 - 1 once PT has passed"),
                    HY_FIELD(STARTED).otherwise(0.0).means("TRUE once IN has been TRUE")};
    }
  };

  template <class S>
  static State<S> initial(const Params<S>& /*params*/) {
    return {.COUNT = Int<S>(-1), .STARTED = Bool<S>(false)};
  }
  template <class S>
  static Out<S> output(const Params<S>& /*params*/, const State<S>& state, const In<S>& in, const S& ts) {
    const Int<S> steps = steps_in(in.PT, ts);
    const State<S> now = advance(state, in, steps);
    return {.Q = in.IN || (now.STARTED && now.COUNT < steps), .ET = elapsed_time(now.COUNT, steps, in.PT, ts)};
  }
  template <class S>
  static void update(const Params<S>& /*params*/, State<S>& state, const In<S>& in, const Out<S>& /*out*/,
                     const S& ts) {
    state = advance(state, in, steps_in(in.PT, ts));
  }

 private:
  template <class S>
  static State<S> advance(const State<S>& state, const In<S>& in, const Int<S>& steps) {
    const Bool<S> started = in.IN || state.STARTED;
    return {.COUNT = select(!in.IN && started, count_on<S>(state.COUNT, steps), Int<S>(-1)), .STARTED = started};
  }
};

}  // namespace hysteron
