// HY_RAMP: XOUT = X0 + (X1 − X0)·t/TR from the rise of RUN until t = TR, then X1; X0 while RUN is FALSE
#pragma once

#include "blocks/ports.hpp"
#include "blocks/ticks.hpp"

namespace hysteron {

struct Ramp {
  static constexpr About about{
      .name = "HY_RAMP",
      .title = "Ramp",
      .group = Group::Control,
      .equation = "XOUT = X0 where not RUN; else X1 where t >= TR; else X0' + (X1 - X0')·t/TR, X0' = X0 as RUN rose",
      .meaning =
          "Leads from X0 to X1 in a straight line that takes TR, from the step in which RUN rises; BUSY tells that it "
          "is on its way. RUN FALSE returns to X0 at once. X0 is remembered as RUN rises, X1 and TR may change on the "
          "way. TR is exact in steps, however long it is (up to 2^31 steps).",
      .source = "IEC 61131-3, RAMP"};

  template <class S>
  using Params = NoFields<S>;
  template <class S>
  struct State {
    S FROM;
    Int<S> COUNT;
    using Self = State;
    static constexpr auto fields() {
      return Fields{HY_FIELD(FROM).in("'x").otherwise(0.0).means("X0 as RUN rose"),
                    HY_FIELD(COUNT).otherwise(-1.0).means("steps since RUN rose, -1 while it is FALSE")};
    }
  };
  template <class S>
  struct In {
    Bool<S> RUN;
    S X0;
    S X1;
    S TR;
    using Self = In;
    static constexpr auto fields() {
      return Fields{HY_FIELD(RUN).means("TRUE: ramp from X0 to X1; FALSE: X0"),
                    HY_FIELD(X0).in("'x").otherwise(0.0).means("value before the ramp"),
                    HY_FIELD(X1).in("'x").means("value after the ramp"),
                    HY_FIELD(TR).in("s").at_least(0.0).means("time that the ramp takes")};
    }
  };
  template <class S>
  struct Out {
    Bool<S> BUSY;
    S XOUT;
    using Self = Out;
    static constexpr auto fields() {
      return Fields{HY_FIELD(BUSY).means("TRUE while on the way from X0 to X1"), HY_FIELD(XOUT).in("'x").means("ramp")};
    }
  };

  template <class S>
  static State<S> initial(const Params<S>& /*params*/) {
    return {.FROM = S(0.0), .COUNT = Int<S>(-1)};
  }
  template <class S>
  static Out<S> output(const Params<S>& /*params*/, const State<S>& state, const In<S>& in, const S& ts) {
    const State<S> now = advance(state, in);
    const Bool<S> arrived = now.COUNT >= steps_in(in.TR, ts);
    const S share = to_real<S>(now.COUNT) * ts / select(arrived, S(1.0), in.TR);
    const S value = now.FROM + (in.X1 - now.FROM) * min(share, S(1.0));
    return {.BUSY = in.RUN && !arrived, .XOUT = select(in.RUN, select(arrived, in.X1, value), in.X0)};
  }
  template <class S>
  static void update(const Params<S>& /*params*/, State<S>& state, const In<S>& in, const Out<S>& /*out*/,
                     const S& /*ts*/) {
    state = advance(state, in);
  }

 private:
  template <class S>
  static State<S> advance(const State<S>& state, const In<S>& in) {
    const Bool<S> rose = state.COUNT < Int<S>(0);
    return {.FROM = select(rose, in.X0, state.FROM), .COUNT = select(in.RUN, one_more(state.COUNT), Int<S>(-1))};
  }
};

}  // namespace hysteron
