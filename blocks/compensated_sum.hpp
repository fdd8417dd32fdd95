// A running sum that keeps what rounding would lose: shared by the integrals and the momenta.
#pragma once

#include "blocks/scalar.hpp"

namespace hysteron {

/// `high` is the sum as far as S can hold it; `low` is what rounding took from it, smaller than its last digit.
template <class S>
struct CompensatedSum {
  S high;
  S low;
};

/// One more term. What was lost goes in again with the term, so that it never grows large enough to lose digits of its
/// own. Kahan, CACM 8 (1965) 40, with Neumaier's choice of the larger operand, ZAMM 54 (1974) 39–51.
template <class S>
CompensatedSum<S> add(const CompensatedSum<S>& total, const S& term) {
  const S due = term + total.low;
  const S high = total.high + due;
  const S low = select(abs(total.high) >= abs(due), (total.high - high) + due, (due - high) + total.high);
  return {.high = high, .low = low};
}

template <class S>
CompensatedSum<S> select_sum(const Bool<S>& condition, const CompensatedSum<S>& a, const CompensatedSum<S>& b) {
  return {.high = select(condition, a.high, b.high), .low = select(condition, a.low, b.low)};
}

}  // namespace hysteron
