// HY_QUANTIZER: XOUT = QUANTUM·round(XIN/QUANTUM)
#pragma once

#include "blocks/ports.hpp"
#include "blocks/rounding.hpp"

namespace hysteron {

struct Quantizer : Stateless {
  static constexpr About about{.name = "HY_QUANTIZER",
                               .title = "Quantizer",
                               .group = Group::Shaping,
                               .equation = "XOUT = QUANTUM·round(XIN/QUANTUM)",
                               .meaning =
                                   "Rounds a signal to the nearest whole multiple of QUANTUM, halves away from zero: "
                                   "the resolution of a converter or an encoder. The error is at most QUANTUM/2. A "
                                   "signal beyond 2^31 quanta, and any signal where QUANTUM is 0, passes as it is.",
                               .effect = "quantization"};

  template <class S>
  struct Params {
    S QUANTUM;
    using Self = Params;
    static constexpr auto fields() {
      return std::tuple{
          HY_FIELD(QUANTUM).in("'x").otherwise(0.0).at_least(0.0).neutral_at(0.0).means("smallest step of the output")};
    }
  };
  template <class S>
  using In = Xin<S, "'x", "signal">;
  template <class S>
  using Out = Xout<S, "'x", "signal in whole multiples of QUANTUM">;

  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& /*state*/, const In<S>& in, const S& /*ts*/) {
    const Bool<S> coarse = params.QUANTUM > S(0.0);
    const S quanta = in.XIN / select(coarse, params.QUANTUM, S(1.0));
    const Bool<S> countable = coarse && abs(quanta) < S(2147483000.0);
    return {.XOUT = select(countable, params.QUANTUM * to_real<S>(nearest(quanta)), in.XIN)};
  }
};

}  // namespace hysteron
