// What a verdict leaves of a gap, and how much of that is no noise.
//
// The floor is the measurement's, and may be off: the fast part of the residual (noise_colour) tells by how much. An
// output is counted in units of what may be noise,
//
//   n = clamp(fast part, 1/2, most) floors,
//
// with `most` by what the floor rests on: differences see a third of a coloured noise, dwells lose what their trend
// takes, repeats nothing. Less than a floor it is where something shakes the machine that dwells and repeats count as
// noise: half of the floor at least stays noise, as noise may be slow.
#pragma once

#include <vector>

#include "diagnosis/model/model.hpp"
#include "diagnosis/noise/noise_floor.hpp"

namespace hysteron::diagnosis {

/// n, of the residuals of one output in floors, which lie one record behind the other with so many samples each.
[[nodiscard]] double possible_noise(const NoiseFloor& floor, const VectorXd& residuals,
                                    const std::vector<std::size_t>& samples);

/// n of each output, of residuals of all outputs.
[[nodiscard]] std::vector<double> possible_noise(const Model& model, const std::vector<NoiseFloor>& floors,
                                                 const VectorXd& residuals);

/// Of so much left, in units of what may be noise, the share of energy beyond what is suspicious.
[[nodiscard]] double excess_of(double size);

struct Remainder {
  double size = 0.0;            ///< RMS of all outputs, in units of what may be noise
  double open = 0.0;            ///< of the gap that calibration leaves, what is open beyond noise; 0 to 1
  double excess = 0.0;          ///< of what is left, see excess_of
  double share = 0.0;           ///< of its variance, what inputs and outputs foretell on blocks held out
  bool is_predictable = false;  ///< whether that is notable
};

/// `calibrated`: residuals of the calibrated diagram; `left`: those that the verdict leaves; `noise`: n by output.
[[nodiscard]] Remainder remainder_of(const Model& model, const VectorXd& calibrated, const VectorXd& left,
                                     const std::vector<double>& noise);

/// 0 to 1: what was called noise or an effect is neither. The fourth root of the share that stays open, times the
/// excess; likewise, where an excess is left, the doubt which of several sets it is: none may be the cause. `named`:
/// see probability_of_cause.
[[nodiscard]] double unknown_score(const Remainder& left, double named);

}  // namespace hysteron::diagnosis
