// HY_CTUD: CV = 0 where R; else PV where LD; else CV + 1 where CU rises alone, CV − 1 where CD rises alone
#pragma once

#include "blocks/counting.hpp"
#include "blocks/ports.hpp"

namespace hysteron {

struct UpDownCounter {
  static constexpr About about{
      .name = "HY_CTUD",
      .title = "Up-down counter",
      .group = Group::Time,
      .equation = "CV = 0 where R; else PV where LD; else CV + 1 where CU rises alone, CV - 1 where CD rises alone",
      .meaning =
          "Counts the rises of CU up and those of CD down; where both rise in the same step the count stays. R "
          "dominates LD, and both dominate counting. The count stays at the ends, 2^31 - 1 and -2^31 + 1. CU or CD "
          "TRUE in the first step counts as a rise.",
      .source = "IEC 61131-3, CTUD"};

  template <class S>
  using Params = NoFields<S>;
  template <class S>
  struct State {
    Int<S> COUNT;
    Bool<S> LAST_UP;
    Bool<S> LAST_DOWN;
    using Self = State;
    static constexpr auto fields() {
      return Fields{HY_FIELD(COUNT).otherwise(0.0).means("count of the step before"),
                    HY_FIELD(LAST_UP).otherwise(0.0).means("CU of the step before"),
                    HY_FIELD(LAST_DOWN).otherwise(0.0).means("CD of the step before")};
    }
  };
  template <class S>
  struct In {
    Bool<S> CU;
    Bool<S> CD;
    Bool<S> R;
    Bool<S> LD;
    Int<S> PV;
    using Self = In;
    static constexpr auto fields() {
      return Fields{HY_FIELD(CU).means("counts up as it rises"), HY_FIELD(CD).means("counts down as it rises"),
                    HY_FIELD(R).otherwise(0.0).means("reset, dominant: loads 0"),
                    HY_FIELD(LD).otherwise(0.0).means("load: CV becomes PV"), HY_FIELD(PV).means("preset value")};
    }
  };
  template <class S>
  struct Out {
    Bool<S> QU;
    Bool<S> QD;
    Int<S> CV;
    using Self = Out;
    static constexpr auto fields() {
      return Fields{HY_FIELD(QU).means("TRUE where CV has reached PV"),
                    HY_FIELD(QD).means("TRUE where CV has reached 0"), HY_FIELD(CV).means("count")};
    }
  };

  template <class S>
  static State<S> initial(const Params<S>& /*params*/) {
    return {.COUNT = Int<S>(0), .LAST_UP = Bool<S>(false), .LAST_DOWN = Bool<S>(false)};
  }
  template <class S>
  static Out<S> output(const Params<S>& /*params*/, const State<S>& state, const In<S>& in, const S& /*ts*/) {
    const Bool<S> up = in.CU && !state.LAST_UP;
    const Bool<S> down = in.CD && !state.LAST_DOWN;
    const Int<S> counted =
        select(up && !down, one_more(state.COUNT), select(down && !up, one_less(state.COUNT), state.COUNT));
    const Int<S> count = select(in.R, Int<S>(0), select(in.LD, in.PV, counted));
    return {.QU = count >= in.PV, .QD = count <= Int<S>(0), .CV = count};
  }
  template <class S>
  static void update(const Params<S>& /*params*/, State<S>& state, const In<S>& in, const Out<S>& out,
                     const S& /*ts*/) {
    state.COUNT = out.CV;
    state.LAST_UP = in.CU;
    state.LAST_DOWN = in.CD;
  }
};

}  // namespace hysteron
