// The comments of a parameter file, which the TOML library passes over.
#pragma once

#include <string_view>
#include <vector>

#include "codegen/parameters/parameter_file.hpp"

namespace hysteron::parameters {

/// The comments of a text that is TOML, in the order of the text.
[[nodiscard]] std::vector<Comment> comments_of(std::string_view text);

}  // namespace hysteron::parameters
