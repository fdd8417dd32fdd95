// The parameter file that a tuning for a goal leaves. Declared in goal_search.hpp.
#include <fmt/format.h>

#include <string>
#include <utility>

#include "codegen/parameters/elements.hpp"
#include "support/names.hpp"
#include "support/numbers.hpp"
#include "tuning/goal/goal_search.hpp"
#include "tuning/tuned_file.hpp"

namespace hysteron {

parameters::ParameterFile tuned_file(parameters::ParameterFile file, const GoalProblem& problem,
                                     const GoalResult& result) {
  file = parameters::by_element(std::move(file), problem.graph());
  for (std::size_t j = 0; j < problem.parameters.size(); ++j) {
    const FreeParameter& free = problem.parameters[j];
    set_tuned(file, problem.graph().parameters[free.parameter], free.element, result.x[static_cast<Eigen::Index>(j)]);
  }
  erase_headings(file);
  return file;
}

std::string tuned_heading(const GoalProblem& problem, const GoalResult& result) {
  std::string text = fmt::format(
      "{}{} with {}.\n{}", tuned_for, problem.graph().outputs[problem.output].name,
      problem.plants.size() == 1 ? "one plant" : fmt::format("{} plants", problem.plants.size()), result.message);
  for (const LimitResult& limit : result.limits) {
    if (!limit.is_kept) {
      const GoalLimit& one = problem.limits[limit.limit];
      text += fmt::format("\nBROKEN: {} = {}, is {:.4g} with {}.", text_of(one.kind).key.name, number_text(one.limit),
                          limit.value, problem.plants[limit.plant].name);
    }
  }
  return text;
}

parameters::Remarks tuned_remarks(const GoalProblem& problem) {
  parameters::Remarks remarks;
  for (const FreeParameter& free : problem.parameters) {
    const Parameter& parameter = problem.graph().parameters[free.parameter];
    remarks[in_capitals("parameters." + parameter.path)] = {.unit = free.unit,
                                                            .meaning = std::string(parameter.field.meaning)};
  }
  return remarks;
}

}  // namespace hysteron
