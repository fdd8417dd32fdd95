#include "fleet/report/statistics.hpp"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "support/numbers.hpp"

namespace hysteron::fleet {

double theil_sen_slope(std::span<const double> x, std::span<const double> y) {
  std::vector<double> slopes;
  for (std::size_t i = 0; i < x.size(); ++i) {
    for (std::size_t j = i + 1; j < x.size(); ++j) {
      if (x[i] != x[j]) {
        slopes.push_back((y[j] - y[i]) / (x[j] - x[i]));
      }
    }
  }
  if (slopes.empty()) {
    return not_a_number;
  }
  std::ranges::sort(slopes);
  const std::size_t half = slopes.size() / 2;
  return slopes.size() % 2 == 1 ? slopes[half] : 0.5 * (slopes[half - 1] + slopes[half]);
}

double student_both_tails(double t, double freedom) {
  if (std::isnan(t) || !(freedom > 0.0)) {
    return 1.0;
  }
  if (std::isinf(t)) {
    return 0.0;
  }
  const boost::math::students_t distribution(freedom);
  return 2.0 * boost::math::cdf(boost::math::complement(distribution, std::abs(t)));
}

double binomial_tail(std::size_t count, std::size_t of, double probability) {
  if (count == 0) {
    return 1.0;
  }
  const boost::math::binomial distribution(static_cast<double>(of), probability);
  return boost::math::cdf(boost::math::complement(distribution, static_cast<double>(count) - 1.0));
}

double threshold_of(std::vector<double> p, double false_share) {
  std::ranges::sort(p);
  for (std::size_t i = p.size(); i > 0; --i) {
    if (p[i - 1] <= false_share * static_cast<double>(i) / static_cast<double>(p.size())) {
      return p[i - 1];
    }
  }
  return -1.0;
}

}  // namespace hysteron::fleet
