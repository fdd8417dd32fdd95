// HY_ABS: XOUT = |XIN|
#pragma once

#include "blocks/ports.hpp"

namespace hysteron {

struct Absolute : Stateless {
  static constexpr About about{.name = "HY_ABS",
                               .title = "Absolute value",
                               .group = Group::Function,
                               .equation = "XOUT = |XIN|",
                               .meaning =
                                   "Gives the magnitude of a signal, without its sign. The derivative jumps at zero; a "
                                   "fit that depends on it there is not smooth.",
                               .source = "IEC 61131-3, ABS"};

  template <class S>
  using In = Xin<S, "'x", "signal">;
  template <class S>
  using Out = Xout<S, "'x", "magnitude of XIN">;

  template <class S>
  static Out<S> output(const Params<S>& /*params*/, const State<S>& /*state*/, const In<S>& in, const S& /*ts*/) {
    return {.XOUT = abs(in.XIN)};
  }
};

}  // namespace hysteron
