// HY_COS: XOUT = cos XIN
#pragma once

#include "blocks/ports.hpp"

namespace hysteron {

struct Cosine : Stateless {
  static constexpr About about{
      .name = "HY_COS",
      .title = "Cosine",
      .group = Group::Function,
      .equation = "XOUT = cos XIN",
      .meaning = "Cosine of an angle in radians. An angle that grows without end loses digits.",
      .source = "IEC 61131-3, COS"};

  template <class S>
  using In = Xin<S, "rad", "angle">;
  template <class S>
  using Out = Xout<S, "1", "cosine of XIN">;

  template <class S>
  static Out<S> output(const Params<S>& /*params*/, const State<S>& /*state*/, const In<S>& in, const S& /*ts*/) {
    return {.XOUT = cos(in.XIN)};
  }
};

}  // namespace hysteron
