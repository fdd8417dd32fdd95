// Missed samples: runs in which a measured signal repeats the last value that came, while the machine moves on.
//
// In the measurement alone a run shows by its end: the signal stands still to within the noise, and then makes up for
// it in one step, by as much as its slope before and after would have moved it. A quantizer has no slope between its
// steps, a standstill no step. Where such runs are found, the calibrated model shows those too that lie in a bend or
// next to each other: it moves where the measurement stands, and the step brings both together again. What is found is
// left out of every fit.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "tuning/output_error.hpp"

namespace hysteron::diagnosis {

struct MissedSamples {
  std::vector<std::size_t> rows{};  ///< of one output, record by record, in their order
  std::size_t longest = 0;          ///< samples in a row
  double rms = 0.0;                 ///< √(Σe²/N) over all N samples, against what a straight line would have shown
};

/// None where there are so few that chance, or another effect, makes them.
[[nodiscard]] MissedSamples find_missed_samples(const std::vector<Experiment>& experiments, std::size_t output);

/// Where those are too few, with a model that moves on meanwhile, by so much that a slow signal behind a quantizer is
/// none. A dead time explains the standing as well, of a signal that rested when its input began to move; and what
/// yields or follows late does not make up for its way in one leap: neither is a missed sample. `modelled` holds the
/// output's values, record by record, and `noise` is their noise floor.
[[nodiscard]] MissedSamples find_missed_samples(const std::vector<Experiment>& experiments, std::size_t output,
                                                std::span<const double> modelled, double noise);

/// Those that the model shows too.
[[nodiscard]] MissedSamples with_model(const MissedSamples& found, const std::vector<Experiment>& experiments,
                                       std::size_t output, std::span<const double> modelled);

}  // namespace hysteron::diagnosis
