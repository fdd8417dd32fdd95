// Least squares of m ≈ c1 + c2·q, q = x^c3, with the linear c1 and c2 eliminated: a function of c3 alone.
//
//   F(c3) = min over c1, c2 of ½ Σ w (m − c1 − c2·x^c3)²
//
// F, F′ and F″ follow exactly from nine sums over the points, one pass and one exponential a point. G. H. Golub and
// V. Pereyra, SIAM J. Numer. Anal. 10 (1973) 413–432.
#pragma once

#include <Eigen/Core>
#include <span>

namespace hysteron::detail {

/// The problem at one c3.
struct Projection {
  double c1 = 0.0;  ///< added to the mean of m, which is taken out beforehand
  double c2 = 0.0;
  double cost = 0.0;
  double slope = 0.0;         ///< F′
  double curvature = 0.0;     ///< F″
  double gauss_newton = 0.0;  ///< the part of F″ that is never negative
};

class VariableProjection {
 public:
  /// x in 0 … 1, m of size about 1; weights may be empty. Keeps ln x and m − mean.
  VariableProjection(std::span<const double> x, std::span<const double> m, std::span<const double> weights);

  [[nodiscard]] Projection at(double c3) const;
  /// Residuals c1 + c2·x^c3 − m, for c1 counted from the mean.
  [[nodiscard]] Eigen::VectorXd residuals(const Projection& solution, double c3) const;
  /// Σw·gᵀg with the gradient g = (1, q, c2·q·ln x) of the model.
  [[nodiscard]] Eigen::Matrix3d normal_matrix(const Projection& solution, double c3) const;

  [[nodiscard]] double mean() const { return mean_; }
  /// ½ Σ w (m − mean)²: the cost of a constant.
  [[nodiscard]] double cost_of_constant() const { return 0.5 * m_m_; }
  [[nodiscard]] double largest_deviation() const { return m_.size() == 0 ? 0.0 : m_.abs().maxCoeff(); }

 private:
  struct Sums;
  [[nodiscard]] Sums sums(double c3) const;

  Eigen::ArrayXd ln_x_{};
  Eigen::ArrayXd m_{};
  Eigen::ArrayXd weights_{};
  double mean_ = 0.0;
  double weight_ = 0.0;
  double m_m_ = 0.0;
};

struct ProjectionSearch {
  double c3 = 1.0;
  Projection solution{};
  int passes = 0;  ///< over all points
  bool converged = false;
  bool at_least = false;    ///< ends at the lower end of the range, against a slope that points out of it
  bool at_largest = false;  ///< at the upper end
};

/// The least F over least ≤ c3 ≤ largest: a search over the range on at most 512 of the points, then safeguarded
/// Newton on all.
ProjectionSearch search_c3(const VariableProjection& all, std::span<const double> x, std::span<const double> m,
                           std::span<const double> weights, double least, double largest, int most_passes);

}  // namespace hysteron::detail
