// How C99 spells the operations and types of a step, and the functions that it brings along.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "codegen/backends/c_family/printer.hpp"

namespace hysteron {

const DialectOfC& c_dialect(bool float32);

/// Names that a value may not have: keywords, functions of <math.h>, and those of the functions below.
std::span<const std::string_view> c_words();

/// The functions of <math.h> that a step calls, in the order of the alphabet.
std::vector<std::string> c_library_functions(const Routine& routine, bool float32);

/// The definitions of those functions that the operations need and C does not have.
std::string c_helper_functions(const Routine& routine, bool float32);

}  // namespace hysteron
