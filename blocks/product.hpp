// HY_PRODUCT: XOUT = IN1·IN2
#pragma once

#include "blocks/ports.hpp"

namespace hysteron {

struct Product : Stateless {
  static constexpr About about{.name = "HY_PRODUCT",
                               .title = "Product",
                               .group = Group::Arithmetic,
                               .equation = "XOUT = IN1·IN2",
                               .meaning =
                                   "Multiplies two signals; the unit of the output is the product of their units. For "
                                   "a constant factor HY_GAIN can be tuned.",
                               .source = "IEC 61131-3, MUL"};

  template <class S>
  using In = TwoReals<S, "'x", "'y">;
  template <class S>
  using Out = Xout<S, "'x*'y", "product">;

  template <class S>
  static Out<S> output(const Params<S>& /*params*/, const State<S>& /*state*/, const In<S>& in, const S& /*ts*/) {
    return {.XOUT = in.IN1 * in.IN2};
  }
};

}  // namespace hysteron
