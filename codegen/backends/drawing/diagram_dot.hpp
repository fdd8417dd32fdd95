// A diagram as a picture: the text that Graphviz draws it from.
//
// Boxes are what the text declares, with their pins and units; a FUNCTION_BLOCK of the text is a frame round what is
// inside it, with its inputs at the left and its outputs at the right. The same text gives the same bytes.
#pragma once

#include <cstddef>
#include <string>

#include "codegen/compile.hpp"

namespace hysteron {

struct DiagramDot {
  std::string text{};
  std::size_t boxes = 0;  ///< how many Graphviz has to find places for
};

/// Of a compiled program with its text.
DiagramDot diagram_dot(const Program& program);

}  // namespace hysteron
