// A delay that varies about its mean, as a network's does: beside a constant one a record keeps the rate of the delayed
// signal times a random part, which no effect explains and no diagram repeats.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diagnosis/search/fitting.hpp"

namespace hysteron::diagnosis {

/// How residuals answer to a delay that is longer at knots a few samples apart, straight between them.
struct JitterResponse {
  MatrixXd columns{};         ///< S, by knot: residuals a second of delay
  MatrixXd fitted{};          ///< by unknown of the fit
  MatrixXd filtered{};        ///< F: what the delayed signal's rate, some samples earlier or later, adds to residuals
  std::vector<bool> moves{};  ///< by output: whether the delay reaches it; the others do not count
};

/// Nothing where the explanation has no delay, or one whose edge lies in an inner block.
[[nodiscard]] std::optional<JitterResponse> response_to_jitter(const Task& task, const std::string& top,
                                                               const Explanation& one, unsigned threads);

/// With that response residuals are taken for normal with the covariance σ²·(I + λ S Sᵀ), whose likelihood has its
/// maximum over σ and λ. What of a residual is then still a surprise has the size
///
///   u² = σ²·det(I + λ S Sᵀ)^(1/N),
///
/// the geometric mean of the variances of one sample after the other, each given those before it.
struct Jitter {
  double deviation = 0.0;    ///< of the delay about its mean, s
  double unexplained = 0.0;  ///< u, in units of the residuals
  double left = 0.0;         ///< RMS of the residuals themselves, of the outputs that the delay reaches
  double everywhere = 0.0;   ///< u on those outputs and the residuals of the others, RMS over all
  /// What the residual has along the strongest quarter of the directions that the variation rules, over what it has
  /// along the others, each for its variance 1 + λs²: 1 where a delay varies at random. Another cause, told a
  /// variation, has no reason to lie where that would be strong.
  double evenness = 1.0;
  /// Along those directions, each for its variance, the share of what a better fit leaves that the columns of F explain
  /// beyond their number: 0 where a delay varies at random, 1 where the machine has another linear filter in the
  /// delay's place, as a zero in the right half-plane, whose difference from a delay is a sum of such copies.
  double filtered = 0.0;
};

[[nodiscard]] Jitter jitter_of(const Task& task, const JitterResponse& response, const VectorXd& residuals);

/// The delay of a set; null where it has none.
[[nodiscard]] const Applied* delay_of(const Explanation& one);

/// The dead time of that delay at the fit; 0 where it is none of its parameters.
[[nodiscard]] double mean_delay(const Task& task, const Explanation& one);

}  // namespace hysteron::diagnosis
