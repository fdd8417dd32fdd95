// HY_OR: Q = IN1 OR IN2 OR IN3 OR IN4
#pragma once

#include "blocks/ports.hpp"

namespace hysteron {

struct Or : Stateless {
  static constexpr About about{
      .name = "HY_OR",
      .title = "Or",
      .group = Group::Logic,
      .equation = "Q = IN1 OR IN2 OR IN3 OR IN4",
      .meaning = "TRUE where at least one input is. IN3 and IN4 are FALSE where they are not connected.",
      .source = "IEC 61131-3, OR"};

  template <class S>
  using In = FourBools<S, 0>;
  template <class S>
  using Out = Truth<S, "at least one of the inputs">;

  template <class S>
  static Out<S> output(const Params<S>& /*params*/, const State<S>& /*state*/, const In<S>& in, const S& /*ts*/) {
    return {.Q = in.IN1 || in.IN2 || in.IN3 || in.IN4};
  }
};

}  // namespace hysteron
