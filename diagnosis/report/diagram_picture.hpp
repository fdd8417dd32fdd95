// The diagram as a picture: blocks as boxes, the gap as colour and width of the wires, effects and their edges marked.
#pragma once

#include <string>

#include "diagnosis/diagnosis.hpp"

namespace hysteron::diagnosis::report {

/// SVG to stand in a page, styled by its classes; empty where the diagram has nothing to draw or too many boxes to be
/// read.
[[nodiscard]] std::string diagram_picture(const Diagnosis& diagnosis, const Graph& graph);

}  // namespace hysteron::diagnosis::report
