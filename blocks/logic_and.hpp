// HY_AND: Q = IN1 AND IN2 AND IN3 AND IN4
#pragma once

#include "blocks/ports.hpp"

namespace hysteron {

struct And : Stateless {
  static constexpr About about{
      .name = "HY_AND",
      .title = "And",
      .group = Group::Logic,
      .equation = "Q = IN1 AND IN2 AND IN3 AND IN4",
      .meaning = "TRUE where all inputs are. IN3 and IN4 are TRUE where they are not connected.",
      .source = "IEC 61131-3, AND"};

  template <class S>
  using In = FourBools<S, 1>;
  template <class S>
  using Out = Truth<S, "all of the inputs">;

  template <class S>
  static Out<S> output(const Params<S>& /*params*/, const State<S>& /*state*/, const In<S>& in, const S& /*ts*/) {
    return {.Q = in.IN1 && in.IN2 && in.IN3 && in.IN4};
  }
};

}  // namespace hysteron
