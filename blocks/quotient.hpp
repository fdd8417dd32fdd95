// HY_QUOTIENT: XOUT = IN1/IN2
#pragma once

#include "blocks/ports.hpp"

namespace hysteron {

struct Quotient : Stateless {
  static constexpr About about{.name = "HY_QUOTIENT",
                               .title = "Quotient",
                               .group = Group::Arithmetic,
                               .equation = "XOUT = IN1/IN2",
                               .meaning =
                                   "Divides two signals; the unit of the output is that of IN1 over that of IN2. Where "
                                   "IN2 is zero XOUT is 0 and ERROR is TRUE: no division by zero is ever carried out.",
                               .source = "IEC 61131-3, DIV"};

  template <class S>
  using In = TwoReals<S, "'x", "'y">;
  template <class S>
  using Out = CheckedXout<S, "'x/'y", "quotient">;

  template <class S>
  static Out<S> output(const Params<S>& /*params*/, const State<S>& /*state*/, const In<S>& in, const S& /*ts*/) {
    const Bool<S> error = in.IN2 == S(0.0);
    return Out<S>::of(in.IN1 / select(error, S(1.0), in.IN2), error, fault::zero_divisor);
  }
};

}  // namespace hysteron
