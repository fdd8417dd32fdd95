// The pins of the timers.
#pragma once

#include "blocks/ports.hpp"
#include "blocks/ticks.hpp"

namespace hysteron {

struct Timer {
  /// The next count of a timer that runs. One that has timed out stays so until it starts anew, whatever becomes of PT.
  template <class S>
  static Int<S> count_on(const Int<S>& count, const Int<S>& steps) {
    const Int<S> next = one_more(count);
    return select(next >= steps, Int<S>(2147483647), next);
  }

  template <class S>
  using Params = NoFields<S>;
  template <class S>
  struct In {
    Bool<S> IN;
    S PT;
    using Self = In;
    static constexpr auto fields() {
      return Fields{HY_FIELD(IN).means("starts the timer"),
                    HY_FIELD(PT).in("s").at_least(0.0).means("preset time, exact in steps, at most 2^31 - 1 of them")};
    }
  };
  template <class S>
  struct Out {
    Bool<S> Q;
    S ET;
    using Self = Out;
    static constexpr auto fields() {
      return Fields{HY_FIELD(Q).means("output of the timer"), HY_FIELD(ET).in("s").means("elapsed time, from 0 to PT")};
    }
  };
};

}  // namespace hysteron
