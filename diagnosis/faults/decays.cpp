#include "diagnosis/faults/decays.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <functional>

namespace hysteron::diagnosis {
namespace {

/// Deviations of Σ p^j·w_j, j = 0 … n − 1, of white noise w with a deviation of 1, by n from 1 on.
std::vector<double> deviations_of_sums(double pole, std::size_t most) {
  std::vector<double> result(most);
  double squares = 0.0;
  for (double& one : result) {
    squares = 1.0 + pole * pole * squares;
    one = std::sqrt(squares);
  }
  return result;
}

}  // namespace

Decays::Decays(std::span<const double> values, double pole)
    : pole_(pole),
      values_(values),
      left_(values.begin(), values.end()),
      deviations_(deviations_of_sums(pole, values.size())) {}

Decays::Next Decays::next() const {
  Next best;
  double sum = 0.0;  // of what is behind a sample, each the more discounted the later
  for (std::size_t k = left_.size(); k-- > 0;) {
    sum = left_[k] + pole_ * sum;
    const double size = std::abs(sum) / deviations_[left_.size() - 1 - k];
    if (size > best.size && !std::ranges::binary_search(leaps_, k)) {
      best = {.at = k, .size = size};
    }
  }
  return best;
}

void Decays::add(std::size_t leap) {
  const auto at = leaps_.insert(std::ranges::lower_bound(leaps_, leap), leap);
  if (at != leaps_.begin()) {
    fit_from(at - 1);
  }
  fit_from(at);
}

void Decays::fit_from(std::vector<std::size_t>::const_iterator leap) {
  const std::size_t end = leap + 1 == leaps_.end() ? values_.size() : *(leap + 1);
  double sum = 0.0;
  double squares = 0.0;
  for (std::size_t k = end; k-- > *leap;) {
    sum = values_[k] + pole_ * sum;
    squares = 1.0 + pole_ * pole_ * squares;
  }
  double decay = sum / squares;
  for (std::size_t k = *leap; k < end; ++k, decay *= pole_) {
    left_[k] = values_[k] - decay;
  }
}

Signal Decays::sum() const {
  Signal result(values_.size());
  std::ranges::transform(values_, left_, result.begin(), std::minus<>());
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
