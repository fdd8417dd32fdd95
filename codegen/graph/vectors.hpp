// Vectors: a text with vectors as the text with their elements, which everything behind it works on.
//
// `Y : ARRAY[0..2] OF LREAL` becomes the variables Y[0], Y[1] and Y[2]; an assignment, an argument and an operator
// become one for each element. SUM, DOT and NORM add from the left: ((x0 + x1) + x2) + …. Decision 25 says why.
#pragma once

#include <cstdint>
#include <memory>

#include "codegen/language/syntax.hpp"
#include "support/diagnostic.hpp"
#include "support/element_name.hpp"

namespace hysteron {

/// Every element is a variable of the step.
inline constexpr std::uint32_t longest_vector = 256;

/// The text with elements for vectors, and its spans as they were; the same where it has neither vectors nor blocks
/// whose pins are vectors. Reports HY220 to HY225; the text is then not to be used.
[[nodiscard]] std::shared_ptr<const language::SourceFile> expand_vectors(
    std::shared_ptr<const language::SourceFile> source, Diagnostics& diagnostics);

}  // namespace hysteron
