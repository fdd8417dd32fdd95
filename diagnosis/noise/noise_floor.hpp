// The noise floor of a measured output, from the measurement alone: the model's residual would count the gap as noise.
//
// Three estimates, of which the largest that the record allows counts, differences only where dwells do not refute
// them:
// - differences: the n-th difference of a slow signal is that of its noise, σ² = E(∆ⁿy)²/C(2n, n); by the median, over
//   several orders, the smallest. It sees what is fast only: too little where noise is coloured, too much where the
//   signal itself is fast.
// - dwells: while all that was logged stands still but for the flicker of its own sensors, what is left of y after a
//   slow course is taken off; or of what a model leaves of y, where the machine still moves as the model does. What
//   goes on smoothly there is no noise: a machine that swings free while its commands rest.
// - repeats: where the inputs repeat themselves, y of one cycle less that of the next one, over √2, trends taken off.
// - steps: where a sensor rounds and noise follows, what lies off the steps. The others count leaps between two steps,
//   too, so this one goes before differences and dwells.
// In dwells and repeats a line of one frequency is no noise, and quiet stretches count: in others the machine still
// moves. Glitches, which no fit sees, are in none of them: one spike of a bad contact would be the noise of all cycles.
#pragma once

#include <string>
#include <vector>

#include "tuning/output_error.hpp"

namespace hysteron::diagnosis {

/// Of an output's range: a sensor that rounds more than this off, RMS, is an effect, and less is noise.
inline constexpr double most_rounding = 0.02;

struct NoiseFloor {
  double differences = 0.0;  ///< standard deviations in the unit of the output; 0 where there is no such evidence
  double dwells = 0.0;
  double repeats = 0.0;
  double off_steps = 0.0;
  double value = 0.0;      ///< the one that counts, above 0
  std::string evidence{};  ///< "repeats", "steps", "dwells" or "differences"
};

/// √(−2 ln |mean exp(2πi y/q)|)·q/2π, of values on steps q with noise behind the rounding; 0 where there are no steps,
/// or the values lie on them, but for stretches that were mended afterwards.
[[nodiscard]] double noise_off_steps(const std::vector<double>& values);

/// For one measured output over all records. `others`: by record, what else was logged, and moves the machine perhaps.
/// `unmodelled`: by record, what a model leaves of the output. A machine that still rings where its inputs rest rings
/// less in that, and dwells take the smaller one.
[[nodiscard]] NoiseFloor noise_floor(const std::vector<Experiment>& experiments, std::size_t output,
                                     const std::vector<std::vector<Signal>>& others = {},
                                     const std::vector<Signal>& unmodelled = {});
/// The same where the glitches of the output are known, as find_glitches() gives their rows.
[[nodiscard]] NoiseFloor noise_floor_without(const std::vector<std::size_t>& glitches,
                                             const std::vector<Experiment>& experiments, std::size_t output,
                                             const std::vector<std::vector<Signal>>& others,
                                             const std::vector<Signal>& unmodelled = {});

/// The RMS by which a gap stands out of the floor at least, as √(rms² − floor²), in the unit of the output. More where
/// the floor does not come from repeats: what else there is may have missed slow noise.
[[nodiscard]] double least_excess(const NoiseFloor& floor);

/// What the noise may be, in units of the floor. Slow noise hides from the floor, by a half as a rule at most, and is
/// no more than what is left; where less is left than the floor, this counted a fast effect as noise.
struct NoiseRange {
  double low = 1.0;     ///< with `high` a 95 % interval
  double likely = 1.0;  ///< the median
  double floor = 1.0;
  double high = 1.0;
};

/// `left`: RMS of the residual of the verdict's fit, over the floor.
[[nodiscard]] NoiseRange noise_range(double left);

/// The period of the inputs in samples, 0 where they do not repeat themselves at least twice.
[[nodiscard]] std::size_t input_period(const Experiment& experiment);

/// The standard deviation of white noise on a slow signal, by its differences.
[[nodiscard]] double noise_by_differences(const std::vector<double>& values);

}  // namespace hysteron::diagnosis
