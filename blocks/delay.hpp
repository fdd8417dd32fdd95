// HY_DELAY: XOUT(k) = XIN(k−1)
#pragma once

#include "blocks/description.hpp"

namespace hysteron {

struct Delay {
  static constexpr About about{
      .name = "HY_DELAY",
      .title = "Unit delay",
      .group = Group::Dynamics,
      .equation = "XOUT(k) = XIN(k−1); X0 in the first sample and where R1",
      .meaning =
          "The input of the step before: the block that closes a loop. In the first sample, and while R1 is TRUE, "
          "XOUT is X0.",
      .delay = "One sample, gain 1."};

  template <class S>
  struct Params {
    S X0;
    using Self = Params;
    static constexpr auto fields() {
      return Fields{HY_FIELD(X0)
                        .role(FieldRole::StartValue)
                        .in("'x")
                        .otherwise(0.0)
                        .means("output in the first sample and at a reset")};
    }
  };
  template <class S>
  struct State {
    S X1;
    using Self = State;
    static constexpr auto fields() {
      return Fields{HY_FIELD(X1).in("'x").otherwise(0.0).means("signal one sample ago")};
    }
  };
  template <class S>
  struct In {
    S XIN;
    Bool<S> R1;
    using Self = In;
    static constexpr auto fields() {
      return Fields{HY_FIELD(XIN).in("'x").means("signal"), HY_FIELD(R1).otherwise(0.0).means("reset: XOUT is X0")};
    }
  };
  template <class S>
  struct Out {
    S XOUT;
    using Self = Out;
    static constexpr auto fields() { return Fields{HY_FIELD(XOUT).in("'x").means("signal one sample ago")}; }
  };

  template <class S>
  static State<S> initial(const Params<S>& params) {
    return {.X1 = params.X0};
  }
  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& state, const In<S>& in, const S& /*ts*/) {
    return {.XOUT = select(in.R1, params.X0, state.X1)};
  }
  template <class S>
  static void update(const Params<S>& /*params*/, State<S>& state, const In<S>& in, const Out<S>& /*out*/,
                     const S& /*ts*/) {
    state.X1 = in.XIN;
  }
};

}  // namespace hysteron
