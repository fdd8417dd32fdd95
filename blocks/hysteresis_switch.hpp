// HY_HYSTERESIS: Q rises where XIN1 > XIN2 + EPS, falls where XIN1 < XIN2 − EPS
#pragma once

#include "blocks/ports.hpp"

namespace hysteron {

struct HysteresisSwitch {
  static constexpr About about{
      .name = "HY_HYSTERESIS",
      .title = "Hysteresis switch",
      .group = Group::Shaping,
      .equation = "Q = XIN1 >= XIN2 - EPS where Q was TRUE, else XIN1 > XIN2 + EPS",
      .meaning =
          "Compares two signals with a band of EPS on either side, so that noise smaller than the band does not make "
          "the output chatter: a thermostat, an alarm. Starts FALSE. This is the standard's switch; the models of "
          "hysteresis in materials are HY_HYSTERESIS_RO and HY_M.",
      .source = "IEC 61131-3, HYSTERESIS"};

  template <class S>
  struct Params {
    S EPS;
    using Self = Params;
    static constexpr auto fields() {
      return Fields{HY_FIELD(EPS).in("'x").otherwise(0.0).at_least(0.0).means("half the width of the band")};
    }
  };
  template <class S>
  struct State {
    Bool<S> HELD;
    using Self = State;
    static constexpr auto fields() { return Fields{HY_FIELD(HELD).otherwise(0.0).means("Q of the step before")}; }
  };
  template <class S>
  struct In {
    S XIN1;
    S XIN2;
    using Self = In;
    static constexpr auto fields() {
      return Fields{HY_FIELD(XIN1).in("'x").means("signal"), HY_FIELD(XIN2).in("'x").means("threshold")};
    }
  };
  template <class S>
  using Out = Truth<S, "TRUE while XIN1 counts as above XIN2">;

  template <class S>
  static State<S> initial(const Params<S>& /*params*/) {
    return {.HELD = Bool<S>(false)};
  }
  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& state, const In<S>& in, const S& /*ts*/) {
    const Bool<S> falls = in.XIN1 < in.XIN2 - params.EPS;
    const Bool<S> exceeds = in.XIN1 > in.XIN2 + params.EPS;
    return {.Q = select(state.HELD, !falls, exceeds)};
  }
  template <class S>
  static void update(const Params<S>& /*params*/, State<S>& state, const In<S>& /*in*/, const Out<S>& out,
                     const S& /*ts*/) {
    state.HELD = out.Q;
  }
};

}  // namespace hysteron
