// HY_TAN: XOUT = tan XIN
#pragma once

#include "blocks/ports.hpp"

namespace hysteron {

struct Tangent : Stateless {
  static constexpr About about{.name = "HY_TAN",
                               .title = "Tangent",
                               .group = Group::Function,
                               .equation = "XOUT = tan XIN",
                               .meaning =
                                   "Tangent of an angle in radians. It has poles at odd multiples of π/2, where the "
                                   "result is very large but finite.",
                               .source = "IEC 61131-3, TAN"};

  template <class S>
  using In = Xin<S, "rad", "angle">;
  template <class S>
  using Out = Xout<S, "1", "tangent of XIN">;

  template <class S>
  static Out<S> output(const Params<S>& /*params*/, const State<S>& /*state*/, const In<S>& in, const S& /*ts*/) {
    return {.XOUT = tan(in.XIN)};
  }
};

}  // namespace hysteron
