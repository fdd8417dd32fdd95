// HY_NOT: Q = NOT IN1
#pragma once

#include "blocks/ports.hpp"

namespace hysteron {

struct Not : Stateless {
  static constexpr About about{.name = "HY_NOT",
                               .title = "Not",
                               .group = Group::Logic,
                               .equation = "Q = NOT IN1",
                               .meaning = "Turns a truth value round. In a diagram the operator NOT does the same.",
                               .source = "IEC 61131-3, NOT"};

  template <class S>
  struct In {
    Bool<S> IN1;
    using Self = In;
    static constexpr auto fields() { return Fields{HY_FIELD(IN1).means("operand")}; }
  };
  template <class S>
  using Out = Truth<S, "the opposite of IN1">;

  template <class S>
  static Out<S> output(const Params<S>& /*params*/, const State<S>& /*state*/, const In<S>& in, const S& /*ts*/) {
    return {.Q = !in.IN1};
  }
};

}  // namespace hysteron
