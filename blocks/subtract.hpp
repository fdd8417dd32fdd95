// HY_SUBTRACT: XOUT = IN1 - IN2
#pragma once

#include "blocks/ports.hpp"

namespace hysteron {

struct Subtract : Stateless {
  static constexpr About about{.name = "HY_SUBTRACT",
                               .title = "Difference",
                               .group = Group::Arithmetic,
                               .equation = "XOUT = IN1 - IN2",
                               .meaning =
                                   "Subtracts the second signal from the first, as at the comparing point of a loop: "
                                   "set point minus measurement.",
                               .source = "IEC 61131-3, SUB"};

  template <class S>
  using In = TwoReals<S, "'x", "'x">;
  template <class S>
  using Out = Xout<S, "'x", "difference">;

  template <class S>
  static Out<S> output(const Params<S>& /*params*/, const State<S>& /*state*/, const In<S>& in, const S& /*ts*/) {
    return {.XOUT = in.IN1 - in.IN2};
  }
};

}  // namespace hysteron
