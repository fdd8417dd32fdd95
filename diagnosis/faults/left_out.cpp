#include "diagnosis/faults/left_out.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ranges>
#include <utility>

#include "diagnosis/faults/missed_samples.hpp"
#include "diagnosis/model/least_squares.hpp"
#include "diagnosis/model/task.hpp"
#include "diagnosis/noise/glitches.hpp"
#include "support/median.hpp"

namespace hysteron::diagnosis {
namespace {

/// The model shows samples that the measurement alone does not, and without them is calibrated better.
constexpr int rounds_with_model = 2;

LeftOut as_left_out(Glitches glitches, std::size_t output, const Task& task, const Program& program) {
  return {.effect = "glitches",
          .output = output,
          .rms = glitches.rms,
          .remark = fmt::format("{} single samples of {} lie far off their neighbours, by up to {:.3g}; they are left "
                                "out of the fits.",
                                glitches.rows.size(), task.outputs[output], glitches.largest),
          .parameters = {as_counted("COUNT", static_cast<double>(glitches.rows.size())),
                         as_counted("LARGEST", glitches.largest, unit_of(program, task.outputs[output]))},
          .glitches = std::move(glitches.rows)};
}

/// An output as a model gives it, of all records one after the other; as measured where it gives none.
std::vector<double> modelled(const Task& task, Model& model, const VectorXd& x, std::size_t output) {
  std::vector<double> values = model.measured(output);
  VectorXd residuals;
  if (model.residuals(x, residuals)) {
    const VectorXd own = residuals.segment(static_cast<Index>(output) * std::ssize(values), std::ssize(values));
    for (std::size_t k = 0; k < values.size(); ++k) {
      values[k] += own[static_cast<Index>(k)] * task.scales[output];
    }
  }
  return values;
}

/// The standard deviation of what has these absolute values, by those that glitches hardly move: by their median, or
/// where a poor fit leaves much at times, at edges that it puts elsewhere, by what one in twenty is above.
double usual_deviation(const std::vector<double>& sizes) {
  constexpr double mostly = 0.95;
  constexpr double deviations = 1.96;  // that a normal distribution is above as often
  return std::max(deviation_of_median * median(sizes), quantile(sizes, mostly) / deviations);
}

/// Of an output whose first row is `first`; each row once, in order.
void add_rows(std::vector<Index>& left_out, const std::vector<std::size_t>& rows, Index first) {
  for (const std::size_t row : rows) {
    left_out.push_back(first + static_cast<Index>(row));
  }
  std::ranges::sort(left_out);
  left_out.erase(std::unique(left_out.begin(), left_out.end()), left_out.end());
}

class Finder {
 public:
  Finder(Task& task, const Program& program)
      : task_(task), program_(program), model_(task, program), rows_(model_.rows() / std::ssize(task.outputs)) {}

  std::vector<LeftOut> run() {
    for (std::size_t output = 0; output < task_.outputs.size(); ++output) {
      glitches_.push_back(find_glitches(experiments(), output));
      missed_.push_back(find_missed_samples(experiments(), output));
    }
    take_out();
    bool more = false;
    for (std::size_t output = 0; output < task_.outputs.size(); ++output) {
      const std::vector<double> model = modelled(task_, model_, model_.start(), output);
      if (missed_[output].rows.empty()) {
        missed_[output] = find_missed_samples(experiments(), output, model, task_.scales[output]);
      }
      const Glitches seen = with_model(glitches_[output], experiments(), output, model);
      more = more || !missed_[output].rows.empty() || seen.rows.size() > glitches_[output].rows.size();
    }
    for (int round = 0; more && round < rounds_with_model; ++round) {
      look_beside_model();
      take_out();
    }
    std::vector<LeftOut> found;
    for (std::size_t output = 0; output < task_.outputs.size(); ++output) {
      if (!glitches_[output].rows.empty()) {
        found.push_back(as_left_out(glitches_[output], output, task_, program_));
      }
      if (!missed_[output].rows.empty()) {
        found.push_back(described(missed_[output], output));
      }
    }
    std::ranges::stable_sort(found, [&](const LeftOut& a, const LeftOut& b) {
      return a.rms / task_.scales[a.output] > b.rms / task_.scales[b.output];
    });
    return found;
  }

 private:
  [[nodiscard]] const std::vector<Experiment>& experiments() const { return model_.problem().experiments; }

  void take_out() {
    task_.left_out.clear();
    for (std::size_t output = 0; output < task_.outputs.size(); ++output) {
      const Index first = static_cast<Index>(output) * rows_;
      add_rows(task_.left_out, glitches_[output].rows, first);
      add_rows(task_.left_out, missed_[output].rows, first);
    }
  }

  void look_beside_model() {
    Model without(task_, program_);
    const VectorXd calibrated = fit(without, without.start()).x;
    for (std::size_t output = 0; output < task_.outputs.size(); ++output) {
      const std::vector<double> model = modelled(task_, model_, calibrated, output);
      glitches_[output] = with_model(glitches_[output], experiments(), output, model);
      if (!missed_[output].rows.empty()) {
        missed_[output] = with_model(missed_[output], experiments(), output, model);
      }
    }
  }

  [[nodiscard]] LeftOut described(const MissedSamples& missed, std::size_t output) const {
    const double share = static_cast<double>(missed.rows.size()) / static_cast<double>(rows_);
    return {
        .effect = "clock",
        .output = output,
        .rms = missed.rms,
        .remark = fmt::format("{:.2g} % of the samples of {} repeat the last value while the signal moves on, up to "
                              "{} in a row: they were missed, and are left out of the fits.",
                              100.0 * share, task_.outputs[output], missed.longest),
        .parameters = {as_counted("MISSED", share), as_counted("LONGEST", static_cast<double>(missed.longest))}};
  }

  Task& task_;
  const Program& program_;
  Model model_;  ///< with all samples
  Index rows_;
  std::vector<Glitches> glitches_{};     ///< by output
  std::vector<MissedSamples> missed_{};  ///< by output
};

}  // namespace

ParameterFinding as_counted(std::string name, double value, std::string unit) {
  return {.name = std::move(name), .value = value, .low = value, .high = value, .unit = std::move(unit)};
}

Model model_of_all_rows(const Task& task, const Explanation& one) {
  Task whole = task;
  whole.left_out.clear();
  return {whole, *one.variant.program, one.variant.further};
}

std::vector<LeftOut> leave_out(Task& task, const Program& program) {
  return Finder(task, program).run();
}

bool leave_out_beside(std::vector<LeftOut>& found, Task& task, const Explanation& chosen,
                      const std::vector<NoiseFloor>& floors) {
  Model model = model_of_all_rows(task, chosen);
  const Index rows = model.rows() / std::ssize(task.outputs);
  bool more = false;
  for (std::size_t output = 0; output < task.outputs.size(); ++output) {
    const auto known = std::ranges::find_if(
        found, [&](const LeftOut& one) { return one.output == output && one.effect == "glitches"; });
    const Glitches before{.rows = known == found.end() ? std::vector<std::size_t>{} : known->glitches};
    Glitches beside =
        with_model(before, model.problem().experiments, output, modelled(task, model, chosen.fit.x, output));
    if (beside.rows.size() == before.rows.size() || beside.new_rms < least_excess(floors[output])) {
      continue;
    }
    more = true;
    add_rows(task.left_out, beside.rows, static_cast<Index>(output) * rows);
    LeftOut one = as_left_out(std::move(beside), output, task, *chosen.variant.program);
    if (known == found.end()) {
      found.push_back(std::move(one));
    } else {
      *known = std::move(one);
    }
  }
  return more;
}

void forget_explained(std::vector<LeftOut>& found, const Task& task, const Explanation& chosen) {
  if (std::ranges::all_of(found, [](const LeftOut& one) { return one.glitches.empty(); })) {
    return;  // a run over the records is saved
  }
  constexpr double least = 5.0;  // deviations of what is left elsewhere
  Model model = model_of_all_rows(task, chosen);
  VectorXd residuals;
  if (!model.residuals(chosen.fit.x, residuals)) {
    return;
  }
  const Index rows = residuals.size() / std::ssize(task.outputs);
  for (LeftOut& one : found) {
    if (one.glitches.empty()) {
      continue;
    }
    const double scale = task.scales[one.output];
    const VectorXd own = chosen.fit.residuals.segment(static_cast<Index>(one.output) * rows, rows).cwiseAbs();
    const double elsewhere = scale * std::max(1.0, usual_deviation({own.begin(), own.end()}));
    Glitches still;
    for (const std::size_t row : one.glitches) {
      const double off = scale * std::abs(residuals[static_cast<Index>(one.output) * rows + static_cast<Index>(row)]);
      if (off > least * elsewhere) {
        still.rows.push_back(row);
        still.rms += off * off;
        still.largest = std::max(still.largest, off);
      }
    }
    still.rms = std::sqrt(still.rms / static_cast<double>(rows));
    if (still.rows.size() < one.glitches.size()) {
      one = as_left_out(std::move(still), one.output, task, *chosen.variant.program);
    }
  }
  std::erase_if(found, [](const LeftOut& one) { return one.effect == "glitches" && one.rms == 0.0; });
}

}  // namespace hysteron::diagnosis
