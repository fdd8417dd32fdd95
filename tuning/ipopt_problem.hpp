// Nonlinear least squares with bounds, solved by Ipopt.
//
//   minimise  ½ Σ ρ(rᵢ(x))   subject to   lower ≤ x ≤ upper
//
// The user gives residuals and their Jacobian, in whatever units; everything about Ipopt stays behind this header.
//
//   LeastSquaresProblem problem{.names = {"C1", "C2"}, .start = …, .lower = …, .upper = …, .evaluate = …};
//   const LeastSquaresResult fit = solve(problem);
//
// How it is solved
// - Hessian. Gauss-Newton, JᵀWJ, is handed to Ipopt as the Hessian of the Lagrangian: exact where the residuals
//   vanish, never indefinite, and all that a rollout with dual numbers can give.
// - Scaling. Ipopt's tolerances are absolute, so it sees dimensionless numbers only. First round: x in units of its
//   typical size, the cost in units of its start. Then, at the point found, x in units of ‖r‖/‖∂r/∂xⱼ‖ and the cost
//   in units of ‖r‖²: there the gradient is the cosine of the angle between residual and column of the Jacobian,
//   and one unit of x is a standard error times √(degrees of freedom). Thus the fit ends at the same number of
//   digits in metres, micrometres or volts, and takes the same steps there.
// - Bounds. A parameter that the interior point leaves at its bound is set onto it, and the others are fitted again.
// - Last digits. A line search compares costs, which no longer change below a cosine of 1e-8 or so. Full Gauss-Newton
//   steps judged by the gradient instead follow, as long as each makes it smaller.
// - Result. The best point ever evaluated is kept, the start among them: a cancelled or failed run still returns it,
//   and no fit ends worse than it began.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace hysteron {

/// Residuals at x and, where `jacobian` is not null, ∂rᵢ/∂xⱼ in it (both arrive with the right size). Returns false
/// where the model has no value; a residual that is not finite means the same, and the step is shortened.
using ResidualFunction =
    std::function<bool(const Eigen::VectorXd& x, Eigen::VectorXd& residuals, Eigen::MatrixXd* jacobian)>;

struct LeastSquaresProblem {
  std::vector<std::string> names{};  ///< of the parameters, for messages; may be empty
  Eigen::Index residual_count = 0;
  Eigen::VectorXd start{};
  Eigen::VectorXd lower{};  ///< −∞ where there is none; empty: none at all
  Eigen::VectorXd upper{};  ///< ∞ where there is none; equal to lower: the parameter is held
  Eigen::VectorXd
      typical{};  ///< typical sizes; empty: |start|, or half the distance of the bounds where start is 0, or 1
  ResidualFunction evaluate{};
};

enum class Loss : std::uint8_t {
  Squares,  ///< ρ(r) = r²
  Huber     ///< ρ(r) = r² up to the threshold δ, 2δ|r| − δ² beyond: outliers pull with constant force
};

struct FitProgress {
  int iteration = 0;
  double rms = 0.0;       ///< √(mean of ρ), in the unit of the residuals
  double gradient = 0.0;  ///< of the scaled problem, as Ipopt sees it
};

struct LeastSquaresOptions {
  Loss loss = Loss::Squares;
  /// δ of the Huber loss, in the unit of the residuals. 0: 1.345 robust standard deviations (1.4826 times the median
  /// of |r|), which keeps 95 % of the efficiency of squares on normal noise.
  double huber_threshold = 0.0;
  int max_iterations = 300;
  double tolerance = 1e-9;  ///< of the gradient as a cosine, see above
  /// Called once an iteration; false stops the fit and leaves the best point so far.
  std::function<bool(const FitProgress&)> progress{};
};

enum class FitStatus : std::uint8_t {
  Converged,
  NearlyConverged,  ///< no further descent in double precision, with a gradient not quite within the tolerance
  IterationLimit,
  Cancelled,
  Stalled,            ///< no step lowers the cost although the gradient is not small: often a wrong Jacobian
  NoInfluence,        ///< a free parameter does not change the residuals at all where the fit ended
  Diverging,          ///< parameters run to infinity: the record does not determine them
  WorseThanConstant,  ///< output error alone: the outputs are no nearer to the record than a constant would be
  Unbounded,          ///< output error alone: an output runs away within a record
  ModelFailed,        ///< the model gave no finite values where they were needed
  SolverFailed
};

/// The status in plain words, one sentence.
std::string_view plain_words(FitStatus status);

enum class AtBound : std::int8_t { Lower = -1, Free = 0, Upper = 1, Held = 2 };

/// "lower" or "upper"; empty where it is at neither.
[[nodiscard]] constexpr std::string_view bound_name(AtBound at) {
  return at == AtBound::Lower ? "lower" : at == AtBound::Upper ? "upper" : "";
}

struct LeastSquaresResult {
  Eigen::VectorXd x{};
  FitStatus status = FitStatus::SolverFailed;
  std::string message{};  ///< the status in plain words, with Ipopt's own name for it
  int iterations = 0;
  int residual_evaluations = 0;
  int jacobian_evaluations = 0;
  double cost = 0.0;           ///< ½ Σ ρ(r)
  double rms = 0.0;            ///< √(mean of r²)
  double gradient_norm = 0.0;  ///< largest |cosine| between residual and a free column of the Jacobian
  double huber_threshold = 0.0;
  std::vector<AtBound> at_bound{};
  Eigen::VectorXd residuals{};
  Eigen::MatrixXd jacobian{};
  Eigen::VectorXd weights{};  ///< of the robust loss, min(1, δ/|r|); empty for squares

  [[nodiscard]] bool converged() const {
    return status == FitStatus::Converged || status == FitStatus::NearlyConverged;
  }
};

/// Deterministic: the same problem gives the same bits on the same machine. Prints nothing and reads no option file.
/// Exceptions of the user's functions pass through.
/// @throws InputError HY711 where the model has no value at the start, HY712 where the bounds leave no room for it.
LeastSquaresResult solve(const LeastSquaresProblem& problem, const LeastSquaresOptions& options = {});

}  // namespace hysteron
