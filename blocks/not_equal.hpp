// HY_NE: Q = IN1 ≠ IN2
#pragma once

#include "blocks/ports.hpp"

namespace hysteron {

struct NotEqual : Stateless {
  static constexpr About about{
      .name = "HY_NE",
      .title = "Not equal",
      .group = Group::Logic,
      .equation = "Q = IN1 ≠ IN2",
      .meaning =
          "Tells whether two signals differ at all. TRUE where one of the two is not a number. Computed reals nearly "
          "always differ: to compare within a tolerance, take HY_ABS of the difference and HY_GT.",
      .source = "IEC 61131-3, NE"};

  template <class S>
  using In = TwoReals<S, "'x", "'x">;
  template <class S>
  using Out = Truth<S, "IN1 ≠ IN2">;

  template <class S>
  static Out<S> output(const Params<S>& /*params*/, const State<S>& /*state*/, const In<S>& in, const S& /*ts*/) {
    return {.Q = in.IN1 != in.IN2};
  }
};

}  // namespace hysteron
