// The parameters of a diagram that a file marks for tuning, with their bounds and starts.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "codegen/graph/graph.hpp"
#include "codegen/parameters/parameter_file.hpp"
#include "support/diagnostic.hpp"

namespace hysteron {

/// A parameter of the graph, or one element of it, that may change.
struct FreeParameter {
  std::size_t parameter = 0;  ///< by its place in the graph
  std::size_t element = 0;
  std::string name{};  ///< INV.C1; TABLE.Y[2] for an element; INV.C1 of record 2 where each record has its own
  std::optional<std::size_t> record{};  ///< the only record that it acts in; none: all
  std::string unit{};                   ///< as the wires give it; empty where they do not
  Place place{};                        ///< of its fit setting
  double start = 0.0;
  double lower = 0.0;  ///< −∞ where there is none
  double upper = 0.0;
  double typical = 1.0;  ///< size of a notable change
};

/// Those of the tables [fit], in the order of the file; one of [fit.record] once for each of so many records, where
/// there are two or more. The values of the file have been set in the graph; bounds come from [fit], else from the
/// block's description. `units` are those of the graph's parameters. Reports HY604 for a parameter that is no real
/// number, and HY606 for a start out of bounds.
[[nodiscard]] std::vector<FreeParameter> free_parameters(const Graph& graph, const parameters::ParameterFile& file,
                                                         std::size_t records, const std::vector<std::string>& units,
                                                         Diagnostics& diagnostics);

}  // namespace hysteron
