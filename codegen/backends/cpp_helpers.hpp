// The functions that generated C++ brings along: those of the vocabulary that <cmath> does not have.
#pragma once

#include <string>

namespace hysteron {

/// The definitions of those that a body of text calls, in a namespace of their own; empty where it calls none.
std::string cpp_helper_functions(const std::string& body);

}  // namespace hysteron
