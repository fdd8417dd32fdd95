#include "diagnosis/search/loop_noise.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "codegen/parameters/apply.hpp"
#include "diagnosis/effects/insertion.hpp"
#include "diagnosis/effects/signals.hpp"
#include "diagnosis/model/task.hpp"
#include "diagnosis/noise/noise_colour.hpp"
#include "diagnosis/noise/spectrum.hpp"

namespace hysteron::diagnosis {
namespace {

/// The slow part of a residual is a parabola through so many samples to either side.
constexpr std::size_t reach = 10;
/// Of the fast part that another output is left with, what the noise has to leave at most; of the others, too; and of
/// what an effect leaves, noise that is taken anew.
constexpr double most_left = 0.7;
constexpr double most_elsewhere = 1.1;
/// Of the noise, what the sensor may have rounded off.
constexpr double most_rounded = 0.5;

/// A signal less the parabola that fits best about each sample (Savitzky and Golay 1964); less of it at both ends.
Signal fast_part(const Signal& signal) {
  Signal result(signal.size());
  for (std::size_t k = 0; k < signal.size(); ++k) {
    const auto m = static_cast<std::ptrdiff_t>(std::min({reach, k, signal.size() - 1 - k}));
    const auto weight = [m](std::ptrdiff_t i) {
      return 3.0 * static_cast<double>(3 * m * m + 3 * m - 1 - 5 * i * i) /
             static_cast<double>((2 * m + 3) * (2 * m + 1) * (2 * m - 1));
    };
    double slow = 0.0;
    for (std::ptrdiff_t i = -m; i <= m; ++i) {
      slow += weight(i) * signal[static_cast<std::size_t>(static_cast<std::ptrdiff_t>(k) + i)];
    }
    result[k] = signal[k] - slow;
  }
  return result;
}

/// By record, the noise of an output in its unit: what a model's residuals have of it that is fast.
RecordSignals noise_of(const Task& task, std::size_t output, const VectorXd& residuals) {
  RecordSignals noise = by_record(task, residuals, output);
  for (Signal& signal : noise) {
    signal = fast_part(signal);
    std::ranges::transform(signal, signal.begin(), std::negate<>());  // measured − model
  }
  return noise;
}

double rms(const RecordSignals& signals) {
  double squares = 0.0;
  std::size_t count = 0;
  for (const Signal& signal : signals) {
    squares = std::inner_product(signal.begin(), signal.end(), signal.begin(), squares);
    count += signal.size();
  }
  return std::sqrt(squares / static_cast<double>(std::max<std::size_t>(1, count)));
}

/// By output, the fast part of its residuals.
std::vector<double> fast_parts(const Model& model, const VectorXd& residuals, std::size_t outputs) {
  const std::vector<std::size_t> samples = model.samples();
  const Index rows = residuals.size() / static_cast<Index>(outputs);
  std::vector<double> result;
  for (Index output = 0; output < static_cast<Index>(outputs); ++output) {
    result.push_back(noise_by_fast_part(residuals.segment(output * rows, rows), samples));
  }
  return result;
}

std::string free_input(const Variant& base, const std::string& top, const std::string& output) {
  Diagnostics none;
  const auto source = std::make_shared<const language::SourceFile>(language::parse("text", base.text, none));
  const Definitions definitions = define(source, none);
  return free_name(source->blocks[top_definition(definitions, top)], output + "_NOISE");
}

class Loops {
 public:
  Loops(Task task, const Variant& base, const std::string& top)
      : top_(top), task_(std::move(task)), noise_{.base = base} {
    Model model(task_, *base.program);
    fit_ = fit(model, model.start(), {.iterations = 20});
    left_ = fast_parts(model, fit_.residuals, task_.outputs.size());
  }

  void add(std::size_t output) {
    RecordSignals noise = noise_of(task_, output, fit_.residuals);
    const double size = rms(noise);
    const double step = common_step(task_.records.front().column(task_.outputs[output]).values);
    if (rounded_off(step) > most_rounded * size) {
      return;
    }
    Task task = task_;
    Variant base = noise_.base;
    base.noisy_outputs.push_back(
        {.output = task.outputs[output], .input = free_input(base, top_, task.outputs[output])});
    for (std::size_t e = 0; e < task.records.size(); ++e) {
      task.records[e].add({.name = base.noisy_outputs.back().input, .values = std::move(noise[e])});
    }
    auto program = std::make_shared<Program>(*compiled(base, top_));
    parameters::apply(task.file, program->graph);
    base.program = std::move(program);
    Model model(task, *base.program);
    VectorXd residuals;
    if (!model.residuals(fit_.x, residuals)) {
      return;
    }
    const std::vector<double> left = fast_parts(model, residuals, task.outputs.size());
    std::optional<std::size_t> shown;
    for (std::size_t other = 0; other < left.size(); ++other) {
      if (left[other] > most_elsewhere * left_[other]) {
        return;
      }
      if (other != output && left[other] < most_left * left_[other]) {
        shown = other;
      }
    }
    if (!shown) {
      return;
    }
    noise_.remark = fmt::format(
        "{}The noise of {} goes around in the loop, and the model's loop gets it, too: {:.3g}{} RMS, the fast part of "
        "what the model leaves. Of the fast part of {}, {:.3g} is then left of {:.3g}.",
        noise_.remark.empty() ? "" : noise_.remark + " ", task.outputs[output], size, unit_of(output),
        task.outputs[*shown], left[*shown] * task.scales[*shown], left_[*shown] * task.scales[*shown]);
    task_ = std::move(task);
    noise_.base = std::move(base);
    left_ = left;
  }

  LoopNoise take(Task& task) {
    task = std::move(task_);
    return std::move(noise_);
  }

  [[nodiscard]] bool has_fit() const { return std::isfinite(fit_.cost); }

 private:
  [[nodiscard]] std::string unit_of(std::size_t output) const {
    const std::string& unit = find_port(noise_.base.program->graph.outputs, task_.outputs[output])->unit;
    return unit.empty() ? "" : " " + unit;
  }

  const std::string& top_;
  Task task_;
  LoopNoise noise_;
  Fit fit_{};
  std::vector<double> left_{};  ///< by output
};

}  // namespace

LoopNoise with_loop_noise(Task& task, const Variant& base, const std::string& top) {
  if (task.outputs.size() < 2) {
    return {.base = base};
  }
  Loops loops(task, base, top);
  for (std::size_t output = 0; loops.has_fit() && output < task.outputs.size(); ++output) {
    loops.add(output);
  }
  return loops.take(task);
}

bool renew_loop_noise(Task& task, const Explanation& best) {
  if (best.variant.noisy_outputs.empty()) {
    return false;
  }
  Task renewed = task;
  for (const NoisyOutput& noisy : best.variant.noisy_outputs) {
    const auto output = static_cast<std::size_t>(std::ranges::find(task.outputs, noisy.output) - task.outputs.begin());
    RecordSignals noise = noise_of(task, output, best.fit.residuals);
    for (std::size_t e = 0; e < noise.size(); ++e) {
      renewed.records[e].replace(noisy.input, std::move(noise[e]));
    }
  }
  Model model(renewed, *best.variant.program, best.variant.further);
  VectorXd residuals;
  if (!model.residuals(best.fit.x, residuals) ||
      residuals.squaredNorm() > most_left * best.fit.residuals.squaredNorm()) {
    return false;
  }
  task = std::move(renewed);
  return true;
}

Explanation without_noise(Explanation one, const std::string& top) {
  if (!one.variant.noisy_outputs.empty()) {
    one.variant.noisy_outputs.clear();
    one.variant.program = compiled(one.variant, top);
  }
  return one;
}

}  // namespace hysteron::diagnosis
