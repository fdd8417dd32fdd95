// How the unknowns of a rollout come into a machine, whatever its scalar. Internal to the sources of Rollout.
#pragma once

#include "tuning/rollout.hpp"

namespace hysteron::detail {

inline bool acts_in(const FreeParameter& free, std::size_t experiment) {
  return !free.record || *free.record == experiment;
}

template <class S, class Of>
void Rollout::load_states(Machine<S>& machine, std::size_t experiment, std::size_t start, const Of& of) const {
  for (std::size_t state = 0; state < problem_.initial_states.size(); ++state) {
    *machine.real_state(problem_.initial_states[state].path) =
        of(state_column(experiment, start, state), state_column(experiment, 0, state));
  }
}

template <class S, class Of>
bool Rollout::restarts(Machine<S>& machine, std::size_t experiment, std::size_t step, std::size_t& start,
                       const Of& of) const {
  const std::vector<std::size_t>& steps = problem_.experiments[experiment].restarts;
  if (start == steps.size() || step != steps[start]) {
    return false;
  }
  load_states(machine, experiment, ++start, of);
  return true;
}

template <class S, class Of>
void Rollout::set_parameters(Machine<S>& machine, std::size_t experiment, const Of& of) const {
  for (std::size_t j = 0; j < problem_.parameters.size(); ++j) {
    const FreeParameter& free = problem_.parameters[j];
    const auto column = static_cast<Eigen::Index>(j);
    if (acts_in(free, experiment)) {
      machine.set_parameter(free.parameter, of(column, column), free.element);
    }
  }
}

template <class S, class Of>
void Rollout::prepare(Machine<S>& machine, std::size_t experiment, const Of& of) const {
  set_parameters(machine, experiment, of);
  machine.reset();
  load_states(machine, experiment, 0, of);
}

}  // namespace hysteron::detail
