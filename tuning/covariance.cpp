// See covariance.hpp.
#include "tuning/covariance.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "support/numbers.hpp"

namespace hysteron {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Below this share of the largest, a singular value of the scaled Jacobian is rounding.
constexpr double null_direction = 1e-7;
/// From this correlation on, two parameters are worth a warning.
constexpr double strong_correlation = 0.99;
/// Up to this share of its value as a standard error, a parameter is well determined, whatever it goes along with.
constexpr double well_determined = 0.05;

/// The scaled Jacobian of the free parameters, J = U·Σ·Vᵀ·diag(lengths).
struct Decomposition {
  std::vector<Index> free{};
  VectorXd lengths{};   ///< of the columns
  VectorXd singular{};  ///< descending
  MatrixXd v{};
};

std::string names_of(const std::vector<std::string>& names, const std::vector<Index>& chosen) {
  std::string text;
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    text += k == 0 ? "" : (k + 1 == chosen.size() ? " and " : ", ");
    text += names[static_cast<std::size_t>(chosen[k])];
  }
  return text;
}

/// The parameters that a null direction moves, and how.
void add_null_direction(Covariance& result, const Decomposition& d, Index k, const std::vector<std::string>& names) {
  Indistinguishable found;
  found.direction = VectorXd::Zero(result.standard_errors.size());
  const double largest = d.v.col(k).cwiseAbs().maxCoeff();
  for (Index i = 0; i < d.v.rows(); ++i) {
    const Index j = d.free[static_cast<std::size_t>(i)];
    const double share = d.v(i, k) / largest;
    if (std::fabs(share) > 1e-4) {
      result.standard_errors[j] = infinity;
    }
    if (std::fabs(share) > 0.1) {
      found.parameters.push_back(j);
      found.direction[j] = d.v(i, k) / d.lengths[i];
    }
  }
  if (found.parameters.size() == 1) {
    result.warnings.push_back(fmt::format("This record does not determine {}.", names_of(names, found.parameters)));
  } else {
    result.warnings.push_back(
        fmt::format("{} cannot be told apart by this record. Hold one of them, or record more of the range.",
                    names_of(names, found.parameters)));
  }
  result.indistinguishable.push_back(std::move(found));
}

/// `values`: of the parameters; null where they are not known.
void warn_of_pairs(Covariance& result, const std::vector<Index>& free, const std::vector<std::string>& names,
                   const VectorXd* values) {
  const auto is_sharp = [&](Index j) {
    return values != nullptr && result.standard_errors[j] <= well_determined * std::fabs((*values)[j]);
  };
  for (std::size_t a = 0; a < free.size(); ++a) {
    for (std::size_t b = a + 1; b < free.size(); ++b) {
      const double correlation = result.correlation(free[a], free[b]);
      if (std::fabs(correlation) > strong_correlation && std::isfinite(result.standard_errors[free[a]]) &&
          std::isfinite(result.standard_errors[free[b]]) && !(is_sharp(free[a]) && is_sharp(free[b]))) {
        result.warnings.push_back(fmt::format("{} can hardly be told apart by this record (correlation {:.4f}).",
                                              names_of(names, {free[a], free[b]}), correlation));
      }
    }
  }
}

Covariance assemble(const Decomposition& d, Covariance result, Index parameters, const std::vector<std::string>& names,
                    const VectorXd* values) {
  result.standard_errors = VectorXd::Constant(parameters, not_a_number);
  result.covariance = MatrixXd::Constant(parameters, parameters, not_a_number);
  result.correlation = result.covariance;
  const Index n = d.v.rows();
  if (n == 0) {
    return result;
  }
  // The floor keeps the limit of a null direction: correlations tend to ±1.
  const double largest = d.singular[0];
  const VectorXd inverse = d.singular.cwiseMax(1e-15 * largest).cwiseInverse();
  const MatrixXd root = d.v * inverse.asDiagonal();
  const MatrixXd scaled = root * root.transpose();  // (JᵀJ)⁻¹ in units of the columns
  const double variance = result.degrees_of_freedom > 0
                              ? result.residual_deviation * result.residual_deviation * result.correlation_time
                              : not_a_number;
  for (Index a = 0; a < n; ++a) {
    for (Index b = 0; b < n; ++b) {
      const Index i = d.free[static_cast<std::size_t>(a)];
      const Index j = d.free[static_cast<std::size_t>(b)];
      result.covariance(i, j) = variance * scaled(a, b) / (d.lengths[a] * d.lengths[b]);
      result.correlation(i, j) =
          a == b ? 1.0 : std::clamp(scaled(a, b) / std::sqrt(scaled(a, a) * scaled(b, b)), -1.0, 1.0);
    }
    const Index i = d.free[static_cast<std::size_t>(a)];
    result.standard_errors[i] = std::sqrt(result.covariance(i, i));
  }
  result.condition = largest / std::max(d.singular[n - 1], 1e-300);
  for (Index k = 0; k < n; ++k) {
    if (d.singular[k] <= null_direction * largest) {
      add_null_direction(result, d, k, names);
    }
  }
  warn_of_pairs(result, d.free, names, values);
  if (result.degrees_of_freedom <= 0) {
    result.warnings.push_back(
        fmt::format("{} samples for {} parameters leave nothing to judge the fit by; there are no standard errors.",
                    result.samples, n));
  }
  if (result.correlation_time > 2.0) {
    result.warnings.push_back(fmt::format(
        "The residuals are correlated over some {:.0f} samples: {} samples count as {:.0f}, and the standard errors "
        "are "
        "widened by {:.1f}. Something in the record is not in the model.",
        result.correlation_time, result.samples, result.effective_samples(), std::sqrt(result.correlation_time)));
  }
  return result;
}

/// Columns of length 1; a column of zeros keeps its zeros, and its direction becomes a null direction.
VectorXd usable_lengths(VectorXd lengths) {
  return (lengths.array() > 0.0).select(lengths, 1.0);
}

}  // namespace

double correlation_time(const Eigen::VectorXd& residuals) {
  const Index n = residuals.size();
  const double power = residuals.squaredNorm();
  if (n < 4 || !(power > 0.0)) {
    return 1.0;
  }
  constexpr Index most_lags = 128;
  const auto autocorrelation = [&](Index lag) { return residuals.head(n - lag).dot(residuals.tail(n - lag)) / power; };
  double time = -1.0;
  Index lag = 0;
  for (; lag + 1 < std::min(most_lags, n / 2); lag += 2) {
    const double pair = autocorrelation(lag) + autocorrelation(lag + 1);
    if (!(pair > 0.0)) {
      return std::max(time, 1.0);
    }
    time += 2.0 * pair;
  }
  constexpr Index block = 8;
  if (n < 2 * most_lags * block) {
    return std::max(time, 1.0);
  }
  // Var(mean) = Var·τ/n is the same for the samples and for averages of blocks of them.
  const Index blocks = n / block;
  const VectorXd averages = Eigen::Map<const MatrixXd>(residuals.data(), block, blocks).colwise().mean().transpose();
  const double ratio = (averages.squaredNorm() / static_cast<double>(blocks)) / (power / static_cast<double>(n));
  return std::max(static_cast<double>(block) * ratio * correlation_time(averages), 1.0);
}

Covariance covariance_of(const LeastSquaresResult& fit, const std::vector<std::string>& names) {
  Covariance result;
  Decomposition d;
  std::vector<std::string> bound_warnings;
  for (std::size_t k = 0; k < fit.at_bound.size(); ++k) {
    if (fit.at_bound[k] == AtBound::Free) {
      d.free.push_back(static_cast<Index>(k));
    } else if (fit.at_bound[k] != AtBound::Held) {
      bound_warnings.push_back(fmt::format(
          "{} ran into its {} bound, {}: it has no standard error, and those of the others hold for that "
          "value. A bound that holds bends the others: is it right, or does the model lack something?",
          names[k], fit.at_bound[k] == AtBound::Lower ? "lower" : "upper", number_text(fit.x[static_cast<Index>(k)])));
    }
  }
  const auto n = std::ssize(d.free);
  result.samples = fit.residuals.size();
  result.degrees_of_freedom = result.samples - n;
  const bool robust = fit.weights.size() != 0;
  const VectorXd pull = robust ? VectorXd(fit.weights.cwiseProduct(fit.residuals)) : fit.residuals;
  result.correlation_time = correlation_time(pull);
  if (result.degrees_of_freedom > 0) {
    const double inside = robust ? (fit.weights.array() >= 1.0).cast<double>().mean() : 1.0;
    result.residual_deviation =
        std::sqrt(pull.squaredNorm() / static_cast<double>(result.degrees_of_freedom)) / std::max(inside, 1e-3);
  }
  MatrixXd jacobian(result.samples, n);
  for (Index k = 0; k < n; ++k) {
    jacobian.col(k) = fit.jacobian.col(d.free[static_cast<std::size_t>(k)]);
  }
  d.lengths = usable_lengths(jacobian.colwise().norm().transpose());
  jacobian = jacobian * d.lengths.cwiseInverse().asDiagonal();
  if (n > 0) {
    // The triangle of QR has the singular values of the tall matrix, and stays small.
    const Index rows = std::min(jacobian.rows(), n);
    const MatrixXd triangle =
        Eigen::HouseholderQR<MatrixXd>(jacobian).matrixQR().topRows(rows).triangularView<Eigen::Upper>();
    MatrixXd square = MatrixXd::Zero(n, n);
    square.topRows(rows) = triangle;
    const Eigen::JacobiSVD<MatrixXd> svd(square, Eigen::ComputeFullV);
    d.singular = svd.singularValues();
    d.v = svd.matrixV();
  }
  result = assemble(d, std::move(result), fit.x.size(), names, &fit.x);
  result.warnings.insert(result.warnings.begin(), bound_warnings.begin(), bound_warnings.end());
  return result;
}

Covariance covariance_of(const Eigen::MatrixXd& normal_matrix, double sum_of_squares, Eigen::Index samples,
                         double correlation_time, const std::vector<std::string>& names) {
  const Index n = normal_matrix.rows();
  Covariance result;
  Decomposition d;
  for (Index k = 0; k < n; ++k) {
    d.free.push_back(k);
  }
  result.samples = samples;
  result.degrees_of_freedom = samples - n;
  result.correlation_time = correlation_time;
  if (result.degrees_of_freedom > 0) {
    result.residual_deviation = std::sqrt(sum_of_squares / static_cast<double>(result.degrees_of_freedom));
  }
  d.lengths = usable_lengths(normal_matrix.diagonal().cwiseSqrt());
  const VectorXd inverse = d.lengths.cwiseInverse();
  const MatrixXd scaled = inverse.asDiagonal() * normal_matrix * inverse.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(scaled);
  d.singular = eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().reverse();
  d.v = eigen.eigenvectors().rowwise().reverse();
  return assemble(d, std::move(result), n, names, nullptr);
}

}  // namespace hysteron
