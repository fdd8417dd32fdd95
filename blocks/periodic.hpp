// What the periodic references share: parameters, and a phase that does not drift.
#pragma once

#include "blocks/ports.hpp"

namespace hysteron {

/// A block that repeats itself FREQUENCY times a second.
///
/// The phase is a sum of FREQUENCY·TS in periods, taken modulo 1, in twice the working precision: the low part keeps
/// what the sum rounds off. After 10^8 steps the phase is still the product FREQUENCY·TS·k to its last digits, and no
/// count of steps can run over.
struct Periodic {
  template <class S>
  struct Params {
    S AMPLITUDE;
    S FREQUENCY;
    S PHASE;
    S OFFSET;
    using Self = Params;
    static constexpr auto fields() {
      return Fields{HY_FIELD(AMPLITUDE).in("'x").otherwise(1.0).means("largest distance from OFFSET"),
                    HY_FIELD(FREQUENCY).in("Hz").otherwise(1.0).at_least(0.0).means("periods a second"),
                    HY_FIELD(PHASE).in("1").otherwise(0.0).within(-1.0, 1.0).means("phase at the start, in periods"),
                    HY_FIELD(OFFSET).in("'x").otherwise(0.0).means("mean value")};
    }
  };
  template <class S>
  struct State {
    S TURN;
    S LOST;
    using Self = State;
    static constexpr auto fields() {
      return Fields{HY_FIELD(TURN).in("1").otherwise(0.0).means("phase since the start, in periods, modulo 1"),
                    HY_FIELD(LOST).in("1").otherwise(0.0).means("low part that TURN could not hold")};
    }
  };
  template <class S>
  struct In {
    Bool<S> RUN;
    using Self = In;
    static constexpr auto fields() {
      return Fields{
          HY_FIELD(RUN).otherwise(1.0).means("TRUE: runs; FALSE: the output is OFFSET and the phase starts again")};
    }
  };
  template <class S>
  using Out = Xout<S, "'x", "reference signal">;

  template <class S>
  static State<S> initial(const Params<S>& /*params*/) {
    return {.TURN = S(0.0), .LOST = S(0.0)};
  }
  template <class S>
  static void update(const Params<S>& params, State<S>& state, const In<S>& in, const Out<S>& /*out*/, const S& ts) {
    // TURN + step = sum + rounded exactly (Knuth's two-sum), then the low parts are joined and whole turns taken off.
    const S step = params.FREQUENCY * ts;
    const S sum = state.TURN + step;
    const S step_seen = sum - state.TURN;
    const S rounded = (state.TURN - (sum - step_seen)) + (step - step_seen);
    const S low = state.LOST + rounded;
    const S joined = sum + low;
    state.TURN = select(in.RUN, joined - to_real<S>(to_int(joined)), S(0.0));
    state.LOST = select(in.RUN, low - (joined - sum), S(0.0));
  }

 protected:
  /// The present phase in periods, at least −1 and below 2.
  template <class S>
  static S phase(const Params<S>& params, const State<S>& state) {
    return state.TURN + params.PHASE;
  }
  template <class S>
  static Out<S> shaped(const Params<S>& params, const In<S>& in, const S& shape) {
    return {.XOUT = select(in.RUN, params.OFFSET + params.AMPLITUDE * shape, params.OFFSET)};
  }
};

}  // namespace hysteron
