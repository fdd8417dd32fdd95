// HY_EQ: Q = IN1 = IN2
#pragma once

#include "blocks/ports.hpp"

namespace hysteron {

struct Equal : Stateless {
  static constexpr About about{
      .name = "HY_EQ",
      .title = "Equal",
      .group = Group::Logic,
      .equation = "Q = IN1 = IN2",
      .meaning =
          "Tells whether two signals are exactly equal. FALSE where one of the two is not a number. Computed reals are "
          "seldom exactly equal: to compare within a tolerance, take HY_ABS of the difference and HY_LE.",
      .source = "IEC 61131-3, EQ"};

  template <class S>
  using In = TwoReals<S, "'x", "'x">;
  template <class S>
  using Out = Truth<S, "IN1 = IN2">;

  template <class S>
  static Out<S> output(const Params<S>& /*params*/, const State<S>& /*state*/, const In<S>& in, const S& /*ts*/) {
    return {.Q = in.IN1 == in.IN2};
  }
};

}  // namespace hysteron
