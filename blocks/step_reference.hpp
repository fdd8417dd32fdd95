// HY_STEP: XOUT = X1 where t ≥ T0, else X0
#pragma once

#include "blocks/ports.hpp"
#include "blocks/ticks.hpp"

namespace hysteron {

struct StepReference {
  static constexpr About about{
      .name = "HY_STEP",
      .title = "Step reference",
      .group = Group::Control,
      .equation = "XOUT = X1 where t >= T0, else X0",
      .meaning =
          "Jumps from X0 to X1 at the time T0, counted from the first step with RUN TRUE, which has t = 0. T0 is exact "
          "in steps. RUN FALSE returns to X0 and starts the time again."};

  template <class S>
  struct Params {
    S X0;
    S X1;
    S T0;
    using Self = Params;
    static constexpr auto fields() {
      return Fields{
          HY_FIELD(X0).role(FieldRole::StartValue).in("'x").otherwise(0.0).means("value before the step"),
          HY_FIELD(X1).in("'x").otherwise(1.0).means("value after the step"),
          HY_FIELD(T0).role(FieldRole::StartValue).in("s").otherwise(0.0).at_least(0.0).means("time of the step")};
    }
  };
  template <class S>
  struct State {
    Int<S> COUNT;
    using Self = State;
    static constexpr auto fields() { return Fields{HY_FIELD(COUNT).otherwise(0.0).means("steps since the start")}; }
  };
  template <class S>
  struct In {
    Bool<S> RUN;
    using Self = In;
    static constexpr auto fields() {
      return Fields{HY_FIELD(RUN).otherwise(1.0).means("TRUE: time runs; FALSE: X0, and time starts again")};
    }
  };
  template <class S>
  using Out = Xout<S, "'x", "reference signal">;

  template <class S>
  static State<S> initial(const Params<S>& /*params*/) {
    return {.COUNT = Int<S>(0)};
  }
  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& state, const In<S>& in, const S& ts) {
    return {.XOUT = select(in.RUN && state.COUNT >= steps_in(params.T0, ts), params.X1, params.X0)};
  }
  template <class S>
  static void update(const Params<S>& /*params*/, State<S>& state, const In<S>& in, const Out<S>& /*out*/,
                     const S& /*ts*/) {
    state.COUNT = select(in.RUN, one_more(state.COUNT), Int<S>(0));
  }
};

}  // namespace hysteron
