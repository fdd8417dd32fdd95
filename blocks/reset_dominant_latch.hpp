// HY_RS: Q1(k) = NOT R1 AND (S OR Q1(k-1))
#pragma once

#include "blocks/latch.hpp"

namespace hysteron {

struct ResetDominantLatch : Latch {
  static constexpr About about{.name = "HY_RS",
                               .title = "Latch, reset dominant",
                               .group = Group::Logic,
                               .equation = "Q1(k) = NOT R1 AND (S OR Q1(k-1))",
                               .meaning =
                                   "Remembers that S was TRUE until R1 is. Where both are TRUE the reset wins, so a "
                                   "fault at R1 ends what S asks for. Starts FALSE.",
                               .source = "IEC 61131-3, RS"};

  template <class Scalar>
  struct In {
    Bool<Scalar> S;
    Bool<Scalar> R1;
    using Self = In;
    static constexpr auto fields() { return Fields{HY_FIELD(S).means("set"), HY_FIELD(R1).means("reset, dominant")}; }
  };

  template <class Scalar>
  static Out<Scalar> output(const Params<Scalar>& /*params*/, const State<Scalar>& state, const In<Scalar>& in,
                            const Scalar& /*ts*/) {
    return {.Q1 = !in.R1 && (in.S || state.HELD)};
  }
};

}  // namespace hysteron
