#include "diagnosis/verdict/plausibility.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "diagnosis/model/task.hpp"
#include "diagnosis/remedy/inverse_blocks.hpp"

namespace hysteron::diagnosis {
namespace {

/// The share of an output's variance that a calibrated diagram has to explain at least.
constexpr double least_explained = 0.25;
/// And the share of it that effects may leave open, where chance or what they add by themselves could explain the rest.
constexpr double most_open = 0.1;
/// What n parameters explain of N independent samples is n/N by chance: so many times it is none.
constexpr double beyond_chance = 40.0;
/// Deviations of the prior that a refit may move a parameter without a word.
constexpr double far = 4.0;

/// Whether each sample of an output counts, record by record.
std::vector<bool> counting(const Task& task, Index rows, std::size_t output) {
  std::vector<bool> result(static_cast<std::size_t>(rows), true);
  const Index first = static_cast<Index>(output) * rows;
  for (const Index row : task.left_out) {
    if (row >= first && row < first + rows) {
      result[static_cast<std::size_t>(row - first)] = false;
    }
  }
  return result;
}

/// The measured values of an output that count.
std::vector<double> measured(const Task& task, std::size_t output) {
  std::vector<double> values;
  for (const records::Record& record : task.records) {
    const std::vector<double>& column = record.column(task.outputs[output]).values;
    values.insert(values.end(), column.begin(), column.end());
  }
  const std::vector<bool> counts = counting(task, std::ssize(values), output);
  std::size_t kept = 0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (counts[k]) {
      values[kept++] = values[k];
    }
  }
  values.resize(kept);
  return values;
}

}  // namespace

std::string unrelated(const Task& task, const Explanation& calibrated, const Explanation& chosen,
                      double effective_samples) {
  // What acts on a signal, as a resonance does, and adds none of its own explains only what follows from the inputs.
  const bool adds =
      std::ranges::any_of(chosen.variant.effects, [](const Applied& applied) { return adds_to_input(applied.block); });
  const double by_chance = beyond_chance * static_cast<double>(chosen.fit.x.size()) / effective_samples;
  const double open_at_most = adds ? most_open : std::max(most_open, 1.0 - std::max(least_explained, by_chance));
  std::string text;
  for (std::size_t output = 0; output < task.outputs.size(); ++output) {
    const std::vector<double> values = measured(task, output);
    const auto count = static_cast<double>(values.size());
    const double mean = std::accumulate(values.begin(), values.end(), 0.0) / count;
    double variance = 0.0;
    for (const double y : values) {
      variance += (y - mean) * (y - mean) / count;
    }
    const double left = rms_of(task, calibrated.fit.residuals, output);
    const double open = rms_of(task, chosen.fit.residuals, output);
    if (left * left <= (1.0 - least_explained) * variance || open * open <= open_at_most * variance) {
      return {};  // an output that follows tells that the record is the machine's: a controller's may not
    }
    text += fmt::format("{}{:.3g} of {}, whose own standard deviation is {:.3g}", text.empty() ? "" : " and ", left,
                        task.outputs[output], std::sqrt(variance));
  }
  return fmt::format(
      "The calibrated diagram leaves {}: they have next to nothing in common, and no effect is named. Is it the record "
      "of this machine, with the right input, and are its rows in order?",
      text);
}

std::vector<std::string> far_parameters(const Task& task, const Explanation& chosen) {
  std::vector<std::string> result;
  for (std::size_t j = 0; j < task.known.size(); ++j) {
    const Unknown& known = task.known[j];
    const double value = chosen.fit.x[static_cast<Index>(j)];
    const double off = std::abs(value - known.start) / known.deviation;
    if (known.deviation > 0.0 && off > far) {
      result.push_back(
          fmt::format("{} goes from {:.4g} to {:.4g}{}{} in the refit, {:.1f} times what a tuning is taken to be off: "
                      "another unit, "
                      "another machine, or it stands in for what the diagram lacks.",
                      known.path, known.start, value, known.unit.empty() ? "" : " ", known.unit, off));
    }
  }
  return result;
}

}  // namespace hysteron::diagnosis
