// HY_EVEN_NONLINEARITY: XOUT = XIN + SIZE·((XIN − CENTRE)/REFERENCE)²
#pragma once

#include "blocks/effect_term.hpp"
#include "blocks/ports.hpp"

namespace hysteron {

struct EvenNonlinearity : Stateless {
  static constexpr About about{.name = "HY_EVEN_NONLINEARITY",
                               .title = "Even nonlinearity",
                               .group = Group::Shaping,
                               .equation = "XOUT = XIN + SIZE·((XIN − CENTRE)/REFERENCE)²",
                               .meaning =
                                   "An even error of a characteristic, the same on both sides of CENTRE: it bends the "
                                   "signal upwards or downwards. SIZE is the error at the distance REFERENCE from "
                                   "CENTRE. It is static: the same upwards and downwards, at every rate.",

                               .effect = "even_nonlinearity"};

  template <class S>
  struct Params {
    S SIZE;
    S CENTRE;
    S REFERENCE;
    using Self = Params;
    static constexpr auto fields() {
      return std::tuple{HY_FIELD(SIZE).in("'x").otherwise(0.0).neutral_at(0.0).means("error at the distance REFERENCE"),
                        HY_FIELD(CENTRE).in("'x").otherwise(0.0).means("signal without error"),
                        HY_FIELD(REFERENCE).in("'x").above(0.0).otherwise(1.0).means(
                            "distance from CENTRE at which the error is SIZE")};
    }
  };
  template <class S>
  using In = Xin<S, "'x", "signal">;
  template <class S>
  using Out = Xout<S, "'x", "signal with the error">;

  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& /*state*/, const In<S>& in, const S& /*ts*/) {
    const S z = (in.XIN - params.CENTRE) / params.REFERENCE;
    return {.XOUT = with_term<S>(in.XIN, params.SIZE * (z * z))};
  }
};

}  // namespace hysteron
