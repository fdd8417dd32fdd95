// The names by which a user asks for effects, and the families that they are of.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "codegen/compile.hpp"

namespace hysteron::diagnosis {

/// Throws InputError HY730 for an effect that neither the library nor the file of the diagram has.
void refuse_undiagnosable(const std::vector<std::string>& wanted, const Program& program);

/// The family of each effect of the library and of the diagram's file, by its identifier.
[[nodiscard]] std::map<std::string, std::string> families_by_effect(const Program& program);

}  // namespace hysteron::diagnosis
