// HY_POWER: XOUT = XIN^EXPONENT
#pragma once

#include "blocks/ports.hpp"

namespace hysteron {

struct PowerFunction : Stateless {
  static constexpr About about{
      .name = "HY_POWER",
      .title = "Power",
      .group = Group::Function,
      .equation = "XOUT = XIN^EXPONENT",
      .meaning =
          "Raises a signal to a constant power, which can be tuned. A negative signal needs a whole exponent (below "
          "2^31 in magnitude), and zero an exponent that is not negative; elsewhere XOUT is 0 and ERROR is TRUE. The "
          "exponents 0, 1/2, 1 and 2 cost no call of pow. The unit of the output is not checked.",
      .source = "IEC 61131-3, EXPT"};

  template <class S>
  struct Params {
    S EXPONENT;
    using Self = Params;
    static constexpr auto fields() { return Fields{HY_FIELD(EXPONENT).in("1").otherwise(1.0).means("exponent")}; }
  };
  template <class S>
  using In = Xin<S, "", "base, in any unit">;
  template <class S>
  using Out = CheckedXout<S, "", "XIN to the power EXPONENT, its unit to that power">;

  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& /*state*/, const In<S>& in, const S& /*ts*/) {
    const S& exponent = params.EXPONENT;
    const Bool<S> whole = exponent == to_real<S>(to_int(exponent));
    const Bool<S> error = (in.XIN < S(0.0) && !whole) || (in.XIN == S(0.0) && exponent < S(0.0));
    return Out<S>::of(power(select(error, S(1.0), in.XIN), exponent), error, fault::outside_domain);
  }
};

}  // namespace hysteron
