// The text of a sequential body as a part of a label: its lines in their layout, as many as are read at a glance.
#pragma once

#include <string>

#include "codegen/language/body.hpp"

namespace hysteron::dot {

/// The statements of a unit as lines of a label, in a font of even width. Long lines are cut; of a long body the first
/// lines are shown, and how many more there are.
std::string body_text(const language::SourceFile& source, const language::body::Unit& unit);

}  // namespace hysteron::dot
