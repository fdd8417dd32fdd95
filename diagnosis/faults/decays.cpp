#include "diagnosis/faults/decays.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <functional>

namespace hysteron::diagnosis {
namespace {

/// Σ of what is behind a sample, each the more discounted the later, and of the squares of the discounts: a decay that
/// begins there, held against the values. To be fed from the last sample to the first.
struct Behind {
  double pole = 0.0;
  double sum = 0.0;
  double squares = 0.0;
  void add(double value) {
    sum = value + pole * sum;
    squares = 1.0 + pole * pole * squares;
  }
};

}  // namespace

Decays::Next Decays::next() const {
  Next best;
  Behind behind{.pole = pole_};
  for (std::size_t k = left_.size(); k-- > 0;) {
    behind.add(left_[k]);
    const double size = std::abs(behind.sum) / std::sqrt(behind.squares);
    if (size > best.size && !std::ranges::binary_search(leaps_, k)) {
      best = {.at = k, .size = size};
    }
  }
  return best;
}

void Decays::add(std::size_t leap) {
  leaps_.insert(std::ranges::lower_bound(leaps_, leap), leap);
  const Signal decays = sum();
  std::ranges::transform(values_, decays, left_.begin(), std::minus<>());
}

Signal Decays::sum() const {
  const auto count = static_cast<Eigen::Index>(leaps_.size());
  Eigen::MatrixXd products(count, count);  // of the decays, below the diagonal
  Eigen::VectorXd shown(count);
  Behind behind{.pole = pole_};
  Eigen::Index i = count;
  for (std::size_t k = values_.size(); k-- > 0 && i > 0;) {
    behind.add(values_[k]);
    if (leaps_[static_cast<std::size_t>(i - 1)] == k) {
      --i;
      shown[i] = behind.sum;
      for (Eigen::Index j = 0; j <= i; ++j) {
        const auto apart = static_cast<double>(k - leaps_[static_cast<std::size_t>(j)]);
        products(i, j) = behind.squares * std::pow(pole_, apart);
      }
    }
  }
  const Eigen::VectorXd sizes = products.selfadjointView<Eigen::Lower>().ldlt().solve(shown);
  Signal result(values_.size(), 0.0);
  for (Eigen::Index leap = 0; leap < count; ++leap) {
    result[leaps_[static_cast<std::size_t>(leap)]] = sizes[leap];
  }
  for (std::size_t k = 1; k < result.size(); ++k) {
    result[k] += pole_ * result[k - 1];
  }
  return result;
}

double Decays::energy_left() const {
  return Eigen::VectorXd::Map(left_.data(), static_cast<Eigen::Index>(left_.size())).squaredNorm();
}

Train train_of(const std::vector<Signal>& signals, double time_constant, double far, std::size_t most) {
  Train result{.time_constant = time_constant};
  std::vector<Decays::Next> next;
  for (const Signal& one : signals) {
    result.signals.emplace_back(one, std::exp(-1.0 / time_constant));
    next.push_back(result.signals.back().next());
  }
  while (result.leaps < most) {
    const auto best = static_cast<std::size_t>(std::ranges::max_element(next, {}, &Decays::Next::size) - next.begin());
    if (next[best].size < far) {
      break;
    }
    result.signals[best].add(next[best].at);
    next[best] = result.signals[best].next();
    ++result.leaps;
  }
  for (const Decays& one : result.signals) {
    result.left += one.energy_left();
  }
  result.penalised = result.left + far * far * static_cast<double>(result.leaps);
  return result;
}

}  // namespace hysteron::diagnosis
