// See output_error.hpp.
#include "tuning/output_error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "codegen/parameters/elements.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"
#include "support/numbers.hpp"
#include "support/root_mean_square.hpp"
#include "tuning/rollout.hpp"

namespace hysteron {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// What the heading of a tuned file begins with, and is known by when it is tuned again.
constexpr std::string_view tuned_by = "Fitted by hysteron tune to ";

/// A fraction in 0 … 1 that depends on the two numbers alone (S. Vigna's SplitMix64).
double fraction(std::uint64_t start, std::uint64_t unknown) {
  std::uint64_t z = (start * 1024 + unknown + 1) * 0x9E3779B97F4A7C15U;
  z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
  z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
  return static_cast<double>((z ^ (z >> 31U)) >> 11U) * 0x1.0p-53;
}

class Fitter {
 public:
  Fitter(const OutputErrorProblem& problem, const OutputErrorOptions& options)
      : problem_(problem), options_(options), rollout_(problem) {}

  OutputErrorFit run() {
    const auto begun = std::chrono::steady_clock::now();
    name_unknowns();
    scale_by_range();
    check_influence();
    fit_.scores.resize(problem_.outputs.size());
    score(least_squares_.start, &OutputScore::before);
    for (int start = 0; start < std::max(1, options_.starts); ++start) {
      fit_from(start);
      if (fit_.solution.status == FitStatus::Cancelled) {
        break;
      }
    }
    const bool finished =
        fit_.solution.status != FitStatus::Cancelled && fit_.solution.status != FitStatus::ModelFailed;
    if (finished && problem_.outputs.size() > 1) {
      weight_by_noise();
    }
    fit_.covariance = covariance_of(fit_.solution, fit_.names);
    for (std::size_t e = 0; e < problem_.experiments.size(); ++e) {
      fit_.model.push_back(rollout_.outputs(fit_.solution.x, e));
    }
    score(fit_.solution.x, &OutputScore::train);
    fit_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    return std::move(fit_);
  }

 private:
  void name_unknowns() {
    const Index n = rollout_.unknowns();
    least_squares_.start.resize(n);
    least_squares_.lower.resize(n);
    least_squares_.upper.resize(n);
    least_squares_.typical.resize(n);
    Index j = 0;
    for (const FreeParameter& free : problem_.parameters) {
      fit_.names.push_back(free.name);
      fit_.units.push_back(free.unit);
      least_squares_.start[j] = free.start;
      least_squares_.lower[j] = free.lower;
      least_squares_.upper[j] = free.upper;
      least_squares_.typical[j++] = free.typical;
    }
    const std::vector<double> states = rollout_.own_states(least_squares_.start);
    for (const detail::Rollout::StateColumn& column : rollout_.state_columns()) {
      const FreeState& state = problem_.initial_states[column.state];
      const Experiment& record = problem_.experiments[column.experiment];
      std::string when = "at the start";
      if (column.start > 0) {
        when = fmt::format("at t = {:.6g} s", record.time[record.restarts[column.start - 1]]);
      }
      if (problem_.experiments.size() > 1) {
        when += fmt::format(" of record {}", column.experiment + 1);
      }
      const double own = states[static_cast<std::size_t>(j - std::ssize(problem_.parameters))];
      fit_.names.push_back(fmt::format("{} {}", state.path, when));
      fit_.units.push_back(state.unit);
      least_squares_.start[j] = own;
      least_squares_.lower[j] = state.lower;
      least_squares_.upper[j] = state.upper;
      least_squares_.typical[j++] = own != 0.0 ? std::fabs(own) : 1.0;
    }
    least_squares_.names = fit_.names;
    least_squares_.residual_count = rollout_.residual_count();
    least_squares_.evaluate = [this](const VectorXd& x, VectorXd& residuals, MatrixXd* jacobian) {
      return rollout_.residuals(x, residuals, jacobian);
    };
  }

  /// Of what was measured of an output in a part of the records: 0 where there is none.
  [[nodiscard]] double range_in(std::vector<records::RowRange> Experiment::*part, std::size_t output) const {
    double low = infinity;
    double high = -low;
    for (const Experiment& experiment : problem_.experiments) {
      for (const records::RowRange& range : experiment.*part) {
        for (std::size_t row = range.first; row < range.last; ++row) {
          low = std::min(low, experiment.measured[output][row]);
          high = std::max(high, experiment.measured[output][row]);
        }
      }
    }
    return std::max(high - low, 0.0);
  }

  /// An output that stands still is measured by its size.
  void scale_by_range() {
    std::vector<double> scales;
    for (std::size_t output = 0; output < problem_.outputs.size(); ++output) {
      const Experiment& first = problem_.experiments.front();
      const double range = range_in(&Experiment::train, output);
      const double size = std::fabs(first.measured[output][first.train.front().first]);
      scales.push_back(range > 0.0 ? range : size > 0.0 ? size : 1.0);
    }
    rollout_.set_scales(scales);
  }

  /// A column of zeros at the start may come from the start itself (C3 where C2 = 0): a second point decides.
  void check_influence() {
    VectorXd residuals(rollout_.residual_count());
    MatrixXd jacobian(rollout_.residual_count(), rollout_.unknowns());
    if (!rollout_.residuals(least_squares_.start, residuals, &jacobian)) {
      return;  // solve() says so
    }
    Eigen::ArrayXd influence = jacobian.cwiseAbs().colwise().maxCoeff().transpose().array();
    if ((influence > 0.0).all()) {
      return;
    }
    VectorXd beside = least_squares_.start;
    for (Index j = 0; j < beside.size(); ++j) {
      const double step = 0.1 * least_squares_.typical[j];
      const double room = least_squares_.upper[j] - beside[j];
      beside[j] =
          room > step ? beside[j] + step : std::max(beside[j] - step, 0.5 * (least_squares_.lower[j] + beside[j]));
    }
    if (!beside.allFinite() || !rollout_.residuals(beside, residuals, &jacobian)) {
      return;
    }
    influence += jacobian.cwiseAbs().colwise().maxCoeff().transpose().array();
    Diagnostics diagnostics;
    for (Index j = 0; j < influence.size(); ++j) {
      if (influence[j] > 0.0) {
        continue;
      }
      const auto parameters = std::ssize(problem_.parameters);
      const auto states = std::max<Index>(std::ssize(problem_.initial_states), 1);
      const Place& place = j < parameters
                               ? problem_.parameters[static_cast<std::size_t>(j)].place
                               : problem_.initial_states[static_cast<std::size_t>((j - parameters) % states)].place;
      diagnostics.error(
          error::no_influence, place,
          fmt::format("{} has no influence on any measured sample in train.", fit_.names[static_cast<std::size_t>(j)]),
          j < parameters ? "take it out of the fit, or record what makes it act."
                         : mend_of_state(problem_.initial_states[static_cast<std::size_t>((j - parameters) % states)]));
    }
    if (diagnostics.has_errors()) {
      throw InputError(std::move(diagnostics));
    }
  }

  /// A block may set one of its states anew in the first sample, as a lag takes over its input, and keep another.
  [[nodiscard]] std::string mend_of_state(const FreeState& wanted) const {
    const std::string block = wanted.path.substr(0, wanted.path.rfind('.') + 1);
    OutputErrorProblem others = problem_;
    others.initial_states.clear();
    for (const Node& node : others.program.graph.nodes) {
      for (std::size_t state = 0;
           node.block != nullptr && node.path + "." == block && state < node.block->states.size(); ++state) {
        const Field& field = node.block->states[state];
        if (field.type == Type::Real && field.length == 1) {
          others.initial_states.push_back(
              {.path = block + std::string(field.name), .lower = field.minimum, .upper = field.maximum});
        }
      }
    }
    detail::Rollout rollout(others);
    const Index parameters = std::ssize(others.parameters);
    VectorXd x = VectorXd::Zero(rollout.unknowns());
    x.head(parameters) = least_squares_.start.head(parameters);
    const std::vector<double> own = rollout.own_states(x.head(parameters));
    std::ranges::copy(own, x.data() + parameters);
    VectorXd residuals(rollout.residual_count());
    MatrixXd jacobian(rollout.residual_count(), rollout.unknowns());
    std::vector<std::string> shown;
    if (rollout.residuals(x, residuals, &jacobian)) {
      for (std::size_t state = 0; state < others.initial_states.size(); ++state) {
        if (jacobian.col(parameters + static_cast<Index>(state)).cwiseAbs().maxCoeff() > 0.0) {
          shown.push_back(others.initial_states[state].path);
        }
      }
    }
    return shown.empty()
               ? "take it out of initial_states: no state of its block shows in the measured outputs."
               : fmt::format("its block sets it anew in the first sample: name {} instead.", fmt::join(shown, " or "));
  }

  [[nodiscard]] VectorXd start_point(int start) const {
    VectorXd x = least_squares_.start;
    for (Index j = 0; start > 0 && j < x.size(); ++j) {
      const double low = least_squares_.lower[j];
      const double high = least_squares_.upper[j];
      const double share = fraction(static_cast<std::uint64_t>(start), static_cast<std::uint64_t>(j));
      if (std::isfinite(low) && std::isfinite(high)) {
        x[j] = low + share * (high - low);
      } else if (low >= 0.0 && x[j] > 0.0) {
        x[j] = std::clamp(x[j] * std::pow(10.0, 2.0 * share - 1.0), low, high);
      } else {
        x[j] = std::clamp(x[j] + (4.0 * share - 2.0) * least_squares_.typical[j], low, high);
      }
    }
    return x;
  }

  [[nodiscard]] LeastSquaresOptions solver_options(int start) const {
    LeastSquaresOptions options{.loss = problem_.loss, .max_iterations = options_.max_iterations};
    if (options_.progress) {
      options.progress = [this, start](const FitProgress& progress) { return options_.progress(start, progress); };
    }
    return options;
  }

  /// What starts are compared by: with a threshold that follows the residuals, the threshold itself is their size.
  static double merit(const LeastSquaresResult& result) {
    return result.huber_threshold > 0.0 ? result.huber_threshold : result.cost;
  }

  /// HY711 where the parameters are named whose starts it may be. Which of several it is, only the user knows.
  [[nodiscard]] InputError start_error() const {
    const auto& free = problem_.parameters;
    Place place = free.empty() ? Place{} : free.front().place;
    std::vector<Note> notes;
    if (free.size() > 1) {
      place = {.file = place.file};
      for (const FreeParameter& one : free) {
        notes.push_back({.place = one.place, .text = fmt::format("{} starts at {}", one.name, number_text(one.start))});
      }
    }
    Diagnostics diagnostics;
    diagnostics.error(error::start_without_value, std::move(place),
                      free.size() == 1 ? fmt::format("The model has no finite value at the start of the fit, {} = {}.",
                                                     free.front().name, number_text(free.front().start))
                                       : "The model has no finite value at the start of the fit.",
                      "start from values at which the diagram runs without overflow or division by zero.",
                      std::move(notes));
    return InputError(std::move(diagnostics));
  }

  void fit_from(int start) {
    LeastSquaresProblem problem = least_squares_;
    problem.start = start_point(start);
    LeastSquaresResult result;
    try {
      result = solve(problem, solver_options(start));
    } catch (const InputError&) {
      if (start == 0) {
        throw start_error();
      }
      fit_.start_costs.push_back(not_a_number);  // no value there: the other starts go on
      return;
    }
    fit_.start_costs.push_back(result.cost);
    const bool usable = result.status != FitStatus::ModelFailed;
    if (start == 0 || (usable && merit(result) < merit(fit_.solution))) {
      fit_.solution = std::move(result);
      fit_.best_start = start;
    } else if (result.status == FitStatus::Cancelled) {
      fit_.solution.status = FitStatus::Cancelled;
      fit_.solution.message = std::string(plain_words(FitStatus::Cancelled));
    }
  }

  [[nodiscard]] double cost_at(const VectorXd& x) {
    VectorXd residuals(rollout_.residual_count());
    return rollout_.residuals(x, residuals, nullptr) ? 0.5 * residuals.squaredNorm() : infinity;
  }

  /// Again, with each output in units of the error that it was left with.
  void weight_by_noise() {
    std::vector<double> scales = rollout_.scales();
    const auto rows = fit_.solution.residuals.size() / std::ssize(scales);
    for (std::size_t output = 0; output < scales.size(); ++output) {
      const double rms =
          std::sqrt(fit_.solution.residuals.segment(static_cast<Index>(output) * rows, rows).squaredNorm() /
                    static_cast<double>(rows));
      scales[output] *= std::max(rms, 1e-9);
    }
    rollout_.set_scales(scales);
    LeastSquaresProblem problem = least_squares_;
    // By the new weights the start may be the better one of the two.
    problem.start = cost_at(least_squares_.start) < cost_at(fit_.solution.x) ? least_squares_.start : fit_.solution.x;
    const int iterations = fit_.solution.iterations;
    fit_.solution = solve(problem, solver_options(fit_.best_start));
    fit_.solution.iterations += iterations;
  }

  void score(const VectorXd& x, double OutputScore::*target) {
    const bool final_scores = target == &OutputScore::train;
    for (std::size_t output = 0; output < problem_.outputs.size(); ++output) {
      OutputScore& result = fit_.scores[output];
      const Port& port = problem_.program.graph.outputs[problem_.outputs[output]];
      result.output = port.name;
      result.unit = port.unit;
      result.range = range_in(&Experiment::train, output);
      result.test_range = range_in(&Experiment::test, output);
      RootMeanSquare train;
      RootMeanSquare test;
      for (std::size_t e = 0; e < problem_.experiments.size(); ++e) {
        const Experiment& experiment = problem_.experiments[e];
        const Signal model = final_scores ? fit_.model[e][output] : rollout_.outputs(x, e)[output];
        const auto add = [&](const std::vector<records::RowRange>& ranges, RootMeanSquare& error) {
          for (const records::RowRange& range : ranges) {
            for (std::size_t row = range.first; row < range.last; ++row) {
              error.add(model[row] - experiment.measured[output][row]);
            }
          }
        };
        add(experiment.train, train);
        add(experiment.test, test);
      }
      result.train_samples = train.count();
      result.test_samples = test.count();
      result.*target = train.value();
      result.test = test.value();
    }
  }

  const OutputErrorProblem& problem_;
  const OutputErrorOptions& options_;
  detail::Rollout rollout_;
  LeastSquaresProblem least_squares_{};
  OutputErrorFit fit_{};
};

}  // namespace

OutputErrorFit fit_output_error(const OutputErrorProblem& problem, const OutputErrorOptions& options) {
  return Fitter(problem, options).run();
}

namespace {

/// The value of a parameter; of one that each record has for itself, the mean of all of them.
double mean_over_records(const OutputErrorProblem& problem, const OutputErrorFit& fit, std::size_t parameter) {
  const FreeParameter& wanted = problem.parameters[parameter];
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t j = 0; j < problem.parameters.size(); ++j) {
    const FreeParameter& free = problem.parameters[j];
    if (free.parameter == wanted.parameter && free.element == wanted.element) {
      sum += fit.solution.x[static_cast<Index>(j)];
      count += 1.0;
    }
  }
  return sum / count;
}

}  // namespace

parameters::ParameterFile tuned_file(parameters::ParameterFile file, const OutputErrorProblem& problem,
                                     const OutputErrorFit& fit) {
  file = parameters::by_element(std::move(file), problem.program.graph);
  for (std::size_t j = 0; j < problem.parameters.size(); ++j) {
    const FreeParameter& free = problem.parameters[j];
    const Parameter& parameter = problem.program.graph.parameters[free.parameter];
    const double value = mean_over_records(problem, fit, j);
    auto found = std::ranges::find_if(file.values, [&](const parameters::ParameterValue& given) {
      return equal_ignoring_case(given.path, parameter.path);
    });
    if (found == file.values.end()) {
      file.values.push_back({.path = parameter.path, .value = parameter.value});
      found = file.values.end() - 1;
    }
    if (parameter.value.size() == 1) {
      found->value = value;
    } else {
      std::get<std::vector<double>>(found->value)[free.element] = value;
    }
  }
  for (std::size_t i = 0; problem.experiments.size() == 1 && i < problem.initial_states.size(); ++i) {
    file.set_initial(problem.initial_states[i].path, fit.solution.x[static_cast<Index>(problem.parameters.size() + i)]);
  }
  std::erase_if(file.comments, [](const parameters::Comment& comment) {
    return comment.where == parameters::Comment::Where::Head && comment.text.starts_with(fmt::format("# {}", tuned_by));
  });
  return file;
}

std::string tuned_heading(const OutputErrorProblem& problem, const OutputErrorFit& fit) {
  std::vector<std::string> files;
  for (const Experiment& experiment : problem.experiments) {
    files.push_back(experiment.name);
  }
  std::string text = fmt::format("{}{}.\n{}", tuned_by, fmt::join(files, ", "), fit.solution.message);
  for (std::size_t j = 0; files.size() > 1 && j < fit.names.size(); ++j) {
    if (j < problem.parameters.size() && !problem.parameters[j].record) {
      continue;  // the same in all records, and a value of the file
    }
    text += fmt::format("\n{}: {}", fit.names[j], number_text(fit.solution.x[static_cast<Index>(j)]));
  }
  return text;
}

parameters::Remarks tuned_remarks(const OutputErrorProblem& problem, const OutputErrorFit& fit) {
  parameters::Remarks remarks;
  for (std::size_t j = 0; j < problem.parameters.size(); ++j) {
    const FreeParameter& free = problem.parameters[j];
    const Parameter& parameter = problem.program.graph.parameters[free.parameter];
    parameters::Remark remark{.unit = free.unit, .meaning = std::string(parameter.field.meaning)};
    if (parameter.value.size() == 1 && !free.record &&
        std::isfinite(fit.covariance.standard_errors[static_cast<Index>(j)])) {
      remark.standard_error = fit.covariance.standard_errors[static_cast<Index>(j)];
    }
    remarks[in_capitals("parameters." + parameter.path)] = std::move(remark);
  }
  for (std::size_t i = 0; i < problem.initial_states.size(); ++i) {
    const FreeState& state = problem.initial_states[i];
    const double error = fit.covariance.standard_errors[static_cast<Index>(problem.parameters.size() + i)];
    remarks[in_capitals("initial." + state.path)] = {
        .unit = state.unit,
        .meaning = state.meaning,
        .standard_error = std::isfinite(error) ? std::optional(error) : std::nullopt};
  }
  return remarks;
}

}  // namespace hysteron
