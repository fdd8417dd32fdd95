// HY_LN: XOUT = ln XIN
#pragma once

#include "blocks/ports.hpp"

namespace hysteron {

struct Logarithm : Stateless {
  static constexpr About about{
      .name = "HY_LN",
      .title = "Natural logarithm",
      .group = Group::Function,
      .equation = "XOUT = ln XIN",
      .meaning =
          "Natural logarithm of a dimensionless signal above zero. At zero and below XOUT is 0 and ERROR is TRUE; "
          "divide by a reference value first where the signal carries a unit.",
      .source = "IEC 61131-3, LN"};

  template <class S>
  using In = Xin<S, "1", "signal, above zero">;
  template <class S>
  using Out = CheckedXout<S, "1", "logarithm of XIN">;

  template <class S>
  static Out<S> output(const Params<S>& /*params*/, const State<S>& /*state*/, const In<S>& in, const S& /*ts*/) {
    const Bool<S> error = in.XIN <= S(0.0);
    return Out<S>::of(log(select(error, S(1.0), in.XIN)), error, fault::outside_domain);
  }
};

}  // namespace hysteron
