// Words that a name in generated Structured Text may not be: those of the standard, and those of the vendors.
#pragma once

#include <string_view>

namespace hysteron {

/// Whether some compiler of Structured Text keeps a name for itself. Without regard to case.
bool is_st_word(std::string_view name);

/// The same for the compiler of TIA Portal, which has words of its own.
bool is_scl_word(std::string_view name);

}  // namespace hysteron
