#include "tuning/fitted_program.hpp"

#include <iterator>
#include <vector>

#include "codegen/parameters/apply.hpp"

namespace hysteron {

Program fitted_program(const OutputErrorProblem& problem, const Eigen::VectorXd& x) {
  Program program = problem.program;
  for (std::size_t j = 0; j < problem.parameters.size(); ++j) {
    const FreeParameter& free = problem.parameters[j];
    if (free.record.value_or(0) == 0) {
      program.graph.parameters[free.parameter].value[free.element] = x[static_cast<Eigen::Index>(j)];
    }
  }
  for (std::size_t s = 0; s < problem.initial_states.size(); ++s) {
    Diagnostics diagnostics;
    auto state = parameters::find_state(program.graph, problem.initial_states[s].path, {}, diagnostics);
    if (state) {
      state->value = x[std::ssize(problem.parameters) + static_cast<Eigen::Index>(s)];
      std::erase_if(program.graph.initial_states,
                    [&](const InitialState& one) { return one.node == state->node && one.state == state->state; });
      program.graph.initial_states.push_back(*state);
    }
  }
  return program;
}

}  // namespace hysteron
