// The diagram as a picture for the live page: blocks as boxes, with a place for the value of each signal.
#pragma once

#include <string>
#include <vector>

#include "codegen/compile.hpp"
#include "tool/inner_signals.hpp"

namespace hysteron::tool {

/// SVG without styles of its own. The text of a value carries data-point, the name of an input or output, or
/// data-inner, its place in `inner`. Empty where there is nothing to draw, or too much to be read.
[[nodiscard]] std::string live_diagram(const Graph& graph, const std::vector<InnerSignal>& inner);

}  // namespace hysteron::tool
