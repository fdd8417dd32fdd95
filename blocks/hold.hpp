// HY_HOLD: XOUT = XIN, held until the slower part runs again
#pragma once

#include "blocks/ports.hpp"

namespace hysteron {

struct Hold : Stateless {
  static constexpr About about{
      .name = "HY_HOLD",
      .title = "Hold, from a slow part into a fast one",
      .group = Group::Rate,
      .equation = "XOUT = XIN, held until the slower part runs again",
      .meaning =
          "The border at which a faster part reads a signal of a slower one (@every): the value stands until the "
          "slower part runs again. Within one rate it changes nothing.",
      .delay = "On average half a period of the slower part; gain sin(w/2)/(w/2) at w rad per slow sample.",
      .rate_transition = true};

  template <class S>
  using In = Xin<S, "'x", "signal of the slower part">;
  template <class S>
  using Out = Xout<S, "'x", "the same signal, held at the faster rate">;

  template <class S>
  static Out<S> output(const Params<S>& /*params*/, const State<S>& /*state*/, const In<S>& in, const S& /*ts*/) {
    return {.XOUT = in.XIN};
  }
};

}  // namespace hysteron
