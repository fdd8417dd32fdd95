#include "tuning/spread_start.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace hysteron {
namespace {

/// A fraction in 0 … 1 that depends on the two numbers alone (S. Vigna's SplitMix64).
double fraction(std::uint64_t start, std::uint64_t unknown) {
  std::uint64_t z = (start * 1024 + unknown + 1) * 0x9E3779B97F4A7C15U;
  z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
  z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
  return static_cast<double>((z ^ (z >> 31U)) >> 11U) * 0x1.0p-53;
}

}  // namespace

Eigen::VectorXd spread_start(int point, const Eigen::VectorXd& start, const Eigen::VectorXd& lower,
                             const Eigen::VectorXd& upper, const Eigen::VectorXd& typical) {
  Eigen::VectorXd x = start;
  for (Eigen::Index j = 0; point > 0 && j < x.size(); ++j) {
    const double low = lower[j];
    const double high = upper[j];
    const double share = fraction(static_cast<std::uint64_t>(point), static_cast<std::uint64_t>(j));
    if (std::isfinite(low) && std::isfinite(high)) {
      x[j] = low + share * (high - low);
    } else if (low >= 0.0 && x[j] > 0.0) {
      x[j] = std::clamp(x[j] * std::pow(10.0, 2.0 * share - 1.0), low, high);
    } else {
      x[j] = std::clamp(x[j] + (4.0 * share - 2.0) * typical[j], low, high);
    }
  }
  return x;
}

}  // namespace hysteron
