// What the unit delays of BOOL, DINT and WORD share: all but their names. HY_DELAY, of LREAL, also carries a unit.
#pragma once

#include "blocks/description.hpp"

namespace hysteron {

/// `Value` is Bool, Int or Word: the type of that kind that belongs to a scalar.
template <template <class> class Value>
struct TypedDelay {
  template <class S>
  struct Params {
    Value<S> X0;
    using Self = Params;
    static constexpr auto fields() {
      return Fields{
          HY_FIELD(X0).role(FieldRole::StartValue).otherwise(0.0).means("output in the first sample and at a reset")};
    }
  };
  template <class S>
  struct State {
    Value<S> X1;
    using Self = State;
    static constexpr auto fields() { return Fields{HY_FIELD(X1).otherwise(0.0).means("XIN one sample ago")}; }
  };
  template <class S>
  struct In {
    Value<S> XIN;
    Bool<S> R1;
    using Self = In;
    static constexpr auto fields() {
      return Fields{HY_FIELD(XIN).means("what is delayed"), HY_FIELD(R1).otherwise(0.0).means("reset: XOUT is X0")};
    }
  };
  template <class S>
  struct Out {
    Value<S> XOUT;
    using Self = Out;
    static constexpr auto fields() { return Fields{HY_FIELD(XOUT).means("XIN one sample ago")}; }
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
