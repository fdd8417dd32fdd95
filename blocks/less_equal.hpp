// HY_LE: Q = IN1 ≤ IN2
#pragma once

#include "blocks/ports.hpp"

namespace hysteron {

struct LessEqual : Stateless {
  static constexpr About about{.name = "HY_LE",
                               .title = "Less or equal",
                               .group = Group::Logic,
                               .equation = "Q = IN1 ≤ IN2",
                               .meaning =
                                   "Compares two signals of the same unit. FALSE where one of the two is not a number. "
                                   "Noise near equality makes Q chatter; HY_HYSTERESIS compares with a band.",
                               .source = "IEC 61131-3, LE"};

  template <class S>
  using In = TwoReals<S, "'x", "'x">;
  template <class S>
  using Out = Truth<S, "IN1 ≤ IN2">;

  template <class S>
  static Out<S> output(const Params<S>& /*params*/, const State<S>& /*state*/, const In<S>& in, const S& /*ts*/) {
    return {.Q = in.IN1 <= in.IN2};
  }
};

}  // namespace hysteron
