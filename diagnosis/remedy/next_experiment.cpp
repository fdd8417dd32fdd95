#include "diagnosis/remedy/next_experiment.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "diagnosis/effects/set_words.hpp"
#include "diagnosis/model/parallel.hpp"
#include "diagnosis/model/projection.hpp"
#include "diagnosis/remedy/excitations.hpp"
#include "tuning/fitted_program.hpp"
#include "tuning/simulation.hpp"

namespace hysteron::diagnosis {
namespace {

/// What has to be left between two rivals, or of an effect, RMS over the noise. A rival is ruled out by 4 nats, N s²/2,
/// and a record counts as sixty independent samples at least (verdict.cpp): s = √(8/60).
constexpr double least_separation = 0.37;

/// A user's limit of an input; nothing where there is none.
std::optional<double> limit_of(const std::vector<std::pair<std::string, double>>& limits, const std::string& name) {
  for (const auto& [key, value] : limits) {
    if (language::same_name(key, name) && std::isfinite(value)) {
      return value;
    }
  }
  return std::nullopt;
}

/// An explanation as a model of its own: its effects' parameters are known ones at their fitted values.
struct Contender {
  const Explanation* explanation = nullptr;
  Program program{};
  std::vector<Unknown> unknowns{};  ///< the known parameters, then those of the effects
  Index first_effect = 0;
};

Contender contender(const Task& task, const Explanation& explanation) {
  Contender result{.explanation = &explanation, .program = fitted_program(task, explanation), .unknowns = task.known};
  result.first_effect = std::ssize(task.known);
  result.unknowns.insert(result.unknowns.end(), explanation.variant.further.begin(), explanation.variant.further.end());
  for (std::size_t j = 0; j < result.unknowns.size(); ++j) {
    result.unknowns[j].start = explanation.fit.x[static_cast<Index>(j)];
    result.unknowns[j].deviation = 0.0;
  }
  return result;
}

class Planner {
 public:
  Planner(Task task, std::vector<Contender> contenders, double noise)
      : task_(std::move(task)), contenders_(std::move(contenders)), noise_(noise) {
    task_.file.values.clear();  // the fitted programs have them
    task_.file.initial.clear();
    task_.initial_states.clear();
    task_.known.clear();
    if (task_.scales.size() != task_.outputs.size()) {
      task_.scales.assign(task_.outputs.size(), 1.0);
    }
  }

  /// In units of the noise; 0 where a rival has no finite output.
  [[nodiscard]] double separation(const std::string& input, const Excitation& excitation) const {
    const records::Record command = record_of(input, excitation);
    if (contenders_.size() < 2) {
      return own_signature(command, contenders_.front());
    }
    return std::min(left_between(command, contenders_[0], contenders_[1]),
                    left_between(command, contenders_[1], contenders_[0]));
  }

 private:
  /// The record of an experiment: one input moves, the others stay where they stood when the record began.
  [[nodiscard]] records::Record record_of(const std::string& input, const Excitation& excitation) const {
    const records::Record& old = task_.records.front();
    records::Record record = records::Record::even(0.0, old.sample_time(), excitation.values.size());
    for (const records::Column& column : old.columns()) {
      if (std::ranges::any_of(task_.outputs,
                              [&](const std::string& one) { return language::same_name(one, column.name); })) {
        continue;
      }
      std::vector<double> values = excitation.values;
      if (!language::same_name(column.name, input)) {
        values.assign(excitation.values.size(), column.values.front());
      }
      record.add({.name = column.name, .unit = column.unit, .values = std::move(values)});
    }
    return record;
  }

  /// A model of one contender against the outputs of another one.
  [[nodiscard]] bool compare(const records::Record& command, const Contender& model_of, const Contender& truth,
                             VectorXd& residuals, MatrixXd& jacobian) const {
    records::Record record = command;
    const std::vector<Signal> outputs = simulate(truth.program, command);
    const Graph& graph = truth.program.graph;
    for (const std::string& name : task_.outputs) {
      for (std::size_t i = 0; i < graph.outputs.size(); ++i) {
        if (language::same_name(graph.outputs[i].name, name)) {
          if (!std::ranges::all_of(outputs[i], [](double value) { return std::isfinite(value); })) {
            return false;
          }
          record.add({.name = name, .unit = graph.outputs[i].unit, .values = outputs[i]});
        }
      }
    }
    Task task = task_;
    task.records = {std::move(record)};
    task.left_out.clear();  // rows of the old records
    Model model(task, model_of.program, model_of.unknowns);
    return model.residuals(model.start(), residuals, &jacobian);
  }

  /// RMS of the output that is left most of, over the noise. Residuals are in scales, the noise in the first one.
  [[nodiscard]] double over_noise(const VectorXd& left) const {
    const Index outputs = std::ssize(task_.outputs);
    const Index rows = left.size() / outputs;
    double largest = 0.0;
    for (Index i = 0; i < outputs; ++i) {
      largest = std::max(largest, left.segment(i * rows, rows).norm() / std::sqrt(static_cast<double>(rows)));
    }
    // Derivatives of a loop that sticks and slips can grow beyond all bounds, and then say nothing.
    const double ratio = largest * task_.scales.front() / noise_;
    return std::isfinite(ratio) ? ratio : 0.0;
  }

  [[nodiscard]] double left_between(const records::Record& command, const Contender& a, const Contender& b) const {
    VectorXd residuals;
    MatrixXd jacobian;
    return compare(command, a, b, residuals, jacobian) ? over_noise(Projection(jacobian).rest(residuals)) : 0.0;
  }

  /// What the strengths of the last effect together, as they are fitted, do to the output beyond what all other
  /// parameters can do.
  [[nodiscard]] double own_signature(const records::Record& command, const Contender& one) const {
    VectorXd residuals;
    MatrixXd jacobian;
    if (!compare(command, one, one, residuals, jacobian)) {
      return 0.0;
    }
    const VectorXd sizes = strengths_of(one, jacobian.cols());
    if (sizes.isZero(0.0)) {  // no effect at all: what the known parameters do together
      return over_noise(jacobian.rowwise().norm());
    }
    MatrixXd others(jacobian.rows(), jacobian.cols());
    Index kept = 0;
    for (Index j = 0; j < jacobian.cols(); ++j) {
      if (sizes[j] == 0.0) {
        others.col(kept++) = jacobian.col(j);
      }
    }
    return over_noise(Projection(others.leftCols(kept)).rest(jacobian * sizes));
  }

  /// How far the strengths of the last effect lie off neutral, by unknown; 0 for all else, and for a bound that is not
  /// there.
  [[nodiscard]] static VectorXd strengths_of(const Contender& one, Index count) {
    VectorXd sizes = VectorXd::Zero(count);
    if (one.explanation->variant.effects.empty()) {
      return sizes;
    }
    const Applied& effect = one.explanation->variant.effects.back();
    for (std::size_t k = 0; k < effect.parameters.size(); ++k) {
      const double neutral = effect.parameters[k].field.neutral;
      for (Index j = one.first_effect; effect.parameters[k].strength && j < std::ssize(one.unknowns); ++j) {
        const Unknown& unknown = one.unknowns[static_cast<std::size_t>(j)];
        if (unknown.path == effect.paths[k] && std::isfinite(unknown.start)) {
          sizes[j] = unknown.start - (std::isfinite(neutral) ? neutral : 0.0);
        }
      }
    }
    return sizes;
  }

  Task task_;
  std::vector<Contender> contenders_;
  double noise_;
};

/// What the records and the user allow an input; without a range where it does not move.
InputLimits limits_of(const Task& task, const Port& input, const std::vector<std::pair<std::string, double>>& limits) {
  InputLimits result{.name = input.name, .unit = input.unit};
  bool any = false;
  for (const records::Record& record : task.records) {
    const records::Column* const column = record.find(input.name);
    if (column == nullptr || column->values.empty()) {
      continue;
    }
    const auto [least, most] = std::ranges::minmax(column->values);
    result.low = any ? std::min(result.low, least) : least;
    result.high = any ? std::max(result.high, most) : most;
    result.start = any ? result.start : column->values.front();
    result.sample_time = any ? result.sample_time : record.sample_time();
    result.unit = result.unit.empty() ? column->unit : result.unit;
    for (std::size_t k = 1; k < column->values.size(); ++k) {
      result.rate = std::max(result.rate, std::abs(column->values[k] - column->values[k - 1]) / record.sample_time());
    }
    const double length = static_cast<double>(record.size()) * record.sample_time();
    result.duration = std::max({result.duration, 4.0 * length, 2000.0 * record.sample_time()});
    any = true;
  }
  if (const auto largest = limit_of(limits, input.name)) {
    result.low = result.low < 0.0 ? -std::abs(*largest) : 0.0;
    result.high = std::abs(*largest);
  }
  result.low = limit_of(limits, input.name + ".low").value_or(result.low);
  result.high = limit_of(limits, input.name + ".high").value_or(result.high);
  result.rate = limit_of(limits, input.name + ".rate").value_or(result.rate);
  result.start = std::clamp(result.start, std::min(result.low, result.high), std::max(result.low, result.high));
  return result;
}

/// All inputs but one, each where it stood when the first record began, or at its default.
std::vector<NextExperiment::Resting> resting_of(const Task& task, const Graph& graph, const std::string& moving) {
  std::vector<NextExperiment::Resting> result;
  for (const Port& input : graph.inputs) {
    if (!language::same_name(input.name, moving)) {
      const records::Column* const column = task.records.front().find(input.name);
      const bool recorded = column != nullptr && !column->values.empty();
      result.push_back({.input = input.name,
                        .unit = input.unit.empty() && recorded ? column->unit : input.unit,
                        .value = recorded ? column->values.front() : input.preset});
    }
  }
  return result;
}

std::string words(const Explanation& explanation) {
  return words_of_set(explanation.names());
}

/// Of a single hypothesis: what the experiment is to show.
std::string shown(const Explanation& only) {
  return only.names().empty() ? "the fitted parameters" : words(only);
}

/// Beyond a thousand times the noise nothing is told from anything: the figure is one of rounding.
std::string times_the_noise(double separation) {
  return separation > 1000.0 ? std::string("more than 1000 times the noise")
                             : fmt::format("{:.2g} times the noise", separation);
}

struct Trial {
  InputLimits limits{};
  Excitation excitation{};
  double separation = 0.0;
};

}  // namespace

Program fitted_program(const Task& task, const Explanation& explanation) {
  const Model model(task, *explanation.variant.program, explanation.variant.further);
  return fitted_program(model.problem(), explanation.fit.x);
}

NextExperiment next_experiment(const Task& task, std::span<const Explanation> rivals,
                               const std::vector<std::pair<std::string, double>>& limits, double noise_rms) {
  NextExperiment result;
  if (rivals.empty() || task.records.empty() || task.outputs.empty()) {
    return result;
  }
  const Explanation& first = rivals.front();
  const auto second =
      std::ranges::find_if(rivals, [&](const Explanation& one) { return one.names() != first.names(); });
  std::vector<Contender> contenders{contender(task, first)};
  if (second != rivals.end()) {
    contenders.push_back(contender(task, *second));
  }
  std::vector<Trial> trials;
  for (const Port& input : contenders.front().program.graph.inputs) {
    if (input.type == Type::Real) {
      const InputLimits allowed = limits_of(task, input, limits);
      for (Excitation& excitation : excitations(allowed)) {
        trials.push_back({.limits = allowed, .excitation = std::move(excitation)});
      }
    }
  }
  const Planner planner(task, std::move(contenders), noise_rms > 0.0 ? noise_rms : 1.0);
  in_parallel(trials.size(), 2, [&](std::size_t i) {
    trials[i].separation = planner.separation(trials[i].limits.name, trials[i].excitation);
  });
  const auto best = std::ranges::max_element(trials, {}, &Trial::separation);
  const bool alone = second == rivals.end();
  const std::string wanted =
      alone ? fmt::format("show {}", shown(first)) : fmt::format("tell {} from {}", words(first), words(*second));
  if (best == trials.end()) {
    result.reason = fmt::format("no excitation has room within the limits to {}", wanted);
    return result;
  }
  if (!(best->separation >= least_separation)) {
    result.reason = fmt::format(
        "no excitation of the catalogue within the limits would {}: the best leaves {:.2g} times "
        "the noise, and {} is the least that tells",
        wanted, best->separation, least_separation);
    return result;
  }
  result.title = best->excitation.title;
  result.input = best->limits.name;
  result.unit = best->limits.unit;
  result.separation = best->separation;
  result.reason = alone ? fmt::format("shows {} best: {} beyond what other parameters can do; {}", shown(first),
                                      times_the_noise(best->separation), best->excitation.shows)
                        : fmt::format("{} and {} would differ by {}, refitted; it shows {}", words(first),
                                      words(*second), times_the_noise(best->separation), best->excitation.shows);
  for (std::size_t k = 0; k < best->excitation.values.size(); ++k) {
    result.time.push_back(static_cast<double>(k) * best->limits.sample_time);
  }
  result.values = best->excitation.values;
  result.resting = resting_of(task, first.variant.program->graph, result.input);
  result.steps = best->excitation.steps;
  return result;
}

}  // namespace hysteron::diagnosis
