// HY_BACKLASH: XOUT(k) = max(XIN(k) − (1 + START)·WIDTH/2, min(XIN(k) + (1 − START)·WIDTH/2, XOUT(k−1))), or the mean
// of three such
#pragma once

#include "blocks/spread.hpp"

namespace hysteron {

struct Backlash {
  static constexpr About about{
      .name = "HY_BACKLASH",
      .title = "Backlash (play operator)",
      .group = Group::Shaping,
      .equation = "XOUT(k) = max(XIN(k) - (1 + START)*WIDTH/2, min(XIN(k) + (1 - START)*WIDTH/2, XOUT(k-1)))",
      .meaning =
          "The play of a gear: the output moves only once the input has crossed the gap, and then follows at half the "
          "gap's width behind it. A loop narrower than WIDTH does not move it at all. The first sample passes as it "
          "is: the output's zero is chosen so. START says where in the gap that was, 0 in its middle, 1 where a step "
          "downwards and -1 where a step upwards would be followed at once. With SPREAD it is the mean of three "
          "plays, of WIDTH*(1 - SPREAD), WIDTH and WIDTH*(1 + SPREAD): the gap closes by and by, as with soft or worn "
          "contacts.",
      .source = "M. A. Krasnosel'skii, A. V. Pokrovskii, Systems with Hysteresis, 1989, play operator",
      .effect = "backlash",
      .family = Family::Play,
      .simpler = "dead_zone"};

  template <class S>
  struct Params : GapParams<S> {
    S START;
    using Self = Params;
    static constexpr auto fields() {
      return concatenate(GapParams<S>::fields(), Fields{HY_FIELD(START).in("1").within(-1.0, 1.0).otherwise(0.0).means(
                                                     "place of the first sample in the gap")});
    }
  };
  template <class S>
  struct State {
    S LAST;
    S NARROW;
    S WIDE;
    Bool<S> STARTED;
    using Self = State;
    static constexpr auto fields() {
      return Fields{HY_FIELD(LAST).in("'x").otherwise(0.0).means("output of the middle play in the step before"),
                    HY_FIELD(NARROW).in("'x").otherwise(0.0).means("of the narrow play"),
                    HY_FIELD(WIDE).in("'x").otherwise(0.0).means("of the wide play"),
                    HY_FIELD(STARTED).otherwise(0.0).means("TRUE after the first step")};
    }
  };
  template <class S>
  using In = Xin<S, "'x", "position of the driving side">;
  template <class S>
  using Out = Xout<S, "'x", "position of the driven side">;

  template <class S>
  static State<S> initial(const Params<S>& /*params*/) {
    return {.LAST = S(0.0), .NARROW = S(0.0), .WIDE = S(0.0), .STARTED = Bool<S>(false)};
  }
  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& state, const In<S>& in, const S& /*ts*/) {
    return {.XOUT = plays(params, state, in).mean()};
  }
  template <class S>
  static void update(const Params<S>& params, State<S>& state, const In<S>& in, const Out<S>& /*out*/,
                     const S& /*ts*/) {
    const OfThree<S> next = plays(params, state, in);
    state.LAST = next.middle;
    state.NARROW = next.narrow;
    state.WIDE = next.wide;
    state.STARTED = Bool<S>(true);
  }

 private:
  /// In the first step each passes the input as it is.
  template <class S>
  static S play(const Params<S>& params, const Bool<S>& started, const S& x, const S& width, const S& last) {
    const S half = S(0.5) * width;
    const S low = x - (S(1.0) + params.START) * half;
    const S high = x + (S(1.0) - params.START) * half;
    return max(low, min(high, select(started, last, x)));
  }
  template <class S>
  static OfThree<S> plays(const Params<S>& params, const State<S>& state, const In<S>& in) {
    const OfThree<S> widths = params.widths();
    return {.middle = play<S>(params, state.STARTED, in.XIN, widths.middle, state.LAST),
            .narrow = play<S>(params, state.STARTED, in.XIN, widths.narrow, state.NARROW),
            .wide = play<S>(params, state.STARTED, in.XIN, widths.wide, state.WIDE)};
  }
};

}  // namespace hysteron
