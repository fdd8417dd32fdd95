// Screening: how much of the residual each candidate could explain, from a few rollouts each.
//
// With the residual r, the sensitivities J of the known parameters and the change D that the effect makes to the
// outputs at one setting, the explained part is
//
//   ½‖P r‖² − min over α of ½‖P (r + α D)‖²,   P = projection off J (with the prior of the known parameters),
//
// so that what a calibration closes does not count. An effect in whose strengths the output is linear needs one
// setting of its strengths for each of its shapes, and α is free; another one is tried on its whole grid with α = 1.
#pragma once

#include <vector>

#include "diagnosis/effects/candidates.hpp"
#include "diagnosis/effects/starts.hpp"
#include "diagnosis/model/background.hpp"

namespace hysteron::diagnosis {

struct Start {
  VectorXd values{};  ///< of the effect's parameters
  double gain = 0.0;
  bool about_calibration = false;  ///< found with the known parameters as calibrated, not as tuned
  bool measured = false;           ///< read from the measurement: it is fitted, whatever a straight line promises
};

struct Screened {
  Candidate candidate{};
  std::vector<Unknown> unknowns{};  ///< of the effect, beside candidate.own().paths without settings
  std::vector<Start> starts{};      ///< best first; empty where the effect changes nothing
  [[nodiscard]] double gain() const { return starts.empty() ? 0.0 : starts.front().gain; }
};

/// `at` is the fit of the base; `base` its unknowns are the first ones of the candidate's model.
[[nodiscard]] Screened screened(const Task& task, Candidate candidate, const Grids& grids, const VectorXd& at,
                                const Background& background, std::size_t keep);

/// On the whole grids, near the starts that grids with one point in `stride` have found.
[[nodiscard]] Screened screened_about(const std::vector<Start>& coarse, std::size_t stride, const Task& task,
                                      Candidate candidate, const Grids& grids, const VectorXd& at,
                                      const Background& background, std::size_t keep);

}  // namespace hysteron::diagnosis
