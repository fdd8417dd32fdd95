// HY_CUTOUT: XOUT = XIN while MN ≤ Z ≤ MX, else 0
#pragma once

#include "blocks/ports.hpp"

namespace hysteron {

struct Cutout {
  static constexpr About about{
      .name = "HY_CUTOUT",
      .title = "Actuator that is off outside limits",
      .group = Group::Shaping,
      .equation =
          "XOUT(k) = XIN(k)·part(k−1), part the share of a sample in which MN ≤ Z ≤ MX, and, where it was off, MN + "
          "BAND ≤ Z ≤ MX − BAND; Z straight between its samples",
      .meaning =
          "An actuator that a second signal Z switches off outside its limits: a heater with a thermal cut-out, a "
          "drive whose supply sags. It comes back once Z is within the limits by BAND. Z is that of the step before, "
          "so that the block closes loops; in the first step it is on. A sample counts the part in which it was on, so "
          "that the result has a derivative by the limits. A limit that is not set is infinite.",
      .source = "IEC 60730-2-9, thermal cut-out: off above a temperature, on again below another",
      .effect = "cutout",
      .family = Family::Coupling,
      .untried = "every column would be tried on every edge"};

  template <class S>
  struct Params {
    S MN;
    S MX;
    S BAND;
    using Self = Params;
    static constexpr auto fields() {
      constexpr double unbounded = std::numeric_limits<double>::infinity();
      return Fields{HY_FIELD(MN)
                        .role(FieldRole::LowerBound)
                        .in("'z")
                        .otherwise(-unbounded)
                        .neutral_at(-unbounded)
                        .means("Z below which it is off"),
                    HY_FIELD(MX)
                        .role(FieldRole::UpperBound)
                        .in("'z")
                        .otherwise(unbounded)
                        .neutral_at(unbounded)
                        .means("Z above which it is off"),
                    HY_FIELD(BAND).in("'z").at_least(0.0).otherwise(0.0).means(
                        "how far within a limit Z comes before it is on again")};
    }
  };
  template <class S>
  struct State {
    S PART;
    S Z1;
    Bool<S> OFF;
    Bool<S> STARTED;
    using Self = State;
    static constexpr auto fields() {
      return Fields{HY_FIELD(PART).in("1").otherwise(1.0).means("share of the sample before in which it was on"),
                    HY_FIELD(Z1).in("'z").otherwise(0.0).means("Z one sample ago"),
                    HY_FIELD(OFF).otherwise(0.0).means("TRUE while it is off"),
                    HY_FIELD(STARTED).otherwise(0.0).means("a sample has been seen")};
    }
  };
  template <class S>
  struct In {
    S XIN;
    S Z;
    using Self = In;
    static constexpr auto fields() {
      return Fields{HY_FIELD(XIN).in("'x").means("what the actuator is asked for"),
                    HY_FIELD(Z).in("'z").otherwise(0.0).means("signal with the limits; counts in the step after")};
    }
  };
  template <class S>
  using Out = Xout<S, "'x", "what it gives; 0 while it is off">;

  template <class S>
  static State<S> initial(const Params<S>& /*params*/) {
    return {.PART = S(1.0), .Z1 = S(0.0), .OFF = Bool<S>(false), .STARTED = Bool<S>(false)};
  }
  template <class S>
  static Out<S> output(const Params<S>& /*params*/, const State<S>& state, const In<S>& in, const S& /*ts*/) {
    return {.XOUT = in.XIN * state.PART};
  }
  template <class S>
  static void update(const Params<S>& params, State<S>& state, const In<S>& in, const Out<S>& /*out*/,
                     const S& /*ts*/) {
    const S band = select(state.OFF, params.BAND, S(0.0));
    const S low = params.MN + band;
    const S high = params.MX - band;
    const S before = select(state.STARTED, state.Z1, in.Z);
    const S bottom = min(before, in.Z);
    const S top = max(before, in.Z);
    const Bool<S> within = low <= in.Z && in.Z <= high;
    const Bool<S> rests = !(top > bottom);
    const S share = max(min(top, high) - max(bottom, low), S(0.0)) / select(rests, S(1.0), top - bottom);
    state = {.PART = select(rests, select(within, S(1.0), S(0.0)), share),
             .Z1 = in.Z,
             .OFF = !within,
             .STARTED = Bool<S>(true)};
  }
};

}  // namespace hysteron
