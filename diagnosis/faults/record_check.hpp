// Whether a record can be diagnosed at all: refused with a reason rather than given a confident name.
#pragma once

#include <string>
#include <vector>

#include "diagnosis/model/model.hpp"

namespace hysteron::diagnosis {

struct RecordCheck {
  std::vector<std::string> refusals{};  ///< why no diagnosis is given
  std::vector<std::string> warnings{};  ///< what weakens it
  bool one_motion = false;              ///< the inputs make one motion only, and repeat it; a warning says so
  std::vector<Index> left_out{};        ///< rows that a sensor that is stuck or drops out has spoilt
};

/// Inputs and measured outputs whose values no sensor gives, each with its first such sample. To be asked before the
/// model is run: such a sample leaves no digit to all that is summed with it.
[[nodiscard]] std::vector<std::string> absurd_samples(const Task& task, const Graph& graph);

/// `nominal`: residuals of the diagram with its parameters as given, in standard deviations of the floor.
[[nodiscard]] RecordCheck check_records(const Task& task, const Model& model, const VectorXd& nominal);

}  // namespace hysteron::diagnosis
