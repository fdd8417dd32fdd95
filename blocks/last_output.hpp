// The memory of a block whose output follows its input within bounds about the output of the step before: shared by
// HY_BACKLASH and HY_RATE_LIMIT.
#pragma once

#include "blocks/ports.hpp"

namespace hysteron {

struct LastOutput {
  template <class S>
  struct State {
    S LAST;
    Bool<S> STARTED;
    using Self = State;
    static constexpr auto fields() {
      return std::tuple{HY_FIELD(LAST).in("'x").otherwise(0.0).means("output of the step before"),
                        HY_FIELD(STARTED).otherwise(0.0).means("TRUE after the first step")};
    }
    /// The output of the step before; in the first step the input, which so passes as it is.
    [[nodiscard]] S before(const S& input) const { return select(STARTED, LAST, input); }
  };

  template <class S, class Params, class In, class Out>
  static void update(const Params& /*params*/, State<S>& state, const In& /*in*/, const Out& out, const S& /*ts*/) {
    state.LAST = out.XOUT;
    state.STARTED = Bool<S>(true);
  }
};

}  // namespace hysteron
