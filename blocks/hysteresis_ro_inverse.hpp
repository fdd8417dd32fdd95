// HY_HYSTERESIS_RO_INVERSE: XOUT = u_i ± Y⁻¹(|XIN − y_i|), Y(p) = C1·p + C2·p^(C3+1)/(C3+1)
#pragma once

#include "blocks/branching.hpp"
#include "blocks/loop_pins.hpp"

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
  using Params = LoopParams<S, "'y", "'x", "XOUT", "XIN", "slope of the loop at a branching point">;
  template <class S>
  using State = BranchMemory<S>;
  template <class S>
  using In = LoopIn<S, "wanted output of the hysteresis, a displacement say">;
  template <class S>
  using Out = LoopOut<S, "'y", "'x", "input for the hysteresis, a voltage say", "travel of XOUT">;

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
    const LoopConstants<S> loop = params.loop();
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
