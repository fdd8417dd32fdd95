// The noise in stretches of a signal in which nothing else should move: dwells, or differences of cycles.
#pragma once

#include <cstddef>
#include <vector>

#include "records/record.hpp"

namespace hysteron::diagnosis {

struct StretchNoise {
  double variance = 0.0;
  std::size_t samples = 0;
  double worth = 0.0;  ///< independent samples: slow noise has fewer
};

/// The variance in each stretch after a polynomial of the order is taken off it, and from all of them together lines of
/// one frequency, phase and size that stand out from what is left: those are a disturbance, and so part of the gap.
/// What lies beyond six standard deviations counts as six. Stretches that are too short are left out.
[[nodiscard]] std::vector<StretchNoise> noise_of_stretches(const std::vector<double>& values,
                                                           const std::vector<records::RowRange>& stretches, int order);

/// The standard deviation that 30 % of the samples lie in stretches below, less what chance makes of the quietest ones.
/// Noise is as large in each stretch; what a machine still does after a motion is not. 0 where there are fewer samples.
[[nodiscard]] double lower_deviation(std::vector<StretchNoise> stretches, std::size_t fewest);

}  // namespace hysteron::diagnosis
