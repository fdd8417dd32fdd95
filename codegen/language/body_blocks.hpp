// Which blocks of a text are sequential, before any of it is parsed.
//
// What makes a block sequential is what a diagram cannot say at all: a statement of control, a variable that is
// temporary or belongs to the caller, a type or a literal that diagrams do not have, a call of a FUNCTION of the file,
// a name of its VAR_GLOBAL CONSTANT, or the mark (* @body *). Nothing else does: two assignments to one variable, or a
// read before the assignment, stay errors of a diagram, whose mend names the mark
// (docs/decisions/0018-sequential-bodies.md).
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace hysteron::language {

/// A TYPE, a FUNCTION, a VAR_GLOBAL or a FUNCTION_BLOCK of a text, by its offsets.
struct TextPart {
  enum class Kind : std::uint8_t { Types, Function, Globals, Block };
  Kind kind = Kind::Block;
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
  bool sequential = false;  ///< of a block
};

/// The parts in the order of the text; empty where no block is sequential.
std::vector<TextPart> parts_with_bodies(std::string_view text);

}  // namespace hysteron::language
