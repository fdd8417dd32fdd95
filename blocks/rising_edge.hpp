// HY_R_TRIG: Q = CLK AND NOT M, then M := CLK
#pragma once

#include "blocks/ports.hpp"

namespace hysteron {

struct RisingEdge {
  static constexpr About about{.name = "HY_R_TRIG",
                               .title = "Rising edge",
                               .group = Group::Logic,
                               .equation = "Q = CLK AND NOT M, then M := CLK",
                               .meaning =
                                   "TRUE for the one step in which CLK becomes TRUE. As in the standard, CLK counts as "
                                   "FALSE before the start: if it is TRUE in the first step, Q is TRUE in that step.",
                               .source = "IEC 61131-3, R_TRIG"};

  template <class S>
  using Params = NoFields<S>;
  template <class S>
  struct State {
    Bool<S> M;
    using Self = State;
    static constexpr auto fields() { return std::tuple{HY_FIELD(M).otherwise(0.0).means("CLK of the step before")}; }
  };
  template <class S>
  struct In {
    Bool<S> CLK;
    using Self = In;
    static constexpr auto fields() { return std::tuple{HY_FIELD(CLK).means("signal whose edge is wanted")}; }
  };
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
