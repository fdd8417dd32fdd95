#include "diagnosis/signals.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "codegen/interpreter/machine.hpp"

namespace hysteron::diagnosis {
namespace {

std::vector<double> percentiles(std::vector<double> values) {
  std::vector<double> result(101, 0.0);
  if (values.empty()) {
    return result;
  }
  std::ranges::sort(values);
  for (std::size_t k = 0; k <= 100; ++k) {
    result[k] = values[std::min(values.size() - 1, k * values.size() / 100)];
  }
  return result;
}

}  // namespace

Extent extent_of(const std::vector<std::vector<double>>& values, double sample_time) {
  Extent extent{.low = std::numeric_limits<double>::infinity(), .high = -std::numeric_limits<double>::infinity()};
  std::vector<double> levels;
  std::vector<double> rates;
  for (const std::vector<double>& record : values) {
    for (std::size_t k = 0; k < record.size(); ++k) {
      extent.low = std::min(extent.low, record[k]);
      extent.high = std::max(extent.high, record[k]);
      levels.push_back(record[k]);
      if (k > 0) {
        rates.push_back(std::abs(record[k] - record[k - 1]) / sample_time);
      }
    }
  }
  if (levels.empty()) {
    return {};
  }
  extent.levels = percentiles(std::move(levels));
  extent.rates = percentiles(std::move(rates));
  return extent;
}

std::vector<std::vector<double>> wire_values(const Task& task, const Program& program, const Wire& wire,
                                             const VectorXd& known) {
  Model model(task, program);
  const OutputErrorProblem& problem = model.problem();
  std::vector<std::vector<double>> result;
  for (const Experiment& experiment : problem.experiments) {
    Machine<double> machine(problem.program, experiment.drive.sample_time);
    for (std::size_t j = 0; j < task.known.size(); ++j) {
      machine.set_parameter(problem.parameters[j].parameter, known[static_cast<Index>(j)],
                            problem.parameters[j].element);
    }
    machine.reset();
    std::vector<double> values(experiment.drive.steps);
    for (std::size_t k = 0; k < experiment.drive.steps; ++k) {
      for (std::size_t i = 0; i < experiment.drive.inputs.size(); ++i) {
        machine.set_input(i, at_step(experiment.drive.inputs[i], k));
      }
      machine.step();
      values[k] = machine.value(wire);
    }
    result.push_back(std::move(values));
  }
  return result;
}

}  // namespace hysteron::diagnosis
