// HY_RS: Q1(k) = NOT R1 AND (S OR Q1(k-1))
#pragma once

#include "blocks/ports.hpp"

namespace hysteron {

struct ResetDominantLatch {
  static constexpr About about{.name = "HY_RS",
                               .title = "Latch, reset dominant",
                               .group = Group::Logic,
                               .equation = "Q1(k) = NOT R1 AND (S OR Q1(k-1))",
                               .meaning =
                                   "Remembers that S was TRUE until R1 is. Where both are TRUE the reset wins, so a "
                                   "fault at R1 ends what S asks for. Starts FALSE.",
                               .source = "IEC 61131-3, RS"};

  template <class Scalar>
  using Params = NoFields<Scalar>;
  template <class Scalar>
  struct State {
    Bool<Scalar> HELD;
    using Self = State;
    static constexpr auto fields() { return std::tuple{HY_FIELD(HELD).otherwise(0.0).means("Q1 of the step before")}; }
  };
  template <class Scalar>
  struct In {
    Bool<Scalar> S;
    Bool<Scalar> R1;
    using Self = In;
    static constexpr auto fields() {
      return std::tuple{HY_FIELD(S).means("set"), HY_FIELD(R1).means("reset, dominant")};
    }
  };
  template <class Scalar>
  struct Out {
    Bool<Scalar> Q1;
    using Self = Out;
    static constexpr auto fields() { return std::tuple{HY_FIELD(Q1).means("TRUE from a set to a reset")}; }
  };

  template <class Scalar>
  static State<Scalar> initial(const Params<Scalar>& /*params*/) {
    return {.HELD = Bool<Scalar>(false)};
  }
  template <class Scalar>
  static Out<Scalar> output(const Params<Scalar>& /*params*/, const State<Scalar>& state, const In<Scalar>& in,
                            const Scalar& /*ts*/) {
    return {.Q1 = !in.R1 && (in.S || state.HELD)};
  }
  template <class Scalar>
  static void update(const Params<Scalar>& /*params*/, State<Scalar>& state, const In<Scalar>& /*in*/,
                     const Out<Scalar>& out, const Scalar& /*ts*/) {
    state.HELD = out.Q1;
  }
};

}  // namespace hysteron
