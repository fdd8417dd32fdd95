#include "diagnosis/search/superposition.hpp"

#include <algorithm>
#include <cmath>

namespace hysteron::diagnosis {
namespace {

bool is_next_to(const Superposition::Interval& a, const Superposition::Interval& b) {
  return std::abs(a.begin - b.begin) <= 1 && std::abs(a.end - b.end) <= 1;
}

}  // namespace

Superposition::Superposition(const MatrixXd& changes, const Background& background)
    : matrix_(MatrixXd::Zero(changes.cols() + 1, changes.cols() + 1)), slope_(VectorXd::Zero(changes.cols() + 1)) {
  MatrixXd projected(changes.rows(), changes.cols());
  for (Index k = 0; k < changes.cols(); ++k) {
    projected.col(k) = background.projected(changes.col(k));
  }
  matrix_.topLeftCorner(changes.cols(), changes.cols()) = projected.transpose() * changes;
  slope_.head(changes.cols()) = projected.transpose() * background.residuals();
}

std::vector<Superposition::Interval> Superposition::intervals(std::size_t count) const {
  const double least = 1e-9 * matrix_.diagonal().maxCoeff();
  std::vector<Interval> all;
  for (Index begin = 0; begin < this->count(); ++begin) {
    for (Index end = begin + 1; end <= this->count(); ++end) {
      const double squared = matrix_(begin, begin) - matrix_(begin, end) - matrix_(end, begin) + matrix_(end, end);
      const double along = slope_[begin] - slope_[end];
      if (squared > least) {
        all.push_back({.begin = begin, .end = end, .size = -along / squared, .gain = 0.5 * along * along / squared});
      }
    }
  }
  std::ranges::stable_sort(all, [](const Interval& a, const Interval& b) { return a.gain > b.gain; });
  std::vector<Interval> best;
  for (const Interval& one : all) {
    if (best.size() < count &&
        std::ranges::none_of(best, [&](const Interval& other) { return is_next_to(one, other); })) {
      best.push_back(one);
    }
  }
  return best;
}

std::vector<Superposition::Pair> Superposition::pairs(double range) const {
  std::vector<Pair> all;
  for (Index a = 0; a < count(); ++a) {
    for (Index b = a + 1; b < count(); ++b) {
      const double across = 0.5 * (matrix_(a, b) + matrix_(b, a));
      const double determinant = matrix_(a, a) * matrix_(b, b) - across * across;
      if (!(determinant > 1e-9 * matrix_(a, a) * matrix_(b, b))) {
        continue;  // one and the same change
      }
      const double of_a = (across * slope_[b] - matrix_(b, b) * slope_[a]) / determinant;
      const double size_a = std::clamp(of_a, 1.0 / range, range);
      const double of_b = -(slope_[b] + across * size_a) / matrix_(b, b);
      const double size_b = std::clamp(of_b, 1.0 / range, range);
      all.push_back({.first = a,
                     .second = b,
                     .gain = -(size_a * slope_[a] + size_b * slope_[b] +
                               0.5 * (size_a * size_a * matrix_(a, a) + size_b * size_b * matrix_(b, b)) +
                               size_a * size_b * across)});
    }
  }
  std::ranges::stable_sort(all, [](const Pair& a, const Pair& b) { return a.gain > b.gain; });
  return all;
}

}  // namespace hysteron::diagnosis
