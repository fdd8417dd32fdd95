// HY_INTEGRAL_BOUNDED: HY_INTEGRAL that stops at its bounds: XOUT(k) = min(max(XOUT(k−1) + TS·XIN(k), MN), MX)
#pragma once

#include "blocks/integral.hpp"

namespace hysteron {

/// Where an integral stops. Beyond a bound nothing is stored: it leaves the bound as soon as XIN turns back.
template <class S>
struct IntegralBounds {
  S MN;
  S MX;
  using Self = IntegralBounds;
  static constexpr auto fields() {
    constexpr double unbounded = std::numeric_limits<double>::infinity();
    return Fields{HY_FIELD(MN)
                      .role(FieldRole::LowerBound)
                      .in("'x*s")
                      .otherwise(-unbounded)
                      .neutral_at(-unbounded)
                      .effect("saturation", Family::StaticCurve)
                      .means("lower bound"),
                  HY_FIELD(MX)
                      .role(FieldRole::UpperBound)
                      .in("'x*s")
                      .otherwise(unbounded)
                      .neutral_at(unbounded)
                      .effect("saturation", Family::StaticCurve)
                      .means("upper bound")};
  }

  [[nodiscard]] Bool<S> below(const CompensatedSum<S>& sum) const { return sum.high < MN; }
  [[nodiscard]] Bool<S> above(const CompensatedSum<S>& sum) const { return sum.high > MX; }
  [[nodiscard]] CompensatedSum<S> held(const CompensatedSum<S>& sum) const {
    return {.high = min(max(sum.high, MN), MX), .low = select(below(sum) || above(sum), S(0.0), sum.low)};
  }
};

template <class S>
struct BoundedOut {
  S XOUT;
  Bool<S> Q;
  Bool<S> QLOW;
  Bool<S> QHIGH;
  using Self = BoundedOut;
  static constexpr auto fields() {
    return Fields{HY_FIELD(XOUT).in("'x*s").means("integral, between MN and MX"), HY_FIELD(Q).means("NOT R1"),
                  HY_FIELD(QLOW).means("TRUE where MN holds the integral"),
                  HY_FIELD(QHIGH).means("TRUE where MX holds the integral")};
  }
};

/// What the two integrals between bounds have in common.
struct OfBoundedIntegral {
  template <class S>
  using Params = IntegralBounds<S>;
  template <class S>
  using State = Integral::State<S>;
  template <class S>
  using In = Integral::In<S>;
  template <class S>
  using Out = BoundedOut<S>;

  template <class S>
  static State<S> initial(const Params<S>& /*params*/) {
    return {.SUM = S(0.0), .LOST = S(0.0)};
  }

 protected:
  /// A sum as it came, held by the bounds.
  template <class S>
  static Out<S> shown(const Params<S>& params, const CompensatedSum<S>& sum, const In<S>& in) {
    return {.XOUT = params.held(sum).high, .Q = !in.R1, .QLOW = params.below(sum), .QHIGH = params.above(sum)};
  }
};

struct IntegralBounded : OfBoundedIntegral {
  static constexpr About about{
      .name = "HY_INTEGRAL_BOUNDED",
      .title = "Integral between bounds",
      .group = Group::Dynamics,
      .equation = "XOUT(k) = min(max(XOUT(k−1) + TS·XIN(k), MN), MX) where RUN, X0 in place of the sum where R1",
      .meaning =
          "HY_INTEGRAL, to the bit, where no bound is set: the stroke of an axis between its end stops, a tank that "
          "overflows, a controller's integral that must not wind up. What would go beyond a bound is lost, so that the "
          "output leaves it with the first increment the other way. QLOW and QHIGH tell when a bound is at work. A "
          "bound that is not set is infinite; where MN is above MX, MX wins.",
      .delay = "That of HY_INTEGRAL.",
      .source = "IEC 61131-3, INTEGRAL and LIMIT",
      .enriches = "HY_INTEGRAL"};

  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& state, const In<S>& in, const S& ts) {
    return shown(params, Integral::advance(state, in, ts), in);
  }
  template <class S>
  static void update(const Params<S>& params, State<S>& state, const In<S>& in, const Out<S>& /*out*/, const S& ts) {
    state = State<S>::of(params.held(Integral::advance(state, in, ts)));
  }
};

}  // namespace hysteron
