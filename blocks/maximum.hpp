// HY_MAX: XOUT = max(IN1, IN2)
#pragma once

#include "blocks/ports.hpp"

namespace hysteron {

struct Maximum : Stateless {
  static constexpr About about{
      .name = "HY_MAX",
      .title = "Larger of two",
      .group = Group::Function,
      .equation = "XOUT = max(IN1, IN2)",
      .meaning = "Passes the larger of two signals. IN1 passes where they are equal and where IN2 is not a number.",
      .source = "IEC 61131-3, MAX"};

  template <class S>
  using In = TwoReals<S, "'x", "'x">;
  template <class S>
  using Out = Xout<S, "'x", "larger of the two">;

  template <class S>
  static Out<S> output(const Params<S>& /*params*/, const State<S>& /*state*/, const In<S>& in, const S& /*ts*/) {
    return {.XOUT = max(in.IN1, in.IN2)};
  }
};

}  // namespace hysteron
