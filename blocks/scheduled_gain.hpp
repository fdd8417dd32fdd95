// HY_SCHEDULED_GAIN: XOUT = XIN·(1 + SHARE·(Z − Z_REFERENCE))
#pragma once

#include "blocks/effect_term.hpp"
#include "blocks/ports.hpp"

namespace hysteron {

struct ScheduledGain : Stateless {
  static constexpr About about{
      .name = "HY_SCHEDULED_GAIN",
      .title = "Gain that depends on another signal",
      .group = Group::Dynamics,
      .equation = "XOUT = XIN·(1 + SHARE·(Z − Z_REFERENCE))",
      .meaning =
          "A gain that a second signal Z moves: a motor whose magnets weaken with the temperature, an amplifier on a "
          "supply that sags, a damper with a current. At XIN = 0 nothing changes, which tells it from "
          "HY_CROSS_COUPLING. Where Z depends on XOUT in the same step, a HY_DELAY before it closes the loop.",
      .source = "W. J. Rugh, J. S. Shamma, Automatica 36 (2000) 1401, for gains that a signal schedules",
      .effect = "scheduled_gain",
      .family = Family::Coupling,
      .untried = "every column would be tried on every edge"};

  template <class S>
  struct Params {
    S SHARE;
    S Z_REFERENCE;
    using Self = Params;
    static constexpr auto fields() {
      return Fields{HY_FIELD(SHARE).in("1/'z").otherwise(0.0).neutral_at(0.0).means("share of the gain per unit of Z"),
                    HY_FIELD(Z_REFERENCE)
                        .role(FieldRole::ReferenceSize)
                        .in("'z")
                        .otherwise(0.0)
                        .means("Z at which the gain is 1")};
    }
  };
  template <class S>
  struct In {
    S XIN;
    S Z;
    using Self = In;
    static constexpr auto fields() {
      return Fields{HY_FIELD(XIN).in("'x").means("signal"),
                    HY_FIELD(Z).in("'z").otherwise(0.0).means("signal that moves the gain")};
    }
  };
  template <class S>
  using Out = Xout<S, "'x", "signal times the gain">;

  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& /*state*/, const In<S>& in, const S& /*ts*/) {
    return {.XOUT = with_term<S>(in.XIN, in.XIN * (params.SHARE * (in.Z - params.Z_REFERENCE)))};
  }
};

}  // namespace hysteron
