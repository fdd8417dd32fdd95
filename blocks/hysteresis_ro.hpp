// HY_HYSTERESIS_RO: XOUT = y_i ± Y(|XIN − u_i|), Y(p) = C1·p + C2·p^(C3+1)/(C3+1)
#pragma once

#include "blocks/branching.hpp"
#include "blocks/ramberg_osgood.hpp"

namespace hysteron {

struct HysteresisRo {
  static constexpr About about{
      .name = "HY_HYSTERESIS_RO",
      .title = "Ramberg-Osgood hysteresis",
      .group = Group::Memory,
      .equation =
          "XOUT = y_i ± Y(|XIN − u_i|), Y(p) = C1·p + C2·p^(C3+1)/(C3+1); on the skeleton XOUT = Y0 ± Y(2|XIN − "
          "U0|)/2",
      .meaning =
          "Hysteresis that remembers its last branching point (u_i, y_i), in closed form: exact at every sample "
          "time, without drift. It finds its branching points itself, as HY_BRANCH does with the dead band EPS. "
          "START = 0 begins on the skeleton curve about (U0, Y0), as a virgin actuator does; START = 1 or -1 begins "
          "in the middle of a loop, on a branch that left (U0, Y0) upwards or downwards. R1 begins so again, with "
          "the present sample. With EPS > 0 a return within the dead band runs back along the branch, and a reversal "
          "declared after it makes XOUT jump by less than EPS*SLOPE.",
      .delay = "None.",
      .source = "Strijbosch and Oomen, equations (2), (3) and (17); integrated in closed form"};

  template <class S>
  struct Params {
    S C1;
    S C2;
    S C3;
    S EPS;
    Int<S> START;
    S U0;
    S Y0;
    using Self = Params;
    static constexpr auto fields() {
      return std::tuple{
          HY_FIELD(C1).in("'y/'x").above(0.0).otherwise(1.0).means(
              "slope at a branching point; above 0, so that the loop rises throughout"),
          HY_FIELD(C2).in("'y/'x^(1+C3)").at_least(0.0).otherwise(0.0).means("growth of the slope"),
          HY_FIELD(C3).in("1").within(0.0, 10.0).otherwise(1.0).means("exponent of the momentum"),
          HY_FIELD(EPS)
              .in("'x")
              .at_least(0.0)
              .otherwise(0.0)
              .neutral_at(0.0)
              .effect("branch_chatter")
              .means("dead band of the branching detector"),
          HY_FIELD(START).within(-1.0, 1.0).otherwise(0.0).means(
              "0: on the skeleton; 1, -1: on a rising, falling branch"),
          HY_FIELD(U0).in("'x").otherwise(0.0).means("input at the origin of the skeleton or of the first branch"),
          HY_FIELD(Y0).in("'y").otherwise(0.0).means("output at that origin")};
    }
  };
  template <class S>
  using State = BranchMemory<S>;
  template <class S>
  struct In {
    S XIN;
    Bool<S> R1;
    using Self = In;
    static constexpr auto fields() {
      return std::tuple{HY_FIELD(XIN).in("'x").means("input, a voltage say"),
                        HY_FIELD(R1).otherwise(0.0).means("reset: begins again at U0, Y0")};
    }
  };
  template <class S>
  struct Out {
    S XOUT;
    S P;
    S SLOPE;
    Bool<S> Q;
    using Self = Out;
    static constexpr auto fields() {
      return std::tuple{
          HY_FIELD(XOUT).in("'y").means("output, a displacement say"),
          HY_FIELD(P).in("'x").means("momentum: travel since the branching point, twice that on the skeleton"),
          HY_FIELD(SLOPE).in("'y/'x").means("slope of the loop, M(P)"),
          HY_FIELD(Q).means("TRUE in the step in which a reversal is declared")};
    }
  };

  /// What is remembered before the present sample.
  template <class S>
  static State<S> held(const Params<S>& params, const State<S>& state, const In<S>& in) {
    return select_memory<S>(in.R1, initial(params), state);
  }

  template <class S>
  static State<S> initial(const Params<S>& params) {
    return begin_branch<S>(params.START, params.U0, params.Y0);
  }
  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& state, const In<S>& in, const S& /*ts*/) {
    const BranchOfSample<S> branch = find_branch(held(params, state, in), in.XIN, params.EPS);
    const S distance = in.XIN - branch.x;
    const S momentum = abs(distance) * select(branch.skeleton, S(2.0), S(1.0));
    const LoopSlopes<S> slopes = loop_slopes<S>({.c1 = params.C1, .c2 = params.C2, .c3 = params.C3}, momentum);
    return {.XOUT = branch.y + distance * slopes.chord,  // (2), (3)
            .P = momentum,
            .SLOPE = slopes.tangent,  // (12)
            .Q = branch.course.turned};
  }
  template <class S>
  static void update(const Params<S>& params, State<S>& state, const In<S>& in, const Out<S>& out, const S& /*ts*/) {
    const State<S> before = held(params, state, in);
    state = remember(before, find_branch(before, in.XIN, params.EPS), in.XIN, out.XOUT);
  }
};

}  // namespace hysteron
