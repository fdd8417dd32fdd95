// What of a residual is a gap: it stands above the noise by more than the floor's own doubt, and matters to the user.
#pragma once

#include <vector>

#include "diagnosis/model/model.hpp"
#include "diagnosis/noise/noise_floor.hpp"

namespace hysteron::diagnosis {

/// Of the outputs of a task. It keeps references to what it is made of.
class Materiality {
 public:
  /// `least` is the RMS below which a gap does not matter to the user, in the unit of the outputs.
  Materiality(const Task& task, const std::vector<NoiseFloor>& floors, double least)
      : task_(task), floors_(floors), least_(least) {}

  /// Whether one RMS is so far above another one that the difference is no noise and matters.
  [[nodiscard]] bool matters(double high, double low, std::size_t output) const;

  /// Whether something remains of the residuals, of one output or of any, beyond the floor, that matters.
  [[nodiscard]] bool is_left(const VectorXd& residuals, std::size_t output) const;
  [[nodiscard]] bool is_left(const VectorXd& residuals) const;

  /// Whether what is left stands out of the noise, and is only too small to matter.
  [[nodiscard]] bool is_too_small(const VectorXd& residuals) const;

  /// Whether the floor of an output held what effects explain: they leave notably less than what was left before them,
  /// and less than the floor. No few parameters that hold on data held out do that to noise; a sensor's coarse steps
  /// look like it while a machine moves, and a slow line like its drift.
  [[nodiscard]] bool was_taken_for_noise(const VectorXd& before, const VectorXd& after) const;

 private:
  [[nodiscard]] double rms(const VectorXd& residuals, std::size_t output) const;

  const Task& task_;
  const std::vector<NoiseFloor>& floors_;
  double least_;
};

}  // namespace hysteron::diagnosis
