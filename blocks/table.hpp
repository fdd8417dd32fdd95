// HY_TABLE: XOUT = Y_i + (XIN − X_i)·(Y_(i+1) − Y_i)/(X_(i+1) − X_i) where X_i ≤ XIN < X_(i+1)
#pragma once

#include "blocks/interpolation.hpp"
#include "blocks/ports.hpp"

namespace hysteron {

struct Table {
  static constexpr std::size_t capacity = 32;

  static constexpr About about{
      .name = "HY_TABLE",
      .title = "Table",
      .group = Group::Shaping,
      .equation = "XOUT = Y_i + (XIN - X_i)·(Y_(i+1) - Y_i)/(X_(i+1) - X_i) where X_i <= XIN < X_(i+1)",
      .meaning =
          "A curve through up to 32 points, straight between them: a calibration, a characteristic, a schedule. COUNT "
          "points are used, and their X must rise. Outside the points the end values hold, or with EXTRAPOLATE the end "
          "lines run on. The order of X is checked at reset, and the pair in use in every step: where it fails XOUT is "
          "0 and ERROR is TRUE."};

  template <class S>
  struct Params {
    Array<S, capacity> X;
    Array<S, capacity> Y;
    Int<S> COUNT;
    Bool<S> EXTRAPOLATE;
    using Self = Params;
    static constexpr auto fields() {
      return Fields{HY_FIELD(X).in("'x").means("arguments, rising"), HY_FIELD(Y).in("'y").means("values"),
                    HY_FIELD(COUNT).role(FieldRole::PointCount).within(2, capacity).means("number of points"),
                    HY_FIELD(EXTRAPOLATE).otherwise(0.0).means("TRUE: straight on outside; FALSE: end values hold")};
    }
  };
  template <class S>
  struct State {
    Bool<S> RISING;
    using Self = State;
    static constexpr auto fields() {
      return Fields{HY_FIELD(RISING).otherwise(0.0).means("TRUE where X rose at reset")};
    }
  };
  template <class S>
  using In = Xin<S, "'x", "argument">;
  template <class S>
  using Out = CheckedXout<S, "'y", "value of the curve">;

  template <class S>
  static State<S> initial(const Params<S>& params) {
    return {.RISING = rises<S, capacity>(params.X, params.COUNT)};
  }
  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& state, const In<S>& in, const S& /*ts*/) {
    const Int<S> i = bracket<S, capacity>(params.X, params.COUNT, in.XIN);
    const Int<S> last = params.COUNT - Int<S>(1);
    const Bool<S> below = !params.EXTRAPOLATE && in.XIN <= at(params.X, Int<S>(0));
    const Bool<S> above = !params.EXTRAPOLATE && in.XIN >= at(params.X, last);
    const S inside = line<S, capacity>(params.X, params.Y, i, in.XIN);
    const S value = select(below, at(params.Y, Int<S>(0)), select(above, at(params.Y, last), inside));
    const Bool<S> error = !state.RISING || !(at(params.X, i + Int<S>(1)) > at(params.X, i));
    return Out<S>::of(value, error, fault::points_not_rising);
  }
  template <class S>
  static void update(const Params<S>& /*params*/, State<S>& /*state*/, const In<S>& /*in*/, const Out<S>& /*out*/,
                     const S& /*ts*/) {}
};

}  // namespace hysteron
