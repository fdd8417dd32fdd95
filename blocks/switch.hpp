// HY_SWITCH: XOUT = IN1 where G, else IN0
#pragma once

#include "blocks/ports.hpp"

namespace hysteron {

struct Switch : Stateless {
  static constexpr About about{.name = "HY_SWITCH",
                               .title = "Switch",
                               .group = Group::Shaping,
                               .equation = "XOUT = IN1 where G, else IN0",
                               .meaning =
                                   "Passes one of two signals of the same unit. Both are computed in every step, "
                                   "whichever is chosen, and the output jumps at the change; put HY_RATE_LIMIT behind "
                                   "it where that would hurt. The pins are those of the standard's SEL.",
                               .source = "IEC 61131-3, SEL"};

  template <class S>
  struct In {
    Bool<S> G;
    S IN0;
    S IN1;
    using Self = In;
    static constexpr auto fields() {
      return Fields{HY_FIELD(G).means("chooses IN1 while TRUE, IN0 while FALSE"),
                    HY_FIELD(IN0).in("'x").means("signal while G is FALSE"),
                    HY_FIELD(IN1).in("'x").means("signal while G is TRUE")};
    }
  };
  template <class S>
  using Out = Xout<S, "'x", "the chosen signal">;

  template <class S>
  static Out<S> output(const Params<S>& /*params*/, const State<S>& /*state*/, const In<S>& in, const S& /*ts*/) {
    return {.XOUT = select(in.G, in.IN1, in.IN0)};
  }
};

}  // namespace hysteron
