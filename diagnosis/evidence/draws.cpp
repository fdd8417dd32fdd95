#include "diagnosis/evidence/draws.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/policy.hpp"

namespace hysteron::diagnosis {

double log_square(const MatrixXd& squares, const MatrixXd& counts, const VectorXd& weights) {
  double sum = 0.0;
  for (Index output = 0; output < squares.cols(); ++output) {
    sum += std::log(std::max(weights.dot(squares.col(output)) / weights.dot(counts.col(output)), 1e-300));
  }
  return sum / static_cast<double>(squares.cols());
}

Draws::Draws(std::uint64_t seed, std::size_t blocks, const Rules& rules)
    : random_(seed),
      model_error_(rules[policy::model_error]),
      price_(rules[policy::price]),
      weights_(static_cast<Index>(blocks)) {}

void Draws::draw() {
  std::ranges::generate(weights_, [&] { return weight_(random_); });
  errors_.clear();
}

double Draws::cost(const std::vector<std::string>& families, std::size_t effects) {
  const auto [found, first] = errors_.emplace(families, 0.0);
  if (first) {
    found->second = model_error_ * error_(random_);
  }
  return found->second + price_ * static_cast<double>(effects);
}

}  // namespace hysteron::diagnosis
