// The names by which a user asks for effects.
#pragma once

#include <string>
#include <vector>

#include "codegen/compile.hpp"

namespace hysteron::diagnosis {

/// Throws InputError HY730 for an effect that neither the library nor the file of the diagram has.
void refuse_unknown_effects(const std::vector<std::string>& wanted, const Program& program);

}  // namespace hysteron::diagnosis
