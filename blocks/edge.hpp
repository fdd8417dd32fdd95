// What the two edge detectors share: all but which edge they see.
#pragma once

#include "blocks/ports.hpp"

namespace hysteron {

struct Edge {
  template <class S>
  using Params = NoFields<S>;
  template <class S>
  struct In {
    Bool<S> CLK;
    using Self = In;
    static constexpr auto fields() { return Fields{HY_FIELD(CLK).means("signal whose edge is wanted")}; }
  };
};

template <class S, Label meaning>
struct EdgeState {
  Bool<S> M;
  using Self = EdgeState;
  static constexpr auto fields() { return Fields{HY_FIELD(M).otherwise(0.0).means(meaning)}; }
};

}  // namespace hysteron
