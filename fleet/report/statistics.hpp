// Robust statistics: what most of the values say, and how surprising one of them is.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace hysteron::fleet {

/// The median of all slopes between two points at different times (Theil 1950, Sen 1968): up to 29 % of the points may
/// be wrong. Not a number where no two times differ.
[[nodiscard]] double theil_sen_slope(std::span<const double> x, std::span<const double> y);

/// P(|T| > |t|) of Student's distribution; 1 where t is not a number, or `freedom` is not positive.
[[nodiscard]] double student_both_tails(double t, double freedom);

/// P(X ≥ count) of a binomial distribution.
[[nodiscard]] double binomial_tail(std::size_t count, std::size_t of, double probability);

/// The largest p that is a finding, so that on average at most this share of the findings are false (Benjamini and
/// Hochberg 1995); negative where none is.
[[nodiscard]] double threshold_of(std::vector<double> p, double false_share);

}  // namespace hysteron::fleet
