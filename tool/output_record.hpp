// Computed signals as CSV.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "codegen/graph/graph.hpp"
#include "tuning/simulation.hpp"

namespace hysteron::tool {

/// Columns of a diagram's signals over a time. Numbers are written as the shortest text that reads back to the same
/// bits; of 32-bit floats, to the same bits of a float.
[[nodiscard]] std::string output_csv(const Graph& graph, std::span<const double> time,
                                     const std::vector<std::string>& names, const std::vector<Signal>& columns,
                                     bool float32);

}  // namespace hysteron::tool
