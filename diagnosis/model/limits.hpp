// The limits of the next experiment, as a user writes them.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "codegen/compile.hpp"

namespace hysteron::diagnosis {

/// U=5.0 the largest size of the input U, and its ends and fastest change, U.low, U.high, U.rate: by name, as
/// DiagnosisOptions takes them. Throws InputError HY730.
[[nodiscard]] std::vector<std::pair<std::string, double>> read_limits(const Graph& graph,
                                                                      const std::vector<std::string>& texts);

}  // namespace hysteron::diagnosis
