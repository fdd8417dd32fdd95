// HY_EXP: XOUT = e^XIN
#pragma once

#include "blocks/ports.hpp"

namespace hysteron {

struct Exponential : Stateless {
  static constexpr About about{
      .name = "HY_EXP",
      .title = "Exponential",
      .group = Group::Function,
      .equation = "XOUT = e^XIN",
      .meaning = "The natural exponential. Above XIN = 709 (LREAL) or 88 (REAL) the result is infinite.",
      .source = "IEC 61131-3, EXP"};

  template <class S>
  using In = Xin<S, "1", "exponent">;
  template <class S>
  using Out = Xout<S, "1", "e to the power XIN">;

  template <class S>
  static Out<S> output(const Params<S>& /*params*/, const State<S>& /*state*/, const In<S>& in, const S& /*ts*/) {
    return {.XOUT = exp(in.XIN)};
  }
};

}  // namespace hysteron
