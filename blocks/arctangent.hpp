// HY_ATAN: XOUT = arctan XIN
#pragma once

#include "blocks/ports.hpp"

namespace hysteron {

struct Arctangent : Stateless {
  static constexpr About about{
      .name = "HY_ATAN",
      .title = "Arctangent",
      .group = Group::Function,
      .equation = "XOUT = arctan XIN",
      .meaning =
          "The angle between -π/2 and π/2 whose tangent is XIN. Use it also as a soft limit of a dimensionless signal.",
      .source = "IEC 61131-3, ATAN"};

  template <class S>
  using In = Xin<S, "1", "tangent">;
  template <class S>
  using Out = Xout<S, "rad", "angle, between -π/2 and π/2">;

  template <class S>
  static Out<S> output(const Params<S>& /*params*/, const State<S>& /*state*/, const In<S>& in, const S& /*ts*/) {
    return {.XOUT = atan(in.XIN)};
  }
};

}  // namespace hysteron
