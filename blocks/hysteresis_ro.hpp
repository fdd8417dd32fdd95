// HY_HYSTERESIS_RO: XOUT = y_i ± Y(|XIN − u_i|), Y(p) = C1·p + C2·p^(C3+1)/(C3+1)
#pragma once

#include "blocks/branching.hpp"
#include "blocks/loop_pins.hpp"

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
  using Params = LoopParams<S, "'x", "'y", "input", "output",
                            "slope at a branching point; above 0, so that the loop rises throughout">;
  template <class S>
  using State = BranchMemory<S>;
  template <class S>
  using In = LoopIn<S, "input, a voltage say">;
  template <class S>
  using Out = LoopOut<S, "'x", "'y", "output, a displacement say", "travel">;

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
    const LoopSlopes<S> slopes = loop_slopes(params.loop(), momentum);
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
