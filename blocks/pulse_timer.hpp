// HY_TP: a rise of IN gives a pulse of PT at Q
#pragma once

#include "blocks/timer.hpp"

namespace hysteron {

struct PulseTimer : Timer {
  static constexpr About about{
      .name = "HY_TP",
      .title = "Pulse timer",
      .group = Group::Time,
      .equation = "Q = n·TS < PT, ET = min(n·TS, PT), n = steps since the rise of IN that began the pulse",
      .meaning =
          "A rise of IN begins a pulse at Q that lasts exactly PT, whatever IN does meanwhile; a rise during the pulse "
          "does not lengthen it. Behind it, ET is the PT of the step until IN is FALSE, and is 0 then. With PT = 0 "
          "there "
          "is no pulse. PT may change while the pulse lasts; one that is over does not come back.",
      .source = "IEC 61131-3, TP"};

  template <class S>
  struct State {
    Int<S> COUNT;
    using Self = State;
    static constexpr auto fields() {
      return Fields{HY_FIELD(COUNT).otherwise(-1.0).means(
          "steps since the pulse began, -1 when ready for the next, 2^31 - 1 once it is over")};
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
    return {.Q = count >= Int<S>(0) && count < steps, .ET = elapsed_time(count, steps, in.PT, ts)};
  }
  template <class S>
  static void update(const Params<S>& /*params*/, State<S>& state, const In<S>& in, const Out<S>& /*out*/,
                     const S& ts) {
    state.COUNT = advance(state, in, steps_in(in.PT, ts));
  }

 private:
  /// A count of −1 says that IN was FALSE in the step before, so that IN TRUE now is a rise.
  template <class S>
  static Int<S> advance(const State<S>& state, const In<S>& in, const Int<S>& steps) {
    const Bool<S> running = state.COUNT >= Int<S>(0);
    const Int<S> count = select(running || in.IN, count_on<S>(state.COUNT, steps), Int<S>(-1));
    return select(!in.IN && count >= steps, Int<S>(-1), count);
  }
};

}  // namespace hysteron
