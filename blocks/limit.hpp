// HY_LIMIT: XOUT = min(max(XIN, MN), MX)
#pragma once

#include "blocks/ports.hpp"

namespace hysteron {

struct Limit : Stateless {
  static constexpr About about{
      .name = "HY_LIMIT",
      .title = "Limiter",
      .group = Group::Shaping,
      .equation = "XOUT = min(max(XIN, MN), MX)",
      .meaning =
          "Holds a signal between two bounds: the range of an amplifier, the stroke of an actuator. QLOW and QHIGH "
          "tell when a bound is at work, for example to stop an integral. A bound that is not set is infinite; where "
          "MN is above MX, MX wins. For bounds that are signals use HY_MIN and HY_MAX.",
      .source = "IEC 61131-3, LIMIT",
      .effect = "saturation",
      .family = Family::StaticCurve,
      .simpler = "saturation"};

  template <class S>
  struct Params {
    S MN;
    S MX;
    using Self = Params;
    static constexpr auto fields() {
      constexpr double unbounded = std::numeric_limits<double>::infinity();
      return Fields{HY_FIELD(MN)
                        .role(FieldRole::LowerBound)
                        .in("'x")
                        .otherwise(-unbounded)
                        .neutral_at(-unbounded)
                        .means("lower bound"),
                    HY_FIELD(MX)
                        .role(FieldRole::UpperBound)
                        .in("'x")
                        .otherwise(unbounded)
                        .neutral_at(unbounded)
                        .means("upper bound")};
    }
  };
  template <class S>
  using In = Xin<S, "'x", "signal">;
  template <class S>
  struct Out {
    S XOUT;
    Bool<S> QLOW;
    Bool<S> QHIGH;
    using Self = Out;
    static constexpr auto fields() {
      return Fields{HY_FIELD(XOUT).in("'x").means("signal, between MN and MX"),
                    HY_FIELD(QLOW).means("TRUE where XIN is below MN"),
                    HY_FIELD(QHIGH).means("TRUE where XIN is above MX")};
    }
  };

  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& /*state*/, const In<S>& in, const S& /*ts*/) {
    return {.XOUT = min(max(in.XIN, params.MN), params.MX), .QLOW = in.XIN<params.MN, .QHIGH = in.XIN> params.MX};
  }
};

}  // namespace hysteron
