// HY_ABSOLUTE_SENSOR: XOUT = (1 − SHARE)·XIN + SHARE·|XIN|
#pragma once

#include "blocks/effect_term.hpp"
#include "blocks/ports.hpp"

namespace hysteron {

struct AbsoluteSensor : Stateless {
  static constexpr About about{
      .name = "HY_ABSOLUTE_SENSOR",
      .title = "Sensor that is blind to the direction",
      .group = Group::Shaping,
      .equation = "XOUT = (1 − SHARE)·XIN + SHARE·|XIN|",
      .meaning =
          "A sensor that shows the size of a signal and not its direction: pulses of a wheel that are counted, a meter "
          "behind a rectifier. With SHARE = 1 it is blind, with 0 it sees all; between, it shows what is below 0 too "
          "small, by the factor 1 - 2*SHARE.",
      .source =
          "T. Wigren, M. Schoukens, Coupled electric drives data set and reference models, Uppsala University, 2017",
      .effect = "blind_to_direction",
      .family = Family::StaticCurve,
      .untried = "an even bend is its twin until a search compares families"};

  template <class S>
  struct Params {
    S SHARE;
    using Self = Params;
    static constexpr auto fields() {
      return Fields{HY_FIELD(SHARE).in("1").within(0.0, 1.0).otherwise(0.0).neutral_at(0.0).means(
          "how blind it is: 0 sees the direction, 1 does not")};
    }
  };
  template <class S>
  using In = Xin<S, "'x", "signal">;
  template <class S>
  using Out = Xout<S, "'x", "signal as it is shown">;

  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& /*state*/, const In<S>& in, const S& /*ts*/) {
    return {.XOUT = with_term<S>(in.XIN, params.SHARE * (abs(in.XIN) - in.XIN))};
  }
};

}  // namespace hysteron
