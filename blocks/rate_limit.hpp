// HY_RATE_LIMIT: XOUT(k) = min(max(XIN(k), XOUT(k−1) − FALL·TS), XOUT(k−1) + RISE·TS)
#pragma once

#include "blocks/last_output.hpp"

namespace hysteron {

struct RateLimit : LastOutput {
  static constexpr About about{.name = "HY_RATE_LIMIT",
                               .title = "Rate limiter",
                               .group = Group::Shaping,
                               .equation = "XOUT(k) = min(max(XIN(k), XOUT(k-1) - FALL·TS), XOUT(k-1) + RISE·TS)",
                               .meaning =
                                   "Follows a signal no faster than RISE upwards and FALL downwards: the slew rate of "
                                   "an amplifier, or a gentle set point. The first sample passes as it is. A rate that "
                                   "is not set is infinite; a rate of 0 holds the output in that direction.",
                               .effect = "rate_limit"};

  template <class S>
  struct Params {
    S RISE;
    S FALL;
    using Self = Params;
    static constexpr auto fields() {
      constexpr double unbounded = std::numeric_limits<double>::infinity();
      return std::tuple{HY_FIELD(RISE).in("'x/s").otherwise(unbounded).at_least(0.0).neutral_at(unbounded).means(
                            "largest rate upwards"),
                        HY_FIELD(FALL).in("'x/s").otherwise(unbounded).at_least(0.0).neutral_at(unbounded).means(
                            "largest rate downwards, as a positive number")};
    }
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
};

}  // namespace hysteron
