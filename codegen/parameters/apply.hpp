// Setting the parameters of a diagram from a parameter file, with every value checked against its description.
#pragma once

#include <optional>
#include <string_view>

#include "codegen/graph/graph.hpp"
#include "codegen/parameters/parameter_file.hpp"
#include "support/diagnostic.hpp"

namespace hysteron::parameters {

/// Sets the values of a file in the parameters of a graph, and the values of its states after a reset. Names are
/// compared without regard to case. A list may be shorter than the array it fills; the rest is 0, as in the text of a
/// diagram. Reports, at their places in the file, HY603 for a name that the diagram does not have, HY604 for a value of
/// another type or length, HY214 for one outside of its range, or that cannot stand beside the
/// other parameters of its block.
void apply(const ParameterFile& as_written, Graph& graph, Diagnostics& diagnostics);

/// The same; throws InputError with everything that was reported.
void apply(const ParameterFile& file, Graph& graph);

/// The state of a path, as SUM.SUM, with no value yet. Reports HY603 where the diagram has none that is a real number.
std::optional<InitialState> find_state(const Graph& graph, std::string_view path, const Place& place,
                                       Diagnostics& diagnostics);

/// A number as the value that a field takes: TRUE of a BOOL is 1. One that the field cannot take stays a real number,
/// for the message.
[[nodiscard]] Value value_for(const Field& field, double number);

/// Why a parameter cannot take a number, as `must be above 0`; empty where it can.
[[nodiscard]] std::string range_fault(const Field& field, double value);

/// Reports HY603: the diagram has no parameter of that path. Says which are meant, or why one cannot be set.
void report_unknown_parameter(const Graph& graph, std::string_view path, const Place& place, Diagnostics& diagnostics);

}  // namespace hysteron::parameters
