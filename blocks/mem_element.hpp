// The MEM element's two functions, M(p) = C1 + C2·p^C3 and g(u): shared by HY_M, HY_MEM, HY_MOMENTUM and the
// hysteresis blocks.
#pragma once

#include "blocks/ports.hpp"

namespace hysteron {

/// M(p) = C1 + C2·p^C3 (equation (17) of the paper). For p < 0, which only a signed momentum (g(u) = u) reaches, the
/// power is continued oddly, C1 − C2·|p|^C3: M stays one-to-one, and C3 = 1 is the straight line C1 + C2·p.
template <class S>
S mem_slope(const S& c1, const S& c2, const S& c3, const S& p) {
  const S size = power(abs(p), c3);
  return c1 + c2 * select(p < S(0.0), -size, size);
}

/// g(u) of p' = g(u): |u| for choice 0, u for choice 1.
template <class S>
S momentum_rate(const Int<S>& choice, const S& u) {
  return select(choice == Int<S>(0), abs(u), u);
}

/// Parameters of M(p), in the units of XOUT = M(P)·XIN.
template <class S>
struct MemSlopeParams {
  S C1;
  S C2;
  S C3;
  using Self = MemSlopeParams;
  static constexpr auto fields() {
    return Fields{HY_FIELD(C1).in("'y/'u").above(0.0).otherwise(1.0).means(
                      "slope at a branching point, M(0); above 0, so that an inverse exists there"),
                  HY_FIELD(C2).in("'y/'u/'p^C3").otherwise(0.0).means("growth of the slope"),
                  HY_FIELD(C3).in("1").within(0.0, 10.0).otherwise(1.0).means("exponent of the momentum")};
  }
};

/// The inputs of a block that applies M(p) or its inverse. At a branching point the momentum begins anew at once, while
/// HY_MOMENTUM, which closes the loop, still gives that of the branch before: hence R1 here too.
template <class S, Label unit, Label meaning>
struct SlopeIn {
  S XIN;
  S P;
  Bool<S> R1;
  using Self = SlopeIn;
  static constexpr auto fields() {
    return Fields{HY_FIELD(XIN).in(unit).means(meaning), HY_FIELD(P).in("'p").means("momentum"),
                  HY_FIELD(R1).otherwise(0.0).means("branching point: P counts as 0")};
  }
  [[nodiscard]] S momentum() const { return select(R1, S(0.0), P); }
};

/// The outputs of such a block where M(p) may not serve.
template <class S, Label unit, Label meaning, Label error, Label numbers>
struct CheckedSlopeOut {
  S XOUT;
  S M;
  Bool<S> ERROR;
  Word<S> ERRORID;
  using Self = CheckedSlopeOut;
  static constexpr auto fields() {
    return Fields{HY_FIELD(XOUT).in(unit).means(meaning), HY_FIELD(M).in("'y/'u").means("slope at this momentum"),
                  HY_FIELD(ERROR).means(error), HY_FIELD(ERRORID).means(numbers)};
  }
};

/// The input of an element of a given slope that gives a wanted output, or 0 and the reason why there is none.
template <class S>
struct InverseOfSlope {
  S input;
  S slope;
  Bool<S> failed;
  Word<S> reason;  ///< 0, or fault::slope_not_positive
};

template <class S>
InverseOfSlope<S> invert_slope(const S& slope, const S& output) {
  const Bool<S> invertible = slope > S(0.0);
  return {.input = select(invertible, output / select(invertible, slope, S(1.0)), S(0.0)),
          .slope = slope,
          .failed = !invertible,
          .reason = select(invertible, Word<S>(std::uint16_t{0}), Word<S>(fault::slope_not_positive))};
}

}  // namespace hysteron
