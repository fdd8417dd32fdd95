// HY_SIN: XOUT = sin XIN
#pragma once

#include "blocks/ports.hpp"

namespace hysteron {

struct Sine : Stateless {
  static constexpr About about{.name = "HY_SIN",
                               .title = "Sine",
                               .group = Group::Function,
                               .equation = "XOUT = sin XIN",
                               .meaning =
                                   "Sine of an angle in radians. For a reference that runs for days use HY_SINE, which "
                                   "keeps its phase; an angle that grows without end loses digits.",
                               .source = "IEC 61131-3, SIN"};

  template <class S>
  using In = Xin<S, "rad", "angle">;
  template <class S>
  using Out = Xout<S, "1", "sine of XIN">;

  template <class S>
  static Out<S> output(const Params<S>& /*params*/, const State<S>& /*state*/, const In<S>& in, const S& /*ts*/) {
    return {.XOUT = sin(in.XIN)};
  }
};

}  // namespace hysteron
