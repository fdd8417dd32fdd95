// HY_CTD: CV = PV where LD; else CV - 1 where CD rises; Q = CV <= 0
#pragma once

#include "blocks/counting.hpp"

namespace hysteron {

struct DownCounter {
  static constexpr About about{
      .name = "HY_CTD",
      .title = "Down counter",
      .group = Group::Time,
      .equation = "CV = PV where LD; else CV - 1 where CD rises; Q = CV <= 0",
      .meaning =
          "Counts the rises of CD down from PV, which LD loads; LD dominates. Q is TRUE from the count at which CV "
          "reaches 0; the count goes on below, and stays at -2^31 + 1. Before the first load CV is 0 and Q is TRUE. CD "
          "TRUE in the first step counts as a rise.",
      .source = "IEC 61131-3, CTD"};

  template <class S>
  using Params = NoFields<S>;
  template <class S>
  using State = CounterState<S, "CD of the step before">;
  template <class S>
  struct In {
    Bool<S> CD;
    Bool<S> LD;
    Int<S> PV;
    using Self = In;
    static constexpr auto fields() {
      return Fields{HY_FIELD(CD).means("counts down as it rises"),
                    HY_FIELD(LD).otherwise(0.0).means("load, dominant: CV becomes PV"),
                    HY_FIELD(PV).means("preset value")};
    }
  };
  template <class S>
  using Out = CounterOut<S, "TRUE where CV has reached 0">;

  template <class S>
  static State<S> initial(const Params<S>& /*params*/) {
    return {.COUNT = Int<S>(0), .LAST = Bool<S>(false)};
  }
  template <class S>
  static Out<S> output(const Params<S>& /*params*/, const State<S>& state, const In<S>& in, const S& /*ts*/) {
    const Bool<S> edge = in.CD && !state.LAST;
    const Int<S> count = select(in.LD, in.PV, select(edge, one_less(state.COUNT), state.COUNT));
    return {.Q = count <= Int<S>(0), .CV = count};
  }
  template <class S>
  static void update(const Params<S>& /*params*/, State<S>& state, const In<S>& in, const Out<S>& out,
                     const S& /*ts*/) {
    state.COUNT = out.CV;
    state.LAST = in.CD;
  }
};

}  // namespace hysteron
