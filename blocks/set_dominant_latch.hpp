// HY_SR: Q1(k) = S1 OR (NOT R AND Q1(k-1))
#pragma once

#include "blocks/latch.hpp"

namespace hysteron {

struct SetDominantLatch : Latch {
  static constexpr About about{
      .name = "HY_SR",
      .title = "Latch, set dominant",
      .group = Group::Logic,
      .equation = "Q1(k) = S1 OR (NOT R AND Q1(k-1))",
      .meaning = "Remembers that S1 was TRUE until R is. Where both are TRUE the set wins. Starts FALSE.",
      .source = "IEC 61131-3, SR"};

  template <class Scalar>
  struct In {
    Bool<Scalar> S1;
    Bool<Scalar> R;
    using Self = In;
    static constexpr auto fields() { return Fields{HY_FIELD(S1).means("set, dominant"), HY_FIELD(R).means("reset")}; }
  };

  template <class Scalar>
  static Out<Scalar> output(const Params<Scalar>& /*params*/, const State<Scalar>& state, const In<Scalar>& in,
                            const Scalar& /*ts*/) {
    return {.Q1 = in.S1 || (!in.R && state.HELD)};
  }
};

}  // namespace hysteron
