// HY_EVEN_NONLINEARITY: XOUT = XIN + SIZE·((XIN − CENTRE)/REFERENCE)²
#pragma once

#include "blocks/nonlinearity.hpp"

namespace hysteron {

struct EvenNonlinearity : Nonlinearity {
  static constexpr About about{.name = "HY_EVEN_NONLINEARITY",
                               .title = "Even nonlinearity",
                               .group = Group::Shaping,
                               .equation = "XOUT = XIN + SIZE·((XIN − CENTRE)/REFERENCE)²",
                               .meaning =
                                   "An even error of a characteristic, the same on both sides of CENTRE: it bends the "
                                   "signal upwards or downwards. SIZE is the error at the distance REFERENCE from "
                                   "CENTRE. It is static: the same upwards and downwards, at every rate.",

                               .effect = "even_nonlinearity",
                               .family = Family::StaticCurve};

  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& /*state*/, const In<S>& in, const S& /*ts*/) {
    const S z = params.distance(in.XIN);
    return {.XOUT = with_term<S>(in.XIN, params.SIZE * (z * z))};
  }
};

}  // namespace hysteron
