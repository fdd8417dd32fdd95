// What a set of effects closes on blocks of the record that its fit did not see.
//
// The record is cut into blocks; the parameters are fitted on every other block, from the whole record's fit, and
// judged on the rest, then the other way round. The simulation runs over the whole record both times: only the weights
// change.
#pragma once

#include <cstdint>
#include <vector>

#include "diagnosis/least_squares.hpp"
#include "diagnosis/search.hpp"

namespace hysteron::diagnosis {

/// Sums of squares by block, for one output, in the unit of the residuals.
struct HeldOut {
  std::vector<double> squares{};
  std::vector<double> counts{};
};

/// For each measured output.
[[nodiscard]] std::vector<HeldOut> held_out(const Task& task, const Explanation& explanation);

/// The same for residuals that no fit has seen: those of the nominal diagram.
[[nodiscard]] std::vector<HeldOut> by_blocks(const Task& task, const VectorXd& residuals);

struct Closure {
  double closed = 0.0;
  double low = 0.0;
  double high = 0.0;
};

/// 1 − (MSE − floor²)/(MSE₀ − floor²) with its 95 % interval by a bootstrap of blocks.
[[nodiscard]] Closure closure(const HeldOut& before, const HeldOut& after, double floor, std::uint64_t seed);

/// The lower 95 % bound of what `after` closes of `before` in the mean of the blocks, over its mean size; above 0: the
/// effect holds on data that it was not fitted to.
[[nodiscard]] double gain_bound(const HeldOut& before, const HeldOut& after);

}  // namespace hysteron::diagnosis
