// Units: what a unit text means, and whether the units along all wires of a graph agree.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "codegen/graph/graph.hpp"
#include "codegen/graph/schedule.hpp"

namespace hysteron::units {

/// Whether a text is a unit (SI symbols and prefixes, products, quotients, powers; `1` for none). Says why not.
bool is_unit(std::string_view text, std::string& reason);

/// The factor from one unit to another (`um` to `m`: 1e-6); false where their dimensions differ or one is unknown.
bool conversion(std::string_view from, std::string_view to, double& factor);

/// Checks the units of all wires. Blocks are polymorphic in unit variables ('x): each instance takes the units that
/// are wired. A port without a unit is not checked. Reports HY301 where two units cannot agree.
void check(const Graph& graph, const Schedule& schedule, Diagnostics& diagnostics);

/// The unit of each parameter of a graph, as the wires give it: C1 of a slope between um and V is um/V. Empty where the
/// diagram does not say enough.
std::vector<std::string> of_parameters(const Graph& graph, const Schedule& schedule);

/// The same for the outputs of all nodes, by node and output. Empty for operations.
std::vector<std::vector<std::string>> of_outputs(const Graph& graph, const Schedule& schedule);

/// The same for the states of all nodes, by node and state. Empty for operations.
std::vector<std::vector<std::string>> of_states(const Graph& graph, const Schedule& schedule);

}  // namespace hysteron::units
