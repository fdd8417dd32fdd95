#include "diagnosis/search/start_states.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <utility>

namespace hysteron::diagnosis {

std::vector<std::string> dynamic_states(const Graph& graph) {
  std::vector<std::string> result;
  for (const Node& node : graph.nodes) {
    if (node.block == nullptr ||
        (node.block->about.group != Group::Dynamics && node.block->about.group != Group::Control)) {
      continue;
    }
    for (const Field& field : node.block->states) {
      if (field.type == Type::Real && field.length == 1 && !field.unit.empty() && field.unit != "1") {
        result.push_back(fmt::format("{}.{}", node.path, field.name));
      }
    }
  }
  return result;
}

void free_too(Task& task, std::vector<std::string> states) {
  for (std::string& state : states) {
    if (std::ranges::none_of(task.initial_states,
                             [&](const std::string& given) { return language::same_name(given, state); })) {
      task.initial_states.push_back(std::move(state));
    }
  }
}

VectorXd trace_of(const MatrixXd& jacobian, Index first, Index states, Index state) {
  VectorXd trace = VectorXd::Zero(jacobian.rows());
  for (Index column = first + state; column < jacobian.cols(); column += states) {
    trace += jacobian.col(column);
  }
  return trace;
}

VectorXd start_from(const Model& model, const Explanation& from) {
  VectorXd start = model.start();
  const auto parameters = std::ssize(model.problem().parameters);
  start.head(parameters) = from.fit.x.head(parameters);
  return start;
}

}  // namespace hysteron::diagnosis
