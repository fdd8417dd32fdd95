#include "diagnosis/evidence/shapley.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace hysteron::diagnosis {

std::vector<double> shapley_shares(std::size_t count, const std::function<double(std::size_t)>& closed) {
  std::vector<double> best(std::size_t{1} << count, 0.0);  // by the bits of those that are there
  for (std::size_t chosen = 1; chosen < best.size(); ++chosen) {
    best[chosen] = closed(chosen);
    for (std::size_t one = 0; one < count; ++one) {
      best[chosen] = std::max(best[chosen], best[chosen & ~(std::size_t{1} << one)]);
    }
  }
  std::vector<double> shares(count, 0.0);
  const auto all = static_cast<double>(count);
  for (std::size_t one = 0; one < count; ++one) {
    const std::size_t own = std::size_t{1} << one;
    for (std::size_t others = 0; others < best.size(); ++others) {
      if ((others & own) == 0) {
        const auto before = static_cast<double>(std::popcount(others));
        // before! (all − before − 1)! / all!
        const double weight = std::exp(std::lgamma(before + 1.0) + std::lgamma(all - before) - std::lgamma(all + 1.0));
        shares[one] += weight * (best[others | own] - best[others]);
      }
    }
  }
  return shares;
}

}  // namespace hysteron::diagnosis
