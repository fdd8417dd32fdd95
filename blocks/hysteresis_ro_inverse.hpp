// HY_HYSTERESIS_RO_INVERSE: XOUT = u_i ± Y⁻¹(|XIN − y_i|), Y(p) = C1·p + C2·p^(C3+1)/(C3+1)
#pragma once

#include "blocks/branching.hpp"
#include "blocks/ramberg_osgood.hpp"

namespace hysteron {

struct HysteresisRoInverse {
  static constexpr About about{
      .name = "HY_HYSTERESIS_RO_INVERSE",
      .title = "Inverse of the Ramberg-Osgood hysteresis",
      .group = Group::Memory,
      .equation =
          "XOUT = u_i ± Y⁻¹(|XIN − y_i|), Y(p) = C1·p + C2·p^(C3+1)/(C3+1); on the skeleton XOUT = U0 ± Y⁻¹(2|XIN − "
          "Y0|)/2",
      .meaning =
          "The input that makes HY_HYSTERESIS_RO of the same parameters follow XIN exactly, at every sample and "
          "without drift: a feedforward in closed form. It finds the branching points of XIN itself; EPS is a dead "
          "band of XIN here, in its unit. START, U0, Y0 and R1 as in HY_HYSTERESIS_RO. The loop is inverted by six "
          "Newton steps, to 2 units in the last place.",
      .delay = "None.",
      .source = "Strijbosch and Oomen, Theorem 8; in closed form"};

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
          HY_FIELD(C1).in("'x/'y").above(0.0).otherwise(1.0).means("slope of the loop at a branching point"),
          HY_FIELD(C2).in("'x/'y^(1+C3)").at_least(0.0).otherwise(0.0).means("growth of the slope"),
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
          HY_FIELD(U0).in("'y").otherwise(0.0).means("XOUT at the origin of the skeleton or of the first branch"),
          HY_FIELD(Y0).in("'x").otherwise(0.0).means("XIN at that origin")};
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
      return std::tuple{HY_FIELD(XIN).in("'x").means("wanted output of the hysteresis, a displacement say"),
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
          HY_FIELD(XOUT).in("'y").means("input for the hysteresis, a voltage say"),
          HY_FIELD(P).in("'y").means("momentum: travel of XOUT since the branching point, twice that on the skeleton"),
          HY_FIELD(SLOPE).in("'x/'y").means("slope of the loop, M(P)"),
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
    return begin_branch<S>(params.START, params.Y0, params.U0);
  }
  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& state, const In<S>& in, const S& /*ts*/) {
    const LoopConstants<S> loop{.c1 = params.C1, .c2 = params.C2, .c3 = params.C3};
    const BranchOfSample<S> branch = find_branch(held(params, state, in), in.XIN, params.EPS);
    const S distance = in.XIN - branch.x;
    const S twice = select(branch.skeleton, S(2.0), S(1.0));
    const S momentum = loop_inverse(loop, abs(distance) * twice);
    const S travel = momentum / twice;
    return {.XOUT = branch.y + select(distance < S(0.0), -travel, travel),
            .P = momentum,
            .SLOPE = loop_slopes(loop, momentum).tangent,
            .Q = branch.course.turned};
  }
  template <class S>
  static void update(const Params<S>& params, State<S>& state, const In<S>& in, const Out<S>& out, const S& /*ts*/) {
    const State<S> before = held(params, state, in);
    state = remember(before, find_branch(before, in.XIN, params.EPS), in.XIN, out.XOUT);
  }
};

}  // namespace hysteron
