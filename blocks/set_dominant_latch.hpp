// HY_SR: Q1(k) = S1 OR (NOT R AND Q1(k-1))
#pragma once

#include "blocks/ports.hpp"

namespace hysteron {

struct SetDominantLatch {
  static constexpr About about{
      .name = "HY_SR",
      .title = "Latch, set dominant",
      .group = Group::Logic,
      .equation = "Q1(k) = S1 OR (NOT R AND Q1(k-1))",
      .meaning = "Remembers that S1 was TRUE until R is. Where both are TRUE the set wins. Starts FALSE.",
      .source = "IEC 61131-3, SR"};

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
    Bool<Scalar> S1;
    Bool<Scalar> R;
    using Self = In;
    static constexpr auto fields() {
      return std::tuple{HY_FIELD(S1).means("set, dominant"), HY_FIELD(R).means("reset")};
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
    return {.Q1 = in.S1 || (!in.R && state.HELD)};
  }
  template <class Scalar>
  static void update(const Params<Scalar>& /*params*/, State<Scalar>& state, const In<Scalar>& /*in*/,
                     const Out<Scalar>& out, const Scalar& /*ts*/) {
    state.HELD = out.Q1;
  }
};

}  // namespace hysteron
