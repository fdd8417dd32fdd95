// HY_SAMPLE_AND_HOLD: XOUT = XIN where TRACK, else the last tracked value
#pragma once

#include "blocks/ports.hpp"

namespace hysteron {

struct SampleAndHold {
  static constexpr About about{.name = "HY_SAMPLE_AND_HOLD",
                               .title = "Sample and hold",
                               .group = Group::Shaping,
                               .equation = "XOUT = XIN where TRACK, else XOUT of the step before",
                               .meaning =
                                   "Follows a signal while TRACK is TRUE and keeps its last value while it is FALSE. "
                                   "Before the first tracked sample it gives X0. To take a single sample, put "
                                   "HY_R_TRIG before TRACK; to pass between two rates, use HY_SAMPLE and HY_HOLD."};

  template <class S>
  struct Params {
    S X0;
    using Self = Params;
    static constexpr auto fields() {
      return Fields{HY_FIELD(X0)
                        .role(FieldRole::StartValue)
                        .in("'x")
                        .otherwise(0.0)
                        .means("output before the first tracked sample")};
    }
  };
  template <class S>
  struct State {
    S HELD;
    using Self = State;
    static constexpr auto fields() {
      return Fields{HY_FIELD(HELD).in("'x").otherwise(0.0).means("last tracked value")};
    }
  };
  template <class S>
  struct In {
    S XIN;
    Bool<S> TRACK;
    using Self = In;
    static constexpr auto fields() {
      return Fields{HY_FIELD(XIN).in("'x").means("signal"),
                    HY_FIELD(TRACK).means("follows while TRUE, holds while FALSE")};
    }
  };
  template <class S>
  using Out = Xout<S, "'x", "followed or held signal">;

  template <class S>
  static State<S> initial(const Params<S>& params) {
    return {.HELD = params.X0};
  }
  template <class S>
  static Out<S> output(const Params<S>& /*params*/, const State<S>& state, const In<S>& in, const S& /*ts*/) {
    return {.XOUT = select(in.TRACK, in.XIN, state.HELD)};
  }
  template <class S>
  static void update(const Params<S>& /*params*/, State<S>& state, const In<S>& /*in*/, const Out<S>& out,
                     const S& /*ts*/) {
    state.HELD = out.XOUT;
  }
};

}  // namespace hysteron
