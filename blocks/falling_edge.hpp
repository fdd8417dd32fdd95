// HY_F_TRIG: Q = NOT CLK AND NOT M, then M := NOT CLK
#pragma once

#include "blocks/edge.hpp"

namespace hysteron {

struct FallingEdge : Edge {
  static constexpr About about{
      .name = "HY_F_TRIG",
      .title = "Falling edge",
      .group = Group::Logic,
      .equation = "Q = NOT CLK AND NOT M, then M := NOT CLK",
      .meaning =
          "TRUE for the one step in which CLK becomes FALSE. As in the standard, CLK counts as TRUE before the start: "
          "if it is FALSE in the first step, Q is TRUE in that step.",
      .source = "IEC 61131-3, F_TRIG"};

  template <class S>
  using State = EdgeState<S, "NOT CLK of the step before">;
  template <class S>
  using Out = Truth<S, "TRUE in the step in which CLK falls">;

  template <class S>
  static State<S> initial(const Params<S>& /*params*/) {
    return {.M = Bool<S>(false)};
  }
  template <class S>
  static Out<S> output(const Params<S>& /*params*/, const State<S>& state, const In<S>& in, const S& /*ts*/) {
    return {.Q = !in.CLK && !state.M};
  }
  template <class S>
  static void update(const Params<S>& /*params*/, State<S>& state, const In<S>& in, const Out<S>& /*out*/,
                     const S& /*ts*/) {
    state.M = !in.CLK;
  }
};

}  // namespace hysteron
