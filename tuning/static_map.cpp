// See static_map.hpp.
#include "tuning/static_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "support/diagnostic.hpp"
#include "support/errors.hpp"
#include "support/numbers.hpp"
#include "tuning/variable_projection.hpp"

namespace hysteron {
namespace {

using detail::Projection;
using detail::VariableProjection;
using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::VectorXd;

const std::vector<std::string> parameter_names{"C1", "C2", "C3"};

/// The points without those of weight 0, as x = p/p_unit and m = M/m_unit.
struct ScaledPoints {
  std::vector<double> x{};
  std::vector<double> m{};
  std::vector<double> weight{};
  double p_unit = 1.0;
  double m_unit = 1.0;

  [[nodiscard]] StaticMap unscaled(double c1, double c2, double c3) const {
    return {m_unit * c1, m_unit * c2 * std::pow(p_unit, -c3), c3};
  }
};

void reject(const StaticMapPoints& points, std::size_t index, const std::string& what) {
  throw InputError(error::unusable_point, {.file = points.source},
                   fmt::format("Point {} of the map {}.", index + 1, what),
                   "Remove the point, or look for the fault in the record that it comes from.");
}

ScaledPoints checked_and_scaled(const StaticMapPoints& points) {
  if (points.M.size() != points.p.size() || (!points.weight.empty() && points.weight.size() != points.p.size())) {
    throw std::invalid_argument("static map: p, M and weights of different lengths");
  }
  ScaledPoints scaled;
  double least = std::numeric_limits<double>::infinity();
  double largest = 0.0;
  double largest_m = 0.0;
  for (std::size_t i = 0; i < points.p.size(); ++i) {
    const double p = points.p[i];
    const double m = points.M[i];
    if (!std::isfinite(p) || !std::isfinite(m)) {
      reject(points, i, "is not finite");
    }
    if (p < 0.0) {
      reject(points, i, fmt::format("has a negative p, {}; p is a distance from the last branching point", p));
    }
    if (!points.weight.empty() && !(points.weight[i] >= 0.0 && std::isfinite(points.weight[i]))) {
      reject(points, i, fmt::format("has the weight {}", points.weight[i]));
    }
    if (points.weight.empty() || points.weight[i] > 0.0) {
      least = std::min(least, p);
      largest = std::max(largest, p);
      largest_m = std::max(largest_m, std::fabs(m));
    }
  }
  scaled.p_unit = largest > 0.0 ? largest : 1.0;
  scaled.m_unit = largest_m > 0.0 ? largest_m : 1.0;
  bool between = false;
  scaled.x.reserve(points.p.size());
  scaled.m.reserve(points.p.size());
  for (std::size_t i = 0; i < points.p.size(); ++i) {
    if (points.weight.empty() || points.weight[i] > 0.0) {
      scaled.x.push_back(points.p[i] / scaled.p_unit);
      scaled.m.push_back(points.M[i] / scaled.m_unit);
      between = between || (points.p[i] > least && points.p[i] < largest);
    }
    if (!points.weight.empty() && points.weight[i] > 0.0) {
      scaled.weight.push_back(points.weight[i]);
    }
  }
  if (!between) {
    throw InputError(
        error::too_few_points, {.file = points.source},
        fmt::format("{} points with fewer than three different p do not determine C1, C2 and C3.", scaled.x.size()),
        "Record more of the range, with several directions and amplitudes, or lower the rate threshold.");
  }
  return scaled;
}

/// The transform of the covariance from scaled parameters to those of the map.
Covariance in_units(Covariance c, const ScaledPoints& points, const StaticMap& map) {
  Matrix3d transform = Matrix3d::Zero();
  transform(0, 0) = points.m_unit;
  transform(1, 1) = points.m_unit * std::pow(points.p_unit, -map.C3);
  transform(1, 2) = -map.C2 * std::log(points.p_unit);
  transform(2, 2) = 1.0;
  const bool c3_is_free = !std::isnan(c.covariance(2, 2)) || c.degrees_of_freedom <= 0;
  MatrixXd covariance = c.covariance;
  if (!c3_is_free) {
    covariance.row(2).setZero();
    covariance.col(2).setZero();
  }
  covariance = transform * covariance * transform.transpose();
  for (Index i = 0; i < 3; ++i) {
    const bool determined = std::isfinite(c.standard_errors[i]) &&
                            (i != 1 || c.standard_errors[2] < INFINITY || map.C2 == 0.0 || !c3_is_free);
    if (!std::isinf(c.standard_errors[i])) {
      c.standard_errors[i] = determined ? std::sqrt(covariance(i, i)) : INFINITY;
    }
  }
  for (Index i = 0; i < 3; ++i) {
    for (Index j = 0; j < 3; ++j) {
      if (i != j && std::isfinite(c.correlation(i, j)) && covariance(i, i) > 0.0 && covariance(j, j) > 0.0) {
        c.correlation(i, j) = std::clamp(covariance(i, j) / std::sqrt(covariance(i, i) * covariance(j, j)), -1.0, 1.0);
      }
    }
  }
  if (!c3_is_free) {
    covariance.row(2).setConstant(std::numeric_limits<double>::quiet_NaN());
    covariance.col(2).setConstant(std::numeric_limits<double>::quiet_NaN());
    c.standard_errors[2] = std::numeric_limits<double>::quiet_NaN();
  }
  c.covariance = covariance;
  return c;
}

/// Map, root mean square and covariance from the scaled parameters. c1 counts from the mean of m.
void finish(StaticMapFit& fit, const ScaledPoints& points, const VariableProjection& problem,
            const Projection& solution, double c3, bool c3_at_bound) {
  fit.map = points.unscaled(solution.c1 + problem.mean(), solution.c2, c3);
  VectorXd residuals = problem.residuals(solution, c3);
  auto weight = static_cast<double>(residuals.size());
  if (!points.weight.empty()) {
    const Eigen::Map<const ArrayXd> weights(points.weight.data(), std::ssize(points.weight));
    residuals.array() *= weights.sqrt();
    weight = weights.sum();
  }
  const double sum_of_squares = residuals.squaredNorm();
  fit.rms = points.m_unit * std::sqrt(sum_of_squares / weight);
  const Matrix3d normal = problem.normal_matrix(solution, c3);
  const double time = correlation_time(residuals);
  if (c3_at_bound) {
    const Covariance two =
        covariance_of(normal.topLeftCorner<2, 2>(), sum_of_squares, residuals.size(), time, {"C1", "C2"});
    Covariance c = two;
    const double nothing = std::numeric_limits<double>::quiet_NaN();
    c.standard_errors = VectorXd::Constant(3, nothing);
    c.covariance = c.correlation = MatrixXd::Constant(3, 3, nothing);
    c.standard_errors.head(2) = two.standard_errors;
    c.covariance.topLeftCorner(2, 2) = two.covariance;
    c.correlation.topLeftCorner(2, 2) = two.correlation;
    c.warnings.push_back(fmt::format(
        "C3 ends on its bound {}: it has no standard error, and those of C1 and C2 hold for that value.", c3));
    fit.covariance = in_units(std::move(c), points, fit.map);
  } else {
    fit.covariance =
        in_units(covariance_of(normal, sum_of_squares, residuals.size(), time, parameter_names), points, fit.map);
  }
}

void by_variable_projection(StaticMapFit& fit, const ScaledPoints& points, const VariableProjection& problem,
                            const StaticMapOptions& options) {
  const auto search = detail::search_c3(problem, points.x, points.m, points.weight, options.least_C3,
                                        options.largest_C3, options.max_iterations);
  fit.iterations = search.passes;
  fit.status = search.converged ? FitStatus::Converged : FitStatus::IterationLimit;
  finish(fit, points, problem, search.solution, search.c3, search.at_least || search.at_largest);
}

void by_ipopt(StaticMapFit& fit, const ScaledPoints& points, const VariableProjection& problem,
              const StaticMapOptions& options) {
  const Eigen::Map<const ArrayXd> x(points.x.data(), std::ssize(points.x));
  const Eigen::Map<const ArrayXd> m(points.m.data(), std::ssize(points.m));
  const ArrayXd ln_x = (x > 0.0).select(x.log(), -1e10);
  const ArrayXd root = points.weight.empty()
                           ? ArrayXd(ArrayXd::Ones(x.size()))
                           : ArrayXd(Eigen::Map<const ArrayXd>(points.weight.data(), x.size()).sqrt());
  const double start_c3 = std::clamp(1.0, options.least_C3, options.largest_C3);
  const Projection line = problem.at(start_c3);
  LeastSquaresProblem least_squares;
  least_squares.names = parameter_names;
  least_squares.residual_count = x.size();
  least_squares.start = Eigen::Vector3d(line.c1 + problem.mean(), line.c2, start_c3);
  least_squares.lower = Eigen::Vector3d(-infinity, -infinity, options.least_C3);
  least_squares.upper = Eigen::Vector3d(infinity, infinity, options.largest_C3);
  least_squares.typical = Eigen::Vector3d::Ones();
  least_squares.evaluate = [&](const VectorXd& c, VectorXd& residuals, MatrixXd* jacobian) {
    const ArrayXd q = (c[2] * ln_x).exp();
    residuals = (root * (c[0] + c[1] * q - m)).matrix();
    if (jacobian != nullptr) {
      jacobian->col(0) = root.matrix();
      jacobian->col(1) = (root * q).matrix();
      jacobian->col(2) = (root * (c[1] * q * ln_x)).matrix();
    }
    return true;
  };
  LeastSquaresOptions solver;
  solver.max_iterations = options.max_iterations;
  const LeastSquaresResult result = solve(least_squares, solver);
  fit.iterations = result.iterations;
  fit.status = result.status;
  fit.message = result.message;
  Projection solution;
  solution.c1 = result.x[0] - problem.mean();
  solution.c2 = result.x[1];
  finish(fit, points, problem, solution, result.x[2], result.at_bound[2] != AtBound::Free);
}

struct Line {
  double offset = 0.0;
  double slope = 0.0;
};

/// Least squares of y ≈ offset + slope·x; the squared residuals are multiplied by w.
Line fit_line(const ArrayXd& x, const ArrayXd& y, const ArrayXd& w) {
  const double sum = w.sum();
  const double x_mean = (w * x).sum() / sum;
  const double y_mean = (w * y).sum() / sum;
  const double slope = (w * (x - x_mean) * (y - y_mean)).sum() / (w * (x - x_mean).square()).sum();
  return {y_mean - slope * x_mean, slope};
}

/// Step 3 of Procedure 1, the paper's letters in brackets.
void by_procedure1(StaticMapFit& fit, const ScaledPoints& points, const VariableProjection& problem,
                   const StaticMapOptions& options, const std::string& source) {
  const bool weighted = options.method == StaticMapMethod::Procedure1Weighted;
  const Eigen::Map<const ArrayXd> x(points.x.data(), std::ssize(points.x));
  const Eigen::Map<const ArrayXd> m(points.m.data(), std::ssize(points.m));
  const ArrayXd weight = points.weight.empty() ? ArrayXd(ArrayXd::Ones(x.size()))
                                               : ArrayXd(Eigen::Map<const ArrayXd>(points.weight.data(), x.size()));
  const ArrayXd ln_x = (x > 0.0).select(x.log(), -1e10);
  Index smallest = 0;
  x.minCoeff(&smallest);
  double c1 = options.start_C1 ? *options.start_C1 / points.m_unit : 0.95 * m[smallest];  // (A)
  double c2 = 0.0;
  double c3 = 0.0;
  fit.status = FitStatus::IterationLimit;
  for (int round = 0; round < options.max_iterations; ++round) {
    // (B) log(M − C1) = log C2 + C3·log p (18)
    std::vector<double> abscissa;
    std::vector<double> ordinate;
    std::vector<double> importance;
    for (Index i = 0; i < x.size(); ++i) {
      const double above = m[i] - c1;
      if (x[i] > 0.0 && above > 0.0) {
        abscissa.push_back(ln_x[i]);
        ordinate.push_back(std::log(above));
        importance.push_back(weight[i] * (weighted ? above * above : 1.0));
      }
    }
    const auto used = abscissa.size();
    if (used < 2) {
      if (round == 0) {
        throw InputError(error::nothing_above_c1, {.file = source},
                         fmt::format("Only {} points have p > 0 and M above the start {} of C1, so that log(M - C1) "
                                     "has no line.",
                                     used, points.m_unit * c1),
                         "Start Procedure 1 from a smaller C1, or use the variable projection, which needs no start.");
      }
      fit.status = FitStatus::Diverging;
      break;
    }
    const auto as_array = [](const std::vector<double>& v) {
      return Eigen::Map<const ArrayXd>(v.data(), std::ssize(v));
    };
    const double new_c3 = fit_line(as_array(abscissa), as_array(ordinate), as_array(importance)).slope;
    if (!(new_c3 >= options.least_C3 && new_c3 <= options.largest_C3)) {
      fit.status = FitStatus::Diverging;
      break;
    }
    // (C) M = C1 + C2·p^C3 (17)
    const Line line = fit_line((new_c3 * ln_x).exp(), m, weight);
    const auto settled = [&](double before, double now) {
      return std::fabs(now - before) <= options.tolerance * std::max(std::fabs(now), 1e-3);
    };
    const bool done = settled(c1, line.offset) && settled(c2, line.slope) && settled(c3, new_c3);
    c1 = line.offset;
    c2 = line.slope;
    c3 = new_c3;
    const ArrayXd residuals = c1 + c2 * (c3 * ln_x).exp() - m;
    fit.history.push_back({points.unscaled(c1, c2, c3),
                           points.m_unit * std::sqrt((weight * residuals.square()).sum() / weight.sum()), used});
    if (done) {
      fit.status = FitStatus::Converged;
      break;
    }
  }
  fit.iterations = static_cast<int>(fit.history.size());
  if (fit.status == FitStatus::Diverging) {
    fit.message =
        "Procedure 1 left the range of C3: it does not converge on these points. Use the variable projection.";
  }
  Projection solution;
  solution.c1 = c1 - problem.mean();
  solution.c2 = c2;
  finish(fit, points, problem, solution, c3, false);
}

}  // namespace

double StaticMap::operator()(double p) const {
  return C1 + C2 * std::pow(p, C3);
}

StaticMap static_map_from_example(double y_star, double u_star, double alpha, double gamma) {
  const double slope = y_star / u_star;
  return {slope, slope * alpha * gamma / std::pow(2.0 * u_star, gamma - 1.0), gamma - 1.0};
}

StaticMapFit fit_static_map(const StaticMapPoints& points, const StaticMapOptions& options) {
  const ScaledPoints scaled = checked_and_scaled(points);
  const VariableProjection problem(scaled.x, scaled.m, scaled.weight);
  StaticMapFit fit;
  constexpr double rounding = 1e-14;
  if (problem.largest_deviation() <= rounding) {
    fit.status = FitStatus::NoInfluence;
    fit.message = "M is constant: there is no hysteresis in these points, C2 is 0 and C3 undetermined.";
    finish(fit, scaled, problem, {}, 1.0, false);
    return fit;
  }
  switch (options.method) {
    case StaticMapMethod::VariableProjection:
      by_variable_projection(fit, scaled, problem, options);
      break;
    case StaticMapMethod::Procedure1:
    case StaticMapMethod::Procedure1Weighted:
      by_procedure1(fit, scaled, problem, options, points.source);
      break;
    case StaticMapMethod::Ipopt:
      by_ipopt(fit, scaled, problem, options);
      break;
  }
  if (fit.message.empty()) {
    fit.message = plain_words(fit.status);
  }
  return fit;
}

}  // namespace hysteron
