// HY_ODD_NONLINEARITY: XOUT = XIN + SIZE·((XIN − CENTRE)/REFERENCE)³
#pragma once

#include "blocks/nonlinearity.hpp"

namespace hysteron {

struct OddNonlinearity : Nonlinearity {
  static constexpr About about{.name = "HY_ODD_NONLINEARITY",
                               .title = "Odd nonlinearity",
                               .group = Group::Shaping,
                               .equation = "XOUT = XIN + SIZE·((XIN − CENTRE)/REFERENCE)³",
                               .meaning =
                                   "An odd error of a characteristic, opposite on the two sides of CENTRE: it stiffens "
                                   "or softens towards the ends. SIZE is the error at the distance REFERENCE from "
                                   "CENTRE. It is static: the same upwards and downwards, at every rate.",

                               .effect = "odd_nonlinearity",
                               .family = Family::StaticCurve};

  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& /*state*/, const In<S>& in, const S& /*ts*/) {
    const S z = params.distance(in.XIN);
    return {.XOUT = with_term<S>(in.XIN, params.SIZE * (z * z * z))};
  }
};

}  // namespace hysteron
