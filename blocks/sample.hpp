// HY_SAMPLE: XOUT = XIN, at the instants of the slower part
#pragma once

#include "blocks/ports.hpp"

namespace hysteron {

struct Sample : Stateless {
  static constexpr About about{
      .name = "HY_SAMPLE",
      .title = "Sample, from a fast part into a slow one",
      .group = Group::Rate,
      .equation = "XOUT = XIN, at the instants of the slower part",
      .meaning =
          "The border at which a slower part (@every) reads a signal of a faster one: the slower part sees every "
          "n-th sample. What lies between is not averaged: filter it first, with HY_LAG say, where it holds "
          "frequencies above half the slower rate. Within one rate it changes nothing.",
      .delay = "None; frequencies above half the slower rate fold down.",
      .rate_transition = true};

  template <class S>
  using In = Xin<S, "'x", "signal of the faster part">;
  template <class S>
  using Out = Xout<S, "'x", "the same signal at the slower rate">;

  template <class S>
  static Out<S> output(const Params<S>& /*params*/, const State<S>& /*state*/, const In<S>& in, const S& /*ts*/) {
    return {.XOUT = in.XIN};
  }
};

}  // namespace hysteron
