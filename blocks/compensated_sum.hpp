// A running sum that keeps what rounding would lose: shared by the integrals and the momenta.
#pragma once

#include "blocks/ports.hpp"

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

/// The state of a block that keeps such a sum.
template <class S, Label unit, Label meaning>
struct SumState {
  S SUM;
  S LOST;
  using Self = SumState;
  static constexpr auto fields() {
    return Fields{HY_FIELD(SUM).in(unit).otherwise(0.0).means(meaning),
                  HY_FIELD(LOST).in(unit).otherwise(0.0).means("what rounding took from the sum")};
  }
  static SumState of(const CompensatedSum<S>& sum) { return {.SUM = sum.high, .LOST = sum.low}; }
  [[nodiscard]] CompensatedSum<S> sum() const { return {.high = SUM, .low = LOST}; }
};

template <class S>
CompensatedSum<S> select_sum(const Bool<S>& condition, const CompensatedSum<S>& a, const CompensatedSum<S>& b) {
  return {.high = select(condition, a.high, b.high), .low = select(condition, a.low, b.low)};
}

}  // namespace hysteron
