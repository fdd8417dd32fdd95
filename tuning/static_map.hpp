// Fits of the static map of a hysteresis, M(p) = C1 + C2·p^C3 (17), to points (p, M).
//
// Equation numbers are those of Strijbosch and Oomen, Hybrid-MEM-Element Feedforward. C2 is that of (17); the c2 of
// (10) is C2/C1. Four ways to the same least-squares problem:
//
//   Procedure1          the paper's step 3 as printed: a line through log(M − C1) over log p gives C3, a line through M
//                       over p^C3 gives C1 and C2, and round again. Both lines are ordinary least squares. It leaves
//                       the truth even on exact data unless it starts exactly there: the logarithm magnifies the
//                       errors of the smallest M − C1 most.
//   Procedure1Weighted  the same with the residuals of the first line multiplied by M − C1, which undoes the
//                       magnification. Converges linearly, in some hundred rounds.
//   VariableProjection  C1 and C2 are linear once C3 is given, so that one unknown is left, with exact first and second
//                       derivative. A search over the whole range of C3, then Newton. The default: global, and one
//                       pass over the points an iteration.
//   Ipopt               all three at once, exact Jacobian and Gauss-Newton Hessian (ipopt_problem.hpp); its start is
//   the
//                       line at C3 = 1.
//
// p and M are scaled inside to the largest of each, so that metres beside volts do not matter.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tuning/covariance.hpp"
#include "tuning/ipopt_problem.hpp"

namespace hysteron {

struct StaticMap {
  double C1 = 0.0;
  double C2 = 0.0;
  double C3 = 1.0;

  /// M(p) = C1 + C2·p^C3
  [[nodiscard]] double operator()(double p) const;
};

/// The parameters of the paper's ellipse (2), (3) as those of (17): C1 = y*/u*, C2 = C1·α·γ/(2u*)^(γ−1), C3 = γ − 1.
/// Lengths of y* and voltages of u* may have any unit; α here is dimensionless (the printed 8.0e-9 carries C1).
StaticMap static_map_from_example(double y_star, double u_star, double alpha, double gamma);

enum class StaticMapMethod : std::uint8_t { VariableProjection, Procedure1, Procedure1Weighted, Ipopt };

struct StaticMapOptions {
  StaticMapMethod method = StaticMapMethod::VariableProjection;
  double least_C3 = 1e-3;  ///< towards 0 the map becomes logarithmic and C1, C2 lose their meaning
  double largest_C3 = 20.0;
  std::optional<double> start_C1{};  ///< Procedure 1, step 3.A; without it 0.95 times the M of the smallest p
  int max_iterations = 2000;         ///< rounds of Procedure 1, steps of the others
  double tolerance = 1e-13;          ///< Procedure 1 ends when no parameter changes more than this share of itself
};

/// One round of Procedure 1.
struct StaticMapRound {
  StaticMap map{};
  double rms = 0.0;             ///< of M − M(p)
  std::size_t points_used = 0;  ///< by the logarithm: those with p > 0 and M > C1
};

struct StaticMapFit {
  StaticMap map{};
  double rms = 0.0;    ///< √(Σw(M − M(p))²/Σw), in the unit of M
  int iterations = 0;  ///< rounds of Procedure 1, passes of the search or iterations of Ipopt
  FitStatus status = FitStatus::SolverFailed;
  std::string message{};
  Covariance covariance{};  ///< of C1, C2, C3
  std::vector<StaticMapRound> history{};

  [[nodiscard]] bool converged() const {
    return status == FitStatus::Converged || status == FitStatus::NearlyConverged;
  }
};

/// Points of the map: p ≥ 0 in the unit of the input, M in output over input. Weights multiply the squared residuals
/// (1/σ²); none: all 1.
struct StaticMapPoints {
  std::span<const double> p{};
  std::span<const double> M{};
  std::span<const double> weight{};
  std::string source{};  ///< the file they come from, for messages
};

/// A constant M gives C2 = 0 and the status NoInfluence: the points say nothing of C3.
/// @throws InputError HY710 below three different p, HY714 for a point that is not finite, a negative p or a negative
/// weight, HY715 where Procedure 1 finds fewer than two points with M > C1 at its start.
StaticMapFit fit_static_map(const StaticMapPoints& points, const StaticMapOptions& options = {});

}  // namespace hysteron
