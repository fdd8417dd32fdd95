// HY_R_TRIG: Q = CLK AND NOT M, then M := CLK
#pragma once

#include "blocks/edge.hpp"

namespace hysteron {

struct RisingEdge : Edge {
  static constexpr About about{.name = "HY_R_TRIG",
                               .title = "Rising edge",
                               .group = Group::Logic,
                               .equation = "Q = CLK AND NOT M, then M := CLK",
                               .meaning =
                                   "TRUE for the one step in which CLK becomes TRUE. As in the standard, CLK counts as "
                                   "FALSE before the start: if it is TRUE in the first step, Q is TRUE in that step.",
                               .source = "IEC 61131-3, R_TRIG"};

  template <class S>
  using State = EdgeState<S, "CLK of the step before">;
  template <class S>
  using Out = Truth<S, "TRUE in the step in which CLK rises">;

  template <class S>
  static State<S> initial(const Params<S>& /*params*/) {
    return {.M = Bool<S>(false)};
  }
  template <class S>
  static Out<S> output(const Params<S>& /*params*/, const State<S>& state, const In<S>& in, const S& /*ts*/) {
    return {.Q = in.CLK && !state.M};
  }
  template <class S>
  static void update(const Params<S>& /*params*/, State<S>& state, const In<S>& in, const Out<S>& /*out*/,
                     const S& /*ts*/) {
    state.M = in.CLK;
  }
};

}  // namespace hysteron
