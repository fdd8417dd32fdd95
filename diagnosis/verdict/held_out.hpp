// What a set of effects closes on blocks of the record that its fit did not see.
//
// The record is cut into blocks; the parameters are fitted on every other block, from the whole record's fit, and
// judged on the rest, then the other way round. The simulation runs over the whole record both times: only the weights
// change.
#pragma once

#include <cstdint>
#include <vector>

#include "diagnosis/model/least_squares.hpp"
#include "diagnosis/noise/noise_floor.hpp"
#include "diagnosis/search/search.hpp"

namespace hysteron::diagnosis {

/// Sums of squares by block, for one output, in the unit of the residuals.
struct HeldOut {
  std::vector<double> squares{};
  std::vector<double> counts{};
};

/// The residuals of all rows, each by a fit that has not seen its block.
[[nodiscard]] VectorXd held_out(const Task& task, const Explanation& explanation);

/// Residuals by blocks, for each measured output.
[[nodiscard]] std::vector<HeldOut> by_blocks(const Task& task, const VectorXd& residuals);

struct Closure {
  double closed = 0.0;
  double low = 0.0;
  double high = 0.0;
};

/// 1 − (MSE − floor²)/(MSE₀ − floor²) with its 95 % interval: a bootstrap of blocks, each draw with a noise from its
/// range. The upper bound is at least the share that the whole record's fit closes, `fitted` being its mean square. It
/// may lie above 1 where the floor may be higher than what is left.
[[nodiscard]] Closure closure(const HeldOut& before, const HeldOut& after, double fitted, const NoiseRange& noise,
                              std::uint64_t seed);

/// The lower 95 % bound of what `after` closes of `before` in the mean of the blocks, over its mean size; above 0: the
/// effect holds on data that it was not fitted to.
[[nodiscard]] double gain_bound(const HeldOut& before, const HeldOut& after);

/// What `after` gains on `before` over what chance gives, where the two differ by d and `after` is noise of the
/// deviation s that is correlated over τ samples: (Σ before² − Σ after²)/(2·s·√τ·‖d‖). An effect that acts for a short
/// time only shows here, and not in the mean of the blocks.
[[nodiscard]] double gain_score(const VectorXd& before, const VectorXd& after);

}  // namespace hysteron::diagnosis
