// Bouc and Wen's element with exponent 1: z' = x' − β|x'|z − γx'|z|, β + γ = 1/TRAVEL, 2γ/(β + γ) = SKEW.
//
// With w = z·sgn x' and d the distance travelled, dw/dd is 1 − w/TRAVEL where z lies on the side of the motion, and
// 1 − (1 − SKEW)·w/TRAVEL where it still lies on the other: an exponential in d on either side, so that a sample of any
// length is exact.
#pragma once

#include "blocks/scalar.hpp"

namespace hysteron {

template <class S>
struct BoucWenLaw {
  S travel;
  S skew;  ///< below 1
};

template <class S>
struct BoucWenPlace {
  S z;
  S slope;  ///< dz/dx
};

/// From z after a motion by `change`, which is no reversal within the sample; a rest counts as `downwards` or not.
template <class S>
BoucWenPlace<S> bouc_wen(const BoucWenLaw<S>& law, const S& z, const S& change, const Bool<S>& downwards) {
  const S way = select(change < S(0.0) || (change == S(0.0) && downwards), S(-1.0), S(1.0));
  const S w = way * z;
  const S distance = abs(change);
  const S far_rate = (S(1.0) - law.skew) / law.travel;
  const S behind = min(w, S(0.0));
  const S to_zero = log(S(1.0) - far_rate * behind) / far_rate;
  const Bool<S> stays_behind = distance < to_zero;
  const auto still_behind = [&] {
    return behind + (S(1.0) / far_rate - behind) * (S(1.0) - exp(-far_rate * distance));
  };
  const auto before = [&] {
    const S ahead = max(w, S(0.0));
    const S beyond = max(distance - to_zero, S(0.0)) / law.travel;
    return ahead + (law.travel - ahead) * (S(1.0) - exp(-beyond));
  };
  const S now = either<S>(stays_behind, still_behind, before);
  return {.z = way * now, .slope = S(1.0) - now * select(stays_behind, far_rate, S(1.0) / law.travel)};
}

}  // namespace hysteron
