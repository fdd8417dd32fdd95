// Where the fit of a candidate begins: a grid over the parameters in which the output is not smooth or has many
// minima, laid by what each parameter measures and how large the signal is.
#pragma once

#include <limits>
#include <vector>

#include "diagnosis/effects/candidates.hpp"
#include "diagnosis/effects/signals.hpp"
#include "diagnosis/model/model.hpp"

namespace hysteron::diagnosis {

/// What the residual of the diagram says beforehand.
struct Hints {
  double sample_time = 0.0;
  double duration = 0.0;              ///< of the longest record, s
  std::vector<double> frequencies{};  ///< of lines in the residual, Hz
  std::size_t outstanding = 0;        ///< so many of them, at the front, are lines beyond doubt
  std::vector<double> quanta{};       ///< steps on which the measured values lie
};

/// Lines of the residual's spectrum, for what oscillates, and steps of the measured values.
[[nodiscard]] Hints hints_of(const Task& task, const Eigen::VectorXd& residuals);

/// Sizes to be tried for one parameter: for a strength, from small to large; for a shape, all over its range.
struct Grid {
  std::vector<double> values{};
  std::size_t guessed = 0;   ///< so many at the front are guesses from the record, each of its own
  std::size_t measured = 0;  ///< and of these so many show in the measured values themselves
  double lowest = -std::numeric_limits<double>::infinity();  ///< and below which
  double highest = std::numeric_limits<double>::infinity();  ///< beyond which the record does not show what it is
};

struct Grids {
  std::vector<Grid> parameters{};  ///< beside the effect's parameters
  std::vector<double> settings{};  ///< of references, NaN elsewhere
};

/// No values yet, and the range in which a record of that many seconds shows what a parameter is.
[[nodiscard]] Grid bounded(const EffectParameter& parameter, double sample_time, double duration);

/// `input` is the signal that the effect changes, `auxiliary` what drives its first further input.
[[nodiscard]] Grids grids_of(const Candidate& candidate, const Extent& input, const Extent* auxiliary,
                             const Hints& hints, const std::vector<double>& periods);

/// The same change with what the record does not tell taken otherwise: 0 for a centre where the middle of the signal is
/// elsewhere; what was before the record, where its start is not 0.
[[nodiscard]] std::vector<Candidate> other_guesses(const Candidate& candidate, const Extent& input,
                                                   const Extent* auxiliary);

/// With one point in so many of each long grid: enough to see which candidates deserve the whole of it.
/// Lines and periods stay: each is a guess of its own.
[[nodiscard]] Grids thinned(const Applied& effect, const Grids& grids, std::size_t stride);

/// The unknown that a parameter of an effect becomes in a fit, at its neutral or default value.
[[nodiscard]] Unknown unknown_of(const EffectParameter& parameter, const std::string& path, const Grid& grid);

}  // namespace hysteron::diagnosis
