// The states of a diagram's dynamic blocks as unknowns of a fit: which there are, how they are freed, what each does.
#pragma once

#include <string>
#include <vector>

#include "diagnosis/search/fitting.hpp"

namespace hysteron::diagnosis {

/// Real states of blocks that follow their input in time, or control, by path; those without a unit count steps.
[[nodiscard]] std::vector<std::string> dynamic_states(const Graph& graph);

/// States that the task frees at the start, beside those that it does already.
void free_too(Task& task, std::vector<std::string> states);

/// The trace of a state over all records, each from its own start; `first` is the column of the first of the states.
[[nodiscard]] VectorXd trace_of(const MatrixXd& jacobian, Index first, Index states, Index state);

/// Where a fit begins whose states are others than those of the fit that is given: at its parameters.
[[nodiscard]] VectorXd start_from(const Model& model, const Explanation& from);

}  // namespace hysteron::diagnosis
