// HY_SIGN: XOUT = 1 where XIN > 0, -1 where XIN < 0, else 0
#pragma once

#include "blocks/ports.hpp"

namespace hysteron {

struct Sign : Stateless {
  static constexpr About about{
      .name = "HY_SIGN",
      .title = "Sign",
      .group = Group::Function,
      .equation = "XOUT = 1 where XIN > 0, -1 where XIN < 0, else 0",
      .meaning =
          "Gives the direction of a signal. Exactly zero, and a value that is not a number, give 0. For a direction "
          "that noise shall not flip use HY_BRANCH with its dead band."};

  template <class S>
  using In = Xin<S, "'x", "signal">;
  template <class S>
  using Out = Xout<S, "1", "-1, 0 or 1">;

  template <class S>
  static Out<S> output(const Params<S>& /*params*/, const State<S>& /*state*/, const In<S>& in, const S& /*ts*/) {
    return {.XOUT = select(in.XIN > S(0.0), S(1.0), select(in.XIN < S(0.0), S(-1.0), S(0.0)))};
  }
};

}  // namespace hysteron
