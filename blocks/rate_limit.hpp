// HY_RATE_LIMIT: XOUT(k) = min(max(XIN(k), XOUT(k−1) − FALL·TS), XOUT(k−1) + RISE·TS)
#pragma once

#include "blocks/ports.hpp"

namespace hysteron {

struct RateLimit {
  static constexpr About about{.name = "HY_RATE_LIMIT",
                               .title = "Rate limiter",
                               .group = Group::Shaping,
                               .equation = "XOUT(k) = min(max(XIN(k), XOUT(k-1) - FALL·TS), XOUT(k-1) + RISE·TS)",
                               .meaning =
                                   "Follows a signal no faster than RISE upwards and FALL downwards: the slew rate of "
                                   "an amplifier, or a gentle set point. The first sample passes as it is. A rate that "
                                   "is not set is infinite; a rate of 0 holds the output in that direction.",
                               .effect = "rate_limit",
                               .family = Family::RateLimit};

  template <class S>
  struct Params {
    S RISE;
    S FALL;
    using Self = Params;
    static constexpr auto fields() {
      constexpr double unbounded = std::numeric_limits<double>::infinity();
      return Fields{HY_FIELD(RISE).in("'x/s").otherwise(unbounded).at_least(0.0).neutral_at(unbounded).means(
                        "largest rate upwards"),
                    HY_FIELD(FALL).in("'x/s").otherwise(unbounded).at_least(0.0).neutral_at(unbounded).means(
                        "largest rate downwards, as a positive number")};
    }
  };
  template <class S>
  struct State {
    S LAST;
    Bool<S> STARTED;
    using Self = State;
    static constexpr auto fields() {
      return Fields{HY_FIELD(LAST).in("'x").otherwise(0.0).means("output of the step before"),
                    HY_FIELD(STARTED).otherwise(0.0).means("TRUE after the first step")};
    }
    /// The output of the step before; in the first step the input, which so passes as it is.
    [[nodiscard]] S before(const S& input) const { return select(STARTED, LAST, input); }
  };
  template <class S>
  using In = Xin<S, "'x", "signal">;
  template <class S>
  using Out = Xout<S, "'x", "signal, limited in its rate">;

  template <class S>
  static State<S> initial(const Params<S>& /*params*/) {
    return {.LAST = S(0.0), .STARTED = Bool<S>(false)};
  }
  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& state, const In<S>& in, const S& ts) {
    const S last = state.before(in.XIN);
    return {.XOUT = min(max(in.XIN, last - params.FALL * ts), last + params.RISE * ts)};
  }
  template <class S>
  static void update(const Params<S>& /*params*/, State<S>& state, const In<S>& /*in*/, const Out<S>& out,
                     const S& /*ts*/) {
    state.LAST = out.XOUT;
    state.STARTED = Bool<S>(true);
  }
};

}  // namespace hysteron
