// Glitches: single samples, or up to three in a row, far off their neighbours, found in the measurement and, where the
// signal itself is fast, in what a model leaves of it.
//
// A sample is one if it differs from the median of the seven about it by more than six standard deviations of such
// differences, by their median, and the samples on either side lie level: a sharp peak of the signal has flanks. What
// is found is left out of every fit: a few of them would outweigh all else.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "tuning/output_error.hpp"

namespace hysteron::diagnosis {

struct Glitches {
  std::vector<std::size_t> rows{};  ///< of one output, record by record
  double rms = 0.0;                 ///< √(Σe²/N) over all N samples, in the unit of the output
  double new_rms = 0.0;             ///< likewise, of those samples that were not known before
  double largest = 0.0;
};

/// The standard deviation of most of them: by the median of those that are not 0, which rounding makes many.
[[nodiscard]] double spread(const std::vector<double>& differences);

/// In the measurement alone.
[[nodiscard]] Glitches find_glitches(const std::vector<Experiment>& experiments, std::size_t output);

/// And in what a model leaves, `modelled` being its output for all experiments one after the other: those that are
/// larger than the model moves nearby, and where there are three of them the smaller ones too. A repeated value is a
/// missed sample. `found` again where that does not show more.
[[nodiscard]] Glitches with_model(const Glitches& found, const std::vector<Experiment>& experiments, std::size_t output,
                                  std::span<const double> modelled);

}  // namespace hysteron::diagnosis
