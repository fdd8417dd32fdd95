// See output_error.hpp.
#include "tuning/output_error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "support/errors.hpp"
#include "support/names.hpp"
#include "support/numbers.hpp"
#include "support/root_mean_square.hpp"
#include "tuning/rollout.hpp"
#include "tuning/spread_start.hpp"

namespace hysteron {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

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
    hold_against_constant();
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
    problem.start = spread_start(start, least_squares_);
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

  /// A gradient that vanishes is no solution where a constant is as near to the record, or where the response runs
  /// away: far from any sensible point the cost is flat too.
  void hold_against_constant() {
    constexpr double runaway = 100.0;  // ranges of what was measured
    constexpr double notably = 1e-6;
    if (!fit_.solution.converged()) {
      return;
    }
    double left = 0.0;
    double of_constants = 0.0;
    bool is_bounded = true;
    for (std::size_t output = 0; output < problem_.outputs.size(); ++output) {
      const double scale = range_in(&Experiment::train, output);
      if (!(scale > 0.0)) {
        continue;  // a constant is all that was measured: no model is nearer
      }
      left += std::pow(fit_.scores[output].train / scale, 2);
      of_constants += std::pow(deviation_in_train(output) / scale, 2);
      for (std::size_t e = 0; e < problem_.experiments.size(); ++e) {
        const Signal& measured = problem_.experiments[e].measured[output];
        const auto [low, high] = std::ranges::minmax(measured);
        const double reach = runaway * std::max(high - low, scale);
        is_bounded = is_bounded && std::ranges::all_of(fit_.model[e][output], [&, &low = low, &high = high](double y) {
                       return low - reach < y && y < high + reach;
                     });
      }
    }
    if (!is_bounded) {
      fit_.solution.status = FitStatus::Unbounded;
    } else if (left > (1.0 + notably) * of_constants) {
      fit_.solution.status = FitStatus::WorseThanConstant;
    } else {
      return;
    }
    fit_.solution.message = std::string(plain_words(fit_.solution.status));
  }

  /// Of what was measured of an output in train, from its mean there: what the best constant would leave.
  [[nodiscard]] double deviation_in_train(std::size_t output) const {
    double sum = 0.0;
    double count = 0.0;
    const auto each = [&](const auto& take) {
      for (const Experiment& experiment : problem_.experiments) {
        for (const records::RowRange& range : experiment.train) {
          for (std::size_t row = range.first; row < range.last; ++row) {
            take(experiment.measured[output][row]);
          }
        }
      }
    };
    each([&](double value) {
      sum += value;
      count += 1.0;
    });
    RootMeanSquare deviation;
    each([&](double value) { deviation.add(value - sum / count); });
    return deviation.value();
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

}  // namespace hysteron
