// HY_CTU: CV = 0 where R; else CV + 1 where CU rises; Q = CV >= PV
#pragma once

#include "blocks/counting.hpp"

namespace hysteron {

struct UpCounter {
  static constexpr About about{
      .name = "HY_CTU",
      .title = "Up counter",
      .group = Group::Time,
      .equation = "CV = 0 where R; else CV + 1 where CU rises; Q = CV >= PV",
      .meaning =
          "Counts the rises of CU. R dominates and returns to 0. Q is TRUE from the count at which CV reaches PV; the "
          "count goes on above it, and stays at 2^31 - 1. CU TRUE in the first step counts as a rise.",
      .source = "IEC 61131-3, CTU"};

  template <class S>
  using Params = NoFields<S>;
  template <class S>
  using State = CounterState<S, "CU of the step before">;
  template <class S>
  struct In {
    Bool<S> CU;
    Bool<S> R;
    Int<S> PV;
    using Self = In;
    static constexpr auto fields() {
      return Fields{HY_FIELD(CU).means("counts as it rises"),
                    HY_FIELD(R).otherwise(0.0).means("reset, dominant: loads 0"), HY_FIELD(PV).means("preset value")};
    }
  };
  template <class S>
  using Out = CounterOut<S, "TRUE where CV has reached PV">;

  template <class S>
  static State<S> initial(const Params<S>& /*params*/) {
    return {.COUNT = Int<S>(0), .LAST = Bool<S>(false)};
  }
  template <class S>
  static Out<S> output(const Params<S>& /*params*/, const State<S>& state, const In<S>& in, const S& /*ts*/) {
    const Bool<S> edge = in.CU && !state.LAST;
    const Int<S> count = select(in.R, Int<S>(0), select(edge, one_more(state.COUNT), state.COUNT));
    return {.Q = count >= in.PV, .CV = count};
  }
  template <class S>
  static void update(const Params<S>& /*params*/, State<S>& state, const In<S>& in, const Out<S>& out,
                     const S& /*ts*/) {
    state.COUNT = out.CV;
    state.LAST = in.CU;
  }
};

}  // namespace hysteron
