// What the two latches share: all but which of their inputs dominates.
#pragma once

#include "blocks/ports.hpp"

namespace hysteron {

struct Latch {
  template <class Scalar>
  using Params = NoFields<Scalar>;
  template <class Scalar>
  struct State {
    Bool<Scalar> HELD;
    using Self = State;
    static constexpr auto fields() { return Fields{HY_FIELD(HELD).otherwise(0.0).means("Q1 of the step before")}; }
  };
  template <class Scalar>
  struct Out {
    Bool<Scalar> Q1;
    using Self = Out;
    static constexpr auto fields() { return Fields{HY_FIELD(Q1).means("TRUE from a set to a reset")}; }
  };

  template <class Scalar>
  static State<Scalar> initial(const Params<Scalar>& /*params*/) {
    return {.HELD = Bool<Scalar>(false)};
  }
  template <class Scalar, class In>
  static void update(const Params<Scalar>& /*params*/, State<Scalar>& state, const In& /*in*/, const Out<Scalar>& out,
                     const Scalar& /*ts*/) {
    state.HELD = out.Q1;
  }
};

}  // namespace hysteron
