// A running sum that keeps what rounding would lose (Neumaier): shared by the integrals and the momenta.
#pragma once

#include "blocks/scalar.hpp"

namespace hysteron {

/// The sum is high + low; low holds what high has no digits for.
template <class S>
struct CompensatedSum {
  S high;
  S low;
};

/// One more term. A. Neumaier, ZAMM 54 (1974) 39–51.
template <class S>
CompensatedSum<S> add(const CompensatedSum<S>& total, const S& term) {
  const S high = total.high + term;
  const S rounding = select(abs(total.high) >= abs(term), (total.high - high) + term, (term - high) + total.high);
  return {.high = high, .low = total.low + rounding};
}

template <class S>
CompensatedSum<S> select_sum(const Bool<S>& condition, const CompensatedSum<S>& a, const CompensatedSum<S>& b) {
  return {.high = select(condition, a.high, b.high), .low = select(condition, a.low, b.low)};
}

}  // namespace hysteron
