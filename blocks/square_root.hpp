// HY_SQRT: XOUT = √XIN
#pragma once

#include "blocks/ports.hpp"

namespace hysteron {

struct SquareRoot : Stateless {
  static constexpr About about{.name = "HY_SQRT",
                               .title = "Square root",
                               .group = Group::Function,
                               .equation = "XOUT = √XIN",
                               .meaning =
                                   "Square root of a signal that is not negative. Below zero XOUT is 0 and ERROR is "
                                   "TRUE. The unit of the output is the root of that of the input.",
                               .source = "IEC 61131-3, SQRT"};

  template <class S>
  using In = Xin<S, "'x", "signal, not negative">;
  template <class S>
  using Out = CheckedXout<S, "'x^(1/2)", "root of XIN">;

  template <class S>
  static Out<S> output(const Params<S>& /*params*/, const State<S>& /*state*/, const In<S>& in, const S& /*ts*/) {
    const Bool<S> error = in.XIN < S(0.0);
    return Out<S>::of(sqrt(select(error, S(0.0), in.XIN)), error, fault::outside_domain);
  }
};

}  // namespace hysteron
