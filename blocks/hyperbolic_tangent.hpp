// HY_TANH: XOUT = tanh XIN
#pragma once

#include "blocks/ports.hpp"

namespace hysteron {

struct HyperbolicTangent : Stateless {
  static constexpr About about{
      .name = "HY_TANH",
      .title = "Hyperbolic tangent",
      .group = Group::Function,
      .equation = "XOUT = (e^XIN - e^-XIN)/(e^XIN + e^-XIN)",
      .meaning =
          "A soft limit between -1 and 1 with slope 1 at zero. Accurate to a few units in the last place everywhere: "
          "it neither overflows at large arguments nor cancels at small ones. Structured Text has no TANH; here it is "
          "built from EXP, equal on every target.",
      .source = "J. H. Lambert's continued fraction below |XIN| = 1/2"};

  template <class S>
  using In = Xin<S, "1", "argument">;
  template <class S>
  using Out = Xout<S, "1", "hyperbolic tangent of XIN, between -1 and 1">;

  template <class S>
  static Out<S> output(const Params<S>& /*params*/, const State<S>& /*state*/, const In<S>& in, const S& /*ts*/) {
    // |x| ≥ 1/2: tanh|x| = (1 − e^(−2|x|))/(1 + e^(−2|x|)), where nothing cancels.
    const S decay = exp(S(-2.0) * abs(in.XIN));
    const S large = (S(1.0) - decay) / (S(1.0) + decay);
    const S small = near_zero(max(min(in.XIN, S(0.5)), S(-0.5)));
    return {.XOUT = select(abs(in.XIN) < S(0.5), small, select(in.XIN < S(0.0), -large, large))};
  }

 private:
  /// tanh x = x/(1 + x²/(3 + x²/(5 + … x²/15))) for |x| ≤ 1/2, where the rest is below 1e-17: numerator and denominator
  /// by their recurrence A_k = (2k + 1)·A_(k−1) + x²·A_(k−2), and one division.
  template <class S>
  static S near_zero(const S& x) {
    const S square = x * x;
    S above_before = S(0.0);
    S above = x;
    S below_before = S(1.0);
    S below = S(1.0);
    for (int k = 1; k <= 7; ++k) {
      const S odd = S(2.0 * k + 1.0);
      const S next_above = odd * above + square * above_before;
      const S next_below = odd * below + square * below_before;
      above_before = above;
      above = next_above;
      below_before = below;
      below = next_below;
    }
    return above / below;
  }
};

}  // namespace hysteron
