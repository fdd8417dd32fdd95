// Which input an output is drawn over: a hysteresis shows itself in that plane, and hides over time.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "codegen/graph/graph.hpp"
#include "diagnosis/diagnosis.hpp"
#include "diagnosis/model/task.hpp"

namespace hysteron::diagnosis {

/// The inputs that lead through a hysteresis or a play to an output, in the order of the diagram. What is one is known
/// from the families of a block's effects.
[[nodiscard]] std::vector<std::string> inputs_of_loop(const Graph& graph, std::string_view output);

/// All inputs that lead to an output.
[[nodiscard]] std::vector<std::string> inputs_of(const Graph& graph, std::string_view output);

/// Gives each trace the input to be drawn over: the first that moves in its record, of those that lead through a
/// hysteresis of `graph`. Where the evidence tells of a hysteresis or a play and the diagram has none, of all inputs.
void draw_over_inputs(const Task& task, const Graph& graph, const Evidence& evidence, std::vector<Trace>& traces);

}  // namespace hysteron::diagnosis
