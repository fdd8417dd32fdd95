// How much noise a residual holds, from its fast part: where no input repeats or dwells, differences of the measurement
// see white noise only, and of what a sensor's filter has coloured a third perhaps.
//
// White noise, and white noise behind a lag of first order, have the spectrum
//
//   S(ω) = σ²·(1 − s + s·(1 − p²)/|1 − p·e^(−iω)|²),   0 ≤ s ≤ 1, 0 ≤ p ≤ 0.9,
//
// with the variance σ² (Whittle 1953 for its likelihood). σ, s and p are those of the spectrum above a tenth of the
// sampling rate, where a machine that is sampled well does not follow any more; what a residual has below, in excess of
// that, is no such noise. The spectrum is the median over stretches of the record: what a model misses in a few of
// them, at a step or a glitch, does not count.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace hysteron::diagnosis {

/// σ, in the unit of the residuals, which lie one record behind the other with so many samples each; 0 where a record
/// of 256 samples is missing. Of white noise right to a few hundredths; of coloured, up to a pole of 0.7, to an
/// eighth in the mean and to a third of itself in one record, above that rather too much.
[[nodiscard]] double noise_by_fast_part(const Eigen::VectorXd& residuals, const std::vector<std::size_t>& samples);

}  // namespace hysteron::diagnosis
