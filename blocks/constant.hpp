// HY_CONSTANT: XOUT = K
#pragma once

#include "blocks/ports.hpp"

namespace hysteron {

struct Constant : Stateless {
  static constexpr About about{
      .name = "HY_CONSTANT",
      .title = "Constant",
      .group = Group::Arithmetic,
      .equation = "XOUT = K",
      .meaning =
          "A value that does not change while the diagram runs. Unlike a literal in the diagram it has a name, a unit "
          "and a place in the parameter file, and can be tuned."};

  template <class S>
  struct Params {
    S K;
    using Self = Params;
    static constexpr auto fields() { return Fields{HY_FIELD(K).in("'x").otherwise(0.0).means("value")}; }
  };
  template <class S>
  using In = NoFields<S>;
  template <class S>
  using Out = Xout<S, "'x", "the value K">;

  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& /*state*/, const In<S>& /*in*/, const S& /*ts*/) {
    return {.XOUT = params.K};
  }
};

}  // namespace hysteron
