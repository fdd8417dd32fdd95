// The user's model as the solver of least squares sees it: evaluated no more often than needed, with the loss, the
// counters and the best point so far. Internal to ipopt_problem.cpp and ipopt_round.cpp.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <exception>
#include <limits>

#include "tuning/ipopt_problem.hpp"

namespace hysteron::detail {

struct Point {
  Eigen::VectorXd x{};
  Eigen::VectorXd residuals{};
  Eigen::MatrixXd jacobian{};  ///< valid where has_jacobian
  double cost = std::numeric_limits<double>::infinity();
  bool has_jacobian = false;
};

/// The user's model with its counters, the loss, and the best point so far.
class Model {
 public:
  Model(const LeastSquaresProblem& problem, const LeastSquaresOptions& options) : problem_(problem), options_(options) {
    point_.residuals.resize(problem.residual_count);
    point_.jacobian.resize(problem.residual_count, problem.start.size());
  }

  /// The point at x, evaluated no more often than needed; null where the model has no value.
  const Point* at(const Eigen::VectorXd& x, bool with_jacobian) {
    if (is_known_ && point_.x == x && (point_.has_jacobian || !with_jacobian)) {
      return std::isfinite(point_.cost) ? &point_ : nullptr;
    }
    point_.x = x;
    is_known_ = true;
    point_.cost = std::numeric_limits<double>::infinity();
    point_.has_jacobian = with_jacobian;
    ++residual_evaluations;
    jacobian_evaluations += with_jacobian ? 1 : 0;
    if (!problem_.evaluate(x, point_.residuals, with_jacobian ? &point_.jacobian : nullptr) ||
        !point_.residuals.allFinite() || (with_jacobian && !point_.jacobian.allFinite())) {
      return nullptr;
    }
    point_.cost = cost(point_.residuals);
    if (point_.cost < best.cost) {
      best.x = x;
      best.cost = point_.cost;
    }
    return std::isfinite(point_.cost) ? &point_ : nullptr;
  }

  void set_threshold(double threshold) {
    threshold_ = threshold;
    is_known_ = false;
    best = {};
  }
  [[nodiscard]] double threshold() const { return threshold_; }
  [[nodiscard]] bool robust() const { return std::isfinite(threshold_); }

  /// min(1, δ/|r|)
  [[nodiscard]] Eigen::VectorXd weights(const Eigen::VectorXd& residuals) const {
    return (threshold_ / residuals.array().abs().max(threshold_)).matrix();
  }
  /// JᵀWr
  [[nodiscard]] Eigen::VectorXd gradient(const Point& point) const {
    return robust()
               ? Eigen::VectorXd(point.jacobian.transpose() * weights(point.residuals).cwiseProduct(point.residuals))
               : Eigen::VectorXd(point.jacobian.transpose() * point.residuals);
  }
  /// JᵀWJ
  [[nodiscard]] Eigen::MatrixXd hessian(const Point& point) const {
    if (robust()) {
      return point.jacobian.transpose() * weights(point.residuals).asDiagonal() * point.jacobian;
    }
    return point.jacobian.transpose() * point.jacobian;
  }

  [[nodiscard]] const LeastSquaresProblem& problem() const { return problem_; }
  [[nodiscard]] const LeastSquaresOptions& options() const { return options_; }

  Point best{};
  int residual_evaluations = 0;
  int jacobian_evaluations = 0;
  int iterations = 0;
  std::exception_ptr failure{};

 private:
  [[nodiscard]] double cost(const Eigen::VectorXd& residuals) const {
    if (!robust()) {
      return 0.5 * residuals.squaredNorm();
    }
    const auto size = residuals.array().abs();
    return 0.5 * (size <= threshold_).select(size.square(), 2.0 * threshold_ * size - threshold_ * threshold_).sum();
  }

  const LeastSquaresProblem& problem_;
  const LeastSquaresOptions& options_;
  Point point_{};
  bool is_known_ = false;  ///< the point was evaluated, by the loss as it is
  double threshold_ = std::numeric_limits<double>::infinity();
};

}  // namespace hysteron::detail
