// A parameter file by the elements of a diagram's vectors: `K = [1.0, 2.0]` is K[0] and K[1], and so is a fit of K.
#pragma once

#include "codegen/graph/graph.hpp"
#include "codegen/parameters/parameter_file.hpp"
#include "support/diagnostic.hpp"

namespace hysteron::parameters {

/// The file with the name of a whole vector replaced by its elements, under [parameters], under [fit] and in `outputs`
/// of [tune]; what names no vector stays as it is. A file that names elements alone is returned unchanged. Reports
/// HY604 for a list of another length, or a single value for a vector, and HY602 for an element that is given twice;
/// neither is in the result.
[[nodiscard]] ParameterFile by_element(ParameterFile file, const Graph& graph, Diagnostics& diagnostics);

/// The same; throws InputError with everything that was reported.
[[nodiscard]] ParameterFile by_element(ParameterFile file, const Graph& graph);

}  // namespace hysteron::parameters
