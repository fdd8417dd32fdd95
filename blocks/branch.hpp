// HY_BRANCH: the branching points of a signal, with a dead band
#pragma once

#include "blocks/branching.hpp"

namespace hysteron {

struct Branch {
  static constexpr About about{
      .name = "HY_BRANCH",
      .title = "Branching detector",
      .group = Group::Memory,
      .equation = "Q where XIN has come back from its extreme by more than EPS; then XB = that extreme; P = |XIN − XB|",
      .meaning =
          "Finds where a signal reverses. XIN is the signal itself, not its rate. Since the last branching point its "
          "extreme is held; once it has come back from there by more than EPS, a reversal is declared: Q is TRUE in "
          "that step and XB becomes the extreme. A plateau is no reversal. The first sample, and the sample at a "
          "reset, count as the start of a branch (XB) without a Q; the direction is 0 until the signal has moved by "
          "more than EPS. EPS = 0 suits an exact reference; a measured or computed signal that dwells needs some of "
          "its noise.",
      .delay = "A reversal is seen in the first sample that lies more than EPS behind the extreme.",
      .source = "Strijbosch and Oomen, section II.B and Theorem 4"};

  template <class S>
  struct Params {
    S EPS;
    using Self = Params;
    static constexpr auto fields() {
      return Fields{HY_FIELD(EPS)
                        .in("'x")
                        .at_least(0.0)
                        .otherwise(0.0)
                        .neutral_at(0.0)
                        .effect("branch_chatter", Family::Hysteresis)
                        .means("dead band: a return up to this is no reversal")};
    }
  };
  template <class S>
  struct State {
    Bool<S> STARTED;
    Int<S> HEADING;
    S EXTREME;
    S ORIGIN;
    using Self = State;
    static constexpr auto fields() {
      return Fields{HY_FIELD(STARTED).otherwise(0.0).means("a sample has been seen"),
                    HY_FIELD(HEADING).otherwise(0.0).means("direction so far: -1, 0 or 1"),
                    HY_FIELD(EXTREME).in("'x").otherwise(0.0).means("extreme since the last branching point"),
                    HY_FIELD(ORIGIN).in("'x").otherwise(0.0).means("last branching point")};
    }
  };
  template <class S>
  struct In {
    S XIN;
    Bool<S> R1;
    using Self = In;
    static constexpr auto fields() {
      return Fields{HY_FIELD(XIN).in("'x").means("signal, not its rate"),
                    HY_FIELD(R1).otherwise(0.0).means("reset: the present sample starts a branch")};
    }
  };
  template <class S>
  struct Out {
    Bool<S> Q;
    Int<S> DIRECTION;
    S XB;
    S P;
    using Self = Out;
    static constexpr auto fields() {
      return Fields{HY_FIELD(Q).means("TRUE in the step in which a reversal is declared"),
                    HY_FIELD(DIRECTION).means("1 upwards, -1 downwards, 0 before the first motion"),
                    HY_FIELD(XB).in("'x").means("signal at the last branching point"),
                    HY_FIELD(P).in("'x").means("momentum: distance from the branching point")};
    }
  };

  /// What is held before the present sample: after a reset or at the start, the sample itself.
  template <class S>
  static State<S> held(const State<S>& state, const In<S>& in) {
    const Bool<S> fresh = in.R1 || !state.STARTED;
    return {.STARTED = Bool<S>(true),
            .HEADING = select(fresh, Int<S>(0), state.HEADING),
            .EXTREME = select(fresh, in.XIN, state.EXTREME),
            .ORIGIN = select(fresh, in.XIN, state.ORIGIN)};
  }

  template <class S>
  static State<S> initial(const Params<S>& /*params*/) {
    return {.STARTED = Bool<S>(false), .HEADING = Int<S>(0), .EXTREME = S(0.0), .ORIGIN = S(0.0)};
  }
  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& state, const In<S>& in, const S& /*ts*/) {
    const State<S> before = held(state, in);
    const Course<S> course = follow<S>(in.XIN, before.HEADING, before.EXTREME, params.EPS);
    const S branching_point = select(course.turned, before.EXTREME, before.ORIGIN);
    return {.Q = course.turned, .DIRECTION = course.heading, .XB = branching_point, .P = abs(in.XIN - branching_point)};
  }
  template <class S>
  static void update(const Params<S>& params, State<S>& state, const In<S>& in, const Out<S>& out, const S& /*ts*/) {
    const State<S> before = held(state, in);
    const Course<S> course = follow<S>(in.XIN, before.HEADING, before.EXTREME, params.EPS);
    state = {.STARTED = Bool<S>(true),
             .HEADING = out.DIRECTION,
             .EXTREME = select(course.advanced, in.XIN, before.EXTREME),
             .ORIGIN = out.XB};
  }
};

}  // namespace hysteron
