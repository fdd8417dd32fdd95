// HY_DEAD_BAND: XOUT = max(XIN − WIDTH/2, min(XIN + WIDTH/2, 0)), or the mean of three such
#pragma once

#include "blocks/spread.hpp"

namespace hysteron {

struct DeadBand : Stateless {
  static constexpr About about{
      .name = "HY_DEAD_BAND",
      .title = "Dead band",
      .group = Group::Shaping,
      .equation = "XOUT = max(XIN - WIDTH/2, min(XIN + WIDTH/2, 0))",
      .meaning =
          "Gives 0 while the signal lies within WIDTH/2 of zero, and the rest of the signal outside: slope 1, no jump "
          "at the ends of the band. As a model it is a valve that overlaps; in a controller it keeps a loop quiet "
          "near its set point. With SPREAD it is the mean of three bands, of WIDTH*(1 - SPREAD), WIDTH and WIDTH*(1 + "
          "SPREAD): its edges are soft.",
      .effect = "dead_zone",
      .family = Family::StaticCurve};

  template <class S>
  using Params = GapParams<S>;
  template <class S>
  using In = Xin<S, "'x", "signal">;
  template <class S>
  using Out = Xout<S, "'x", "what of the signal lies outside the band">;

  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& /*state*/, const In<S>& in, const S& /*ts*/) {
    const OfThree<S> widths = params.widths();
    const OfThree<S> outside{.middle = beyond<S>(in.XIN, widths.middle),
                             .narrow = beyond<S>(in.XIN, widths.narrow),
                             .wide = beyond<S>(in.XIN, widths.wide)};
    return {.XOUT = outside.mean()};
  }

 private:
  template <class S>
  static S beyond(const S& x, const S& width) {
    const S half = S(0.5) * width;
    return max(x - half, min(x + half, S(0.0)));
  }
};

}  // namespace hysteron
