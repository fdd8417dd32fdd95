#include "diagnosis/model/least_squares.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "support/numbers.hpp"

namespace hysteron::diagnosis {
namespace {

VectorXd within_bounds(const Model& model, const VectorXd& x) {
  return x.cwiseMax(model.lower()).cwiseMin(model.upper());
}

/// The steps are those of ln x for an unknown that cannot be negative: constants like C2 and C3 of C2·p^C3 lie along a
/// valley that is curved in C2 and straight in ln C2. dx/dz, with z = ln x there and z = x elsewhere.
VectorXd slopes_of(const Model& model, const VectorXd& x) {
  VectorXd slopes = VectorXd::Ones(x.size());
  for (Index j = 0; j < x.size(); ++j) {
    if (model.lower()[j] >= 0.0 && x[j] > 0.0) {
      slopes[j] = x[j];
    }
  }
  return slopes;
}

VectorXd moved(const Model& model, const VectorXd& x, const VectorXd& step) {
  constexpr double farthest = 1.6;  // of ln x in one step
  VectorXd result = x;
  for (Index j = 0; j < x.size(); ++j) {
    const bool positive = model.lower()[j] >= 0.0 && x[j] > 0.0;
    result[j] = positive ? x[j] * std::exp(std::clamp(step[j], -farthest, farthest)) : x[j] + step[j];
  }
  return within_bounds(model, result);
}

/// x − x⁰, 0 where no prior holds an unknown: a bound that is not set is infinite, and so is its distance.
VectorXd off_prior(const Model& model, const VectorXd& x) {
  return (model.prior().array() > 0.0).select(x - model.start(), 0.0);
}

/// SᵀJᵀWJS + Λ and Sᵀ(JᵀWr + Λ(x − x⁰)) with the slopes S.
struct Normal {
  MatrixXd matrix{};
  VectorXd gradient{};
};

Normal normal_equations(const Model& model, const Fit& at, const VectorXd* weights) {
  Normal normal;
  const VectorXd precision = model.prior().cwiseAbs2();
  if (weights != nullptr) {
    const MatrixXd weighted = weights->asDiagonal() * at.jacobian;
    normal.matrix = at.jacobian.transpose() * weighted;
    normal.gradient = weighted.transpose() * at.residuals;
  } else {
    normal.matrix = at.jacobian.transpose() * at.jacobian;
    normal.gradient = at.jacobian.transpose() * at.residuals;
  }
  normal.matrix.diagonal() += precision;
  normal.gradient += precision.cwiseProduct(off_prior(model, at.x));
  const VectorXd slopes = slopes_of(model, at.x);
  normal.matrix = slopes.asDiagonal() * normal.matrix * slopes.asDiagonal();
  normal.gradient = slopes.cwiseProduct(normal.gradient);
  return normal;
}

/// The damped step, with those unknowns held that a bound keeps from descending.
VectorXd step_of(const Model& model, const Normal& normal, const VectorXd& x, double damping) {
  MatrixXd matrix = normal.matrix;
  VectorXd gradient = normal.gradient;
  for (Index j = 0; j < x.size(); ++j) {
    const bool held =
        (x[j] <= model.lower()[j] && gradient[j] > 0.0) || (x[j] >= model.upper()[j] && gradient[j] < 0.0);
    const double size = matrix(j, j);
    if (held || !(size > 0.0)) {
      matrix.row(j).setZero();
      matrix.col(j).setZero();
      matrix(j, j) = 1.0;
      gradient[j] = 0.0;
      continue;
    }
  }
  const VectorXd scale = matrix.diagonal().cwiseSqrt();
  for (Index j = 0; j < x.size(); ++j) {  // in units of one over the length of each column
    matrix.row(j) /= scale[j];
    matrix.col(j) /= scale[j];
    gradient[j] /= scale[j];
  }
  matrix.diagonal().array() += damping;
  return -matrix.ldlt().solve(gradient).cwiseQuotient(scale);
}

}  // namespace

double cost_of(const Model& model, const VectorXd& x, const VectorXd& residuals, const VectorXd* weights) {
  const double data = weights == nullptr ? residuals.squaredNorm() : residuals.cwiseAbs2().dot(*weights);
  const double prior = off_prior(model, x).cwiseProduct(model.prior()).squaredNorm();
  const double cost = 0.5 * (data + prior);
  if (!std::isfinite(cost)) {
    return infinity;
  }
  return cost;
}

Fit fit(Model& model, const VectorXd& start, const FitOptions& options) {
  Fit best{.x = within_bounds(model, start), .cost = infinity};
  if (!model.residuals(best.x, best.residuals, &best.jacobian)) {
    return best;
  }
  best.cost = cost_of(model, best.x, best.residuals, options.weights);
  double damping = 1e-3;
  int without_gain = 0;
  VectorXd residuals;
  for (int iteration = 0; iteration < options.iterations && best.x.size() > 0; ++iteration) {
    if (options.stop && options.stop()) {
      break;
    }
    const Normal normal = normal_equations(model, best, options.weights);
    bool descended = false;
    for (int attempt = 0; attempt < 6 && !descended; ++attempt) {
      const VectorXd x = moved(model, best.x, step_of(model, normal, best.x, damping));
      const bool valued = model.residuals(x, residuals, nullptr);
      const double cost = valued ? cost_of(model, x, residuals, options.weights) : infinity;
      if (cost < best.cost) {
        without_gain = best.cost - cost < options.tolerance * best.cost ? without_gain + 1 : 0;
        best.cost = cost;
        best.x = x;
        damping = std::max(damping * 0.1, 1e-9);
        descended = true;
      } else {
        damping *= 8.0;
      }
    }
    if (descended && !model.residuals(best.x, best.residuals, &best.jacobian)) {
      best.cost = infinity;
      return best;
    }
    if (!descended || without_gain >= 2) {
      best.converged = true;
      break;
    }
  }
  return best;
}

}  // namespace hysteron::diagnosis
