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
/// valley that is curved in C2 and straight in ln C2.
bool moves_by_ratio(const Model& model, const VectorXd& x, Index j) {
  return model.lower()[j] >= 0.0 && x[j] > 0.0;
}

/// dx/dz, with z = ln x there and z = x elsewhere.
VectorXd slopes_of(const Model& model, const VectorXd& x) {
  VectorXd slopes = VectorXd::Ones(x.size());
  for (Index j = 0; j < x.size(); ++j) {
    if (moves_by_ratio(model, x, j)) {
      slopes[j] = x[j];
    }
  }
  return slopes;
}

VectorXd moved(const Model& model, const VectorXd& x, const VectorXd& step) {
  constexpr double farthest = 1.6;  // of ln x in one step
  VectorXd result = x;
  for (Index j = 0; j < x.size(); ++j) {
    result[j] =
        moves_by_ratio(model, x, j) ? x[j] * std::exp(std::clamp(step[j], -farthest, farthest)) : x[j] + step[j];
  }
  return within_bounds(model, result);
}

/// The step that leads from x to another point.
VectorXd step_to(const Model& model, const VectorXd& x, const VectorXd& other) {
  VectorXd step = other - x;
  for (Index j = 0; j < x.size(); ++j) {
    if (moves_by_ratio(model, x, j)) {
      step[j] = other[j] > 0.0 ? std::log(other[j] / x[j]) : -1.0;  // all the way to 0, to first order
    }
  }
  return step;
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

/// A Jacobian along the step that was taken, by what the residuals did there: Broyden's update, with each unknown
/// measured by the length of its column. It saves the pass with derivatives, which costs several without.
void follow(const VectorXd& step, const VectorXd& change, MatrixXd& jacobian) {
  const VectorXd weighed = jacobian.colwise().squaredNorm().transpose().cwiseProduct(step);
  if (const double size = weighed.dot(step); size > 0.0) {
    jacobian += (change - jacobian * step) * (weighed / size).transpose();
  }
}

/// After a step that gives more than this of what the Jacobian has promised, the Jacobian is brought along.
constexpr double most_of_promise = 0.5;
constexpr int most_attempts = 6;

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
  bool is_exact = true;  // the Jacobian is that of best.x
  const auto make_exact = [&] {
    is_exact = true;
    return model.residuals(best.x, best.residuals, &best.jacobian);
  };
  VectorXd residuals;
  for (int iteration = 0; iteration < options.iterations && best.x.size() > 0;) {
    if (options.stop && options.stop()) {
      break;
    }
    const Normal normal = normal_equations(model, best, options.weights);
    bool descended = false;
    bool is_promising = true;    // the next step promises more than the tolerance
    bool keeps_promise = false;  // and gave most of it
    for (int attempt = 0; attempt < (is_exact ? most_attempts : 1) && !descended; ++attempt) {
      const VectorXd x = moved(model, best.x, step_of(model, normal, best.x, damping));
      const VectorXd step = step_to(model, best.x, x);  // shorter where it has come to a bound
      const double promise = -step.dot(normal.gradient + 0.5 * normal.matrix * step);
      if (attempt == 0 && promise < options.tolerance * best.cost) {
        is_promising = false;
        break;
      }
      const bool valued = model.residuals(x, residuals, nullptr);
      const double cost = valued ? cost_of(model, x, residuals, options.weights) : infinity;
      if (cost < best.cost) {
        keeps_promise = best.cost - cost > most_of_promise * promise;
        if (keeps_promise) {
          follow(x - best.x, residuals - best.residuals, best.jacobian);
        }
        without_gain = best.cost - cost < options.tolerance * best.cost ? without_gain + 1 : 0;
        best.cost = cost;
        best.x = x;
        best.residuals.swap(residuals);
        damping = std::max(damping * 0.1, 1e-9);
        descended = true;
      } else {
        damping *= 8.0;
      }
    }
    if (without_gain >= 2 || (is_exact && (!descended || !is_promising))) {
      best.converged = true;
      break;
    }
    iteration += descended ? 1 : 0;
    if (keeps_promise) {
      is_exact = false;
    } else if (!make_exact()) {
      best.cost = infinity;
      return best;
    }
  }
  if (!is_exact && !make_exact()) {
    best.cost = infinity;
  }
  return best;
}

}  // namespace hysteron::diagnosis
