// What a FUNCTION_BLOCK declares, as text.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "codegen/backends/st/pou.hpp"

namespace hysteron {

/// The name of the type of arrays of a length. Where an array is handed to a block, some compilers want both to be of
/// one named type.
std::string st_array_type(std::uint16_t length);

/// The sections as text.
std::string st_declarations(const std::vector<StSection>& sections);

}  // namespace hysteron
