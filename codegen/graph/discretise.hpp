// A transfer function in s for an input that is held from sample to sample, as matrices from one sample to the next.
#pragma once

#include <span>
#include <vector>

namespace hysteron {

/// x(k+1) = phi·x(k) + gamma·u(k), y(k) = c·x(k) + d·u(k); phi row by row.
struct HeldSystem {
  std::vector<double> phi{};
  std::vector<double> gamma{};
  std::vector<double> c{};
  double d = 0.0;
};

/// (num_0·s^m + … + num_m)/(den_0·s^n + … + den_n), m ≤ n, den_0 ≠ 0, at a sample time in s: exp of the matrix
/// [A B; 0 0]·TS is [phi gamma; 0 1] (C. F. Van Loan, IEEE Trans. Automatic Control 23 (1978) 395), with A the
/// companion matrix in the time of the fastest pole, so that its entries are near 1.
[[nodiscard]] HeldSystem discretise_held(std::span<const double> num, std::span<const double> den, double ts);

}  // namespace hysteron
