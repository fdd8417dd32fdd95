// A delay that varies about its mean, as a network's does: beside a constant one a record keeps the rate of the delayed
// signal times a random part, which no effect explains and no diagram repeats.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diagnosis/fitting.hpp"
#include "diagnosis/verdict.hpp"

namespace hysteron::diagnosis {

/// With the response S of the outputs to the delay at knots a few samples apart, straight between them, residuals are
/// taken for normal with the covariance σ²·(I + λ S Sᵀ), whose likelihood has its maximum over σ and λ. What of a
/// residual is then still a surprise has the size
///
///   u² = σ²·det(I + λ S Sᵀ)^(1/N),
///
/// the geometric mean of the variances of one sample after the other, each given those before it.
struct Jitter {
  double deviation = 0.0;     ///< of the delay about its mean, s
  double unexplained = 0.0;   ///< u, in units of the residuals
  double left = 0.0;          ///< RMS of the residuals themselves
  std::vector<bool> moves{};  ///< by output: whether the delay reaches it; the others do not count
};

/// Nothing where the explanation has no delay, or one whose edge lies in an inner block.
[[nodiscard]] std::optional<Jitter> jitter_of(const Task& task, const std::string& top, const Explanation& one,
                                              unsigned threads);

/// Of the chosen set, or the same with its delay on another edge, or where it has no delay of another one that has,
/// with no more effects: what its jitter leaves has less than half of the energy that the chosen set leaves, a larger
/// set's less than half of a smaller one's. The one that leaves least is then the chosen one. A delay that varies by
/// more than 0.7 of its mean is something else, and what inputs and outputs foretell of a residual is no jitter. The
/// residuals are those of the set, on each output that the delay moves as large as what is still a surprise.
[[nodiscard]] std::optional<Unrepeatable> with_jitter(const Task& task, const std::string& top, const Search& search,
                                                      Judgement& judgement, unsigned threads);

}  // namespace hysteron::diagnosis
