// HY_BACKLASH: XOUT(k) = max(XIN(k) − WIDTH/2, min(XIN(k) + WIDTH/2, XOUT(k−1)))
#pragma once

#include "blocks/last_output.hpp"

namespace hysteron {

struct Backlash : LastOutput {
  static constexpr About about{
      .name = "HY_BACKLASH",
      .title = "Backlash (play operator)",
      .group = Group::Shaping,
      .equation = "XOUT(k) = max(XIN(k) - WIDTH/2, min(XIN(k) + WIDTH/2, XOUT(k-1)))",
      .meaning =
          "The play of a gear: the output moves only once the input has crossed the gap, and then follows at half the "
          "gap's width behind it. A loop narrower than WIDTH does not move it at all. It starts in the middle of the "
          "gap: the first sample passes as it is.",
      .source = "M. A. Krasnosel'skii, A. V. Pokrovskii, Systems with Hysteresis, 1989, play operator",
      .effect = "backlash"};

  template <class S>
  struct Params {
    S WIDTH;
    using Self = Params;
    static constexpr auto fields() {
      return std::tuple{
          HY_FIELD(WIDTH).in("'x").otherwise(0.0).at_least(0.0).neutral_at(0.0).means("whole width of the gap")};
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
    return {.XOUT = max(in.XIN - half, min(in.XIN + half, last))};
  }
};

}  // namespace hysteron
