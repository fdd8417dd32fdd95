// The programs of the examples, run as a user runs them.
#pragma once

#include <cstdlib>
#include <string>

#include "tests/support/exit_code.hpp"

namespace hysteron::examples {

/// The folder that they are in.
inline const std::string programs = HYSTERON_EXAMPLE_PROGRAMS;

inline int run(const std::string& command) {
  return test::exit_code(std::system(command.c_str()));
}

}  // namespace hysteron::examples
