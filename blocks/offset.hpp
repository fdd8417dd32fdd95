// HY_OFFSET: XOUT = XIN + BIAS
#pragma once

#include "blocks/effect_term.hpp"
#include "blocks/ports.hpp"

namespace hysteron {

struct Offset : Stateless {
  static constexpr About about{
      .name = "HY_OFFSET",
      .title = "Offset",
      .group = Group::Arithmetic,
      .equation = "XOUT = XIN + BIAS",
      .meaning = "Adds a constant: the zero error of a sensor, of an amplifier or of a mounting.",

      .effect = "offset",
      .family = Family::Offset};

  template <class S>
  struct Params {
    S BIAS;
    using Self = Params;
    static constexpr auto fields() {
      return Fields{HY_FIELD(BIAS).in("'x").otherwise(0.0).neutral_at(0.0).means("what is added")};
    }
  };
  template <class S>
  using In = Xin<S, "'x", "signal">;
  template <class S>
  using Out = Xout<S, "'x", "signal with the offset">;

  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& /*state*/, const In<S>& in, const S& /*ts*/) {
    return {.XOUT = with_term<S>(in.XIN, params.BIAS)};
  }
};

}  // namespace hysteron
