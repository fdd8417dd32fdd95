// The parameter file that a fit leaves: values, heading, remarks. Declared in output_error.hpp and tuned_file.hpp.
#include "tuning/tuned_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "codegen/parameters/elements.hpp"
#include "support/names.hpp"
#include "support/numbers.hpp"
#include "tuning/output_error.hpp"

namespace hysteron {
namespace {

using Eigen::Index;

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

void set_tuned(parameters::ParameterFile& file, const Parameter& parameter, std::size_t element, double value) {
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
    std::get<std::vector<double>>(found->value)[element] = value;
  }
}

void erase_headings(parameters::ParameterFile& file) {
  std::erase_if(file.comments, [](const parameters::Comment& comment) {
    return comment.where == parameters::Comment::Where::Head &&
           (comment.text.starts_with(fmt::format("# {}", tuned_to)) ||
            comment.text.starts_with(fmt::format("# {}", tuned_for)));
  });
}

parameters::ParameterFile tuned_file(parameters::ParameterFile file, const OutputErrorProblem& problem,
                                     const OutputErrorFit& fit) {
  file = parameters::by_element(std::move(file), problem.program.graph);
  for (std::size_t j = 0; j < problem.parameters.size(); ++j) {
    const FreeParameter& free = problem.parameters[j];
    const Parameter& parameter = problem.program.graph.parameters[free.parameter];
    const double value = mean_over_records(problem, fit, j);
    set_tuned(file, parameter, free.element, value);
  }
  for (std::size_t i = 0; problem.experiments.size() == 1 && i < problem.initial_states.size(); ++i) {
    file.set_initial(problem.initial_states[i].path, fit.solution.x[static_cast<Index>(problem.parameters.size() + i)]);
  }
  erase_headings(file);
  return file;
}

std::string tuned_heading(const OutputErrorProblem& problem, const OutputErrorFit& fit) {
  std::vector<std::string> files;
  for (const Experiment& experiment : problem.experiments) {
    files.push_back(experiment.name);
  }
  std::string text = fmt::format("{}{}.\n{}", tuned_to, fmt::join(files, ", "), fit.solution.message);
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
