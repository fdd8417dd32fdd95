// HY_BACKLASH: XOUT(k) = max(XIN(k) − (1 + START)·WIDTH/2, min(XIN(k) + (1 − START)·WIDTH/2, XOUT(k−1)))
#pragma once

#include "blocks/last_output.hpp"

namespace hysteron {

struct Backlash : LastOutput {
  static constexpr About about{
      .name = "HY_BACKLASH",
      .title = "Backlash (play operator)",
      .group = Group::Shaping,
      .equation = "XOUT(k) = max(XIN(k) - (1 + START)*WIDTH/2, min(XIN(k) + (1 - START)*WIDTH/2, XOUT(k-1)))",
      .meaning =
          "The play of a gear: the output moves only once the input has crossed the gap, and then follows at half the "
          "gap's width behind it. A loop narrower than WIDTH does not move it at all. The first sample passes as it "
          "is: the output's zero is chosen so. START says where in the gap that was, 0 in its middle, 1 where a step "
          "downwards and -1 where a step upwards would be followed at once.",
      .source = "M. A. Krasnosel'skii, A. V. Pokrovskii, Systems with Hysteresis, 1989, play operator",
      .effect = "backlash"};

  template <class S>
  struct Params {
    S WIDTH;
    S START;
    using Self = Params;
    static constexpr auto fields() {
      return std::tuple{
          HY_FIELD(WIDTH).in("'x").otherwise(0.0).at_least(0.0).neutral_at(0.0).means("whole width of the gap"),
          HY_FIELD(START).in("1").within(-1.0, 1.0).otherwise(0.0).means("place of the first sample in the gap")};
    }
  };
  template <class S>
  using In = Xin<S, "'x", "position of the driving side">;
  template <class S>
  using Out = Xout<S, "'x", "position of the driven side">;

  template <class S>
  static State<S> initial(const Params<S>& /*params*/) {
    return {.LAST = S(0.0), .STARTED = Bool<S>(false)};
  }
  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& state, const In<S>& in, const S& /*ts*/) {
    const S half = S(0.5) * params.WIDTH;
    const S last = state.before(in.XIN);
    const S low = in.XIN - (S(1.0) + params.START) * half;
    const S high = in.XIN + (S(1.0) - params.START) * half;
    return {.XOUT = max(low, min(high, last))};
  }
};

}  // namespace hysteron
