// HY_XOR: Q = IN1 XOR IN2
#pragma once

#include "blocks/ports.hpp"

namespace hysteron {

struct Xor : Stateless {
  static constexpr About about{.name = "HY_XOR",
                               .title = "Exclusive or",
                               .group = Group::Logic,
                               .equation = "Q = IN1 XOR IN2",
                               .meaning = "TRUE where exactly one of the two inputs is.",
                               .source = "IEC 61131-3, XOR"};

  template <class S>
  using In = TwoBools<S>;
  template <class S>
  using Out = Truth<S, "exactly one of the inputs">;

  template <class S>
  static Out<S> output(const Params<S>& /*params*/, const State<S>& /*state*/, const In<S>& in, const S& /*ts*/) {
    return {.Q = in.IN1 != in.IN2};
  }
};

}  // namespace hysteron
