// HY_QUANTIZER: XOUT = QUANTUM·round(XIN/QUANTUM), or the mean of such with thresholds apart
#pragma once

#include "blocks/ports.hpp"
#include "blocks/rounding.hpp"

namespace hysteron {

struct Quantizer : Stateless {
  static constexpr About about{.name = "HY_QUANTIZER",
                               .title = "Quantizer",
                               .group = Group::Shaping,
                               .equation = "XOUT = QUANTUM·round(XIN/QUANTUM), or its mean over XIN/QUANTUM ± SPREAD",
                               .meaning =
                                   "Rounds a signal to the nearest whole multiple of QUANTUM, halves away from zero: "
                                   "the resolution of a converter or an encoder. The error is at most QUANTUM/2. A "
                                   "signal beyond 2^31 quanta, and any signal where QUANTUM is 0, passes as it is. "
                                   "With SPREAD each threshold is spread evenly over the share SPREAD of a quantum to "
                                   "either side, and the output is the mean, a ramp in place of a jump: what a "
                                   "converter with uneven codes, or with noise in front of it, gives in the mean.",
                               .effect = "quantization",
                               .family = Family::Logging};

  template <class S>
  struct Params {
    S QUANTUM;
    S SPREAD;
    using Self = Params;
    static constexpr auto fields() {
      return Fields{HY_FIELD(QUANTUM)
                        .role(FieldRole::Quantum)
                        .in("'x")
                        .otherwise(0.0)
                        .at_least(0.0)
                        .neutral_at(0.0)
                        .means("step of the output"),
                    HY_FIELD(SPREAD)
                        .role(FieldRole::Softness)
                        .in("1")
                        .within(0.0, 0.4)
                        .otherwise(0.0)
                        .means("share of QUANTUM by which thresholds lie lower or higher; 0 for even steps")};
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
    const S code = to_real<S>(nearest(quanta));
    const S rest = quanta - code;
    const Bool<S> even = params.SPREAD == S(0.0);
    const S beyond = max(abs(rest) - (S(0.5) - params.SPREAD), S(0.0)) / select(even, S(1.0), S(2.0) * params.SPREAD);
    const S ramp = select(rest < S(0.0), -beyond, beyond);
    return {.XOUT = select(countable, params.QUANTUM * (code + ramp), in.XIN)};
  }
};

}  // namespace hysteron
