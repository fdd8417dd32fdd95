// HY_DEAD_BAND: XOUT = max(XIN − WIDTH/2, min(XIN + WIDTH/2, 0))
#pragma once

#include "blocks/ports.hpp"

namespace hysteron {

struct DeadBand : Stateless {
  static constexpr About about{.name = "HY_DEAD_BAND",
                               .title = "Dead band",
                               .group = Group::Shaping,
                               .equation = "XOUT = max(XIN - WIDTH/2, min(XIN + WIDTH/2, 0))",
                               .meaning =
                                   "Gives 0 while the signal lies within WIDTH/2 of zero, and the rest of the signal "
                                   "outside: slope 1, no jump at the ends of the band. As a model it is a valve that "
                                   "overlaps; in a controller it keeps a loop quiet near its set point.",
                               .effect = "dead_zone"};

  template <class S>
  struct Params {
    S WIDTH;
    using Self = Params;
    static constexpr auto fields() {
      return std::tuple{HY_FIELD(WIDTH).in("'x").otherwise(0.0).at_least(0.0).neutral_at(0.0).means(
          "whole width of the band, half of it on either side of zero")};
    }
  };
  template <class S>
  using In = Xin<S, "'x", "signal">;
  template <class S>
  using Out = Xout<S, "'x", "what of the signal lies outside the band">;

  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& /*state*/, const In<S>& in, const S& /*ts*/) {
    const S half = S(0.5) * params.WIDTH;
    return {.XOUT = max(in.XIN - half, min(in.XIN + half, S(0.0)))};
  }
};

}  // namespace hysteron
