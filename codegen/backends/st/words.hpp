// Words that a name in generated Structured Text may not be: those of the standard, and those of the vendors.
#pragma once

#include <string>
#include <string_view>

#include "codegen/backends/st/dialect.hpp"

namespace hysteron {

/// Whether some compiler of Structured Text keeps a name for itself. Without regard to case.
bool is_st_word(std::string_view name);

/// The same for the compiler of TIA Portal, which has words of its own.
bool is_scl_word(std::string_view name);

/// What a pin of a block of the library is called: its own name, so that a diagram is taken as it is written. Blocks of
/// the standard have pins R, S and LD, which are words of instruction list; what an editor keeps for itself otherwise
/// gets a number in its dialect.
std::string st_pin_name(std::string_view name, const StDialect& dialect);

}  // namespace hysteron
