// HY_GAIN: XOUT = K·XIN
#pragma once

#include "blocks/description.hpp"

namespace hysteron {

struct Gain {
  static constexpr About about{
      .name = "HY_GAIN",
      .title = "Gain",
      .group = Group::Arithmetic,
      .equation = "XOUT = K·XIN",
      .meaning = "Multiplies a signal by a constant. K carries the unit of the output over that of the input.",
      .effect = "gain_error",
      .family = Family::LinearDynamics};

  template <class S>
  struct Params {
    S K;
    using Self = Params;
    static constexpr auto fields() {
      return Fields{HY_FIELD(K).in("'y/'x").otherwise(1.0).neutral_at(1.0).means("gain")};
    }
  };
  template <class S>
  using State = NoFields<S>;
  template <class S>
  struct In {
    S XIN;
    using Self = In;
    static constexpr auto fields() { return Fields{HY_FIELD(XIN).in("'x").means("signal")}; }
  };
  template <class S>
  struct Out {
    S XOUT;
    using Self = Out;
    static constexpr auto fields() { return Fields{HY_FIELD(XOUT).in("'y").means("signal times K")}; }
  };

  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& /*state*/, const In<S>& in, const S& /*ts*/) {
    return {.XOUT = params.K * in.XIN};
  }
};

}  // namespace hysteron
