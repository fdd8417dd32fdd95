// The FMUs of a diagram, and the files that its text names for them.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "codegen/graph/graph.hpp"

namespace hysteron {

[[nodiscard]] bool has_fmu(const Graph& graph);

/// A text with each `@file` of an HY_FMU replaced by what `moved` makes of it.
[[nodiscard]] std::string with_fmu_files(const language::SourceFile& source,
                                         const std::function<std::string(std::string_view file)>& moved);

}  // namespace hysteron
