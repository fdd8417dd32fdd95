// HY_SUM: XOUT = ((IN1 + IN2) + IN3) + IN4
#pragma once

#include "blocks/ports.hpp"

namespace hysteron {

struct Sum : Stateless {
  static constexpr About about{
      .name = "HY_SUM",
      .title = "Sum",
      .group = Group::Arithmetic,
      .equation = "XOUT = ((IN1 + IN2) + IN3) + IN4",
      .meaning =
          "Adds two to four signals of the same unit, from the first to the last, so that the rounding is the same on "
          "every target. IN3 and IN4 are 0 where they are not connected.",
      .source = "IEC 61131-3, ADD"};

  template <class S>
  struct In {
    S IN1;
    S IN2;
    S IN3;
    S IN4;
    using Self = In;
    static constexpr auto fields() {
      return Fields{HY_FIELD(IN1).in("'x").means("first summand"), HY_FIELD(IN2).in("'x").means("second summand"),
                    HY_FIELD(IN3).in("'x").otherwise(0.0).means("third summand"),
                    HY_FIELD(IN4).in("'x").otherwise(0.0).means("fourth summand")};
    }
  };
  template <class S>
  using Out = Xout<S, "'x", "sum of the inputs">;

  template <class S>
  static Out<S> output(const Params<S>& /*params*/, const State<S>& /*state*/, const In<S>& in, const S& /*ts*/) {
    return {.XOUT = in.IN1 + in.IN2 + in.IN3 + in.IN4};
  }
};

}  // namespace hysteron
