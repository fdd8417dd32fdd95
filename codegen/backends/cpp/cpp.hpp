// The C++ target: one header with a step of its own, a main that runs it over a record, and a CMakeLists for both.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "codegen/backends/shared/generated_file.hpp"
#include "codegen/compile.hpp"

namespace hysteron {

/// What generated code is to be compiled with, so that it has the interpreter's bits: no fused multiply-add, and no
/// exp, pow or atan of constants at compile time, where the compiler rounds better than the library.
inline constexpr std::string_view cpp_numeric_flags = "-ffp-contract=off -frounding-math";

struct CppOptions {
  bool float32 = false;  ///< real numbers of the target are float
};

/// The header (NAME.hpp), main.cpp and CMakeLists.txt of a program. The text depends on the program alone, to the byte.
/// Throws InputError (HY404) where the diagram states no sample time.
std::vector<GeneratedFile> generate_cpp(const Program& program, const CppOptions& options = {});

/// The header alone.
GeneratedFile generate_cpp_header(const Program& program, const CppOptions& options = {});

/// The members of the header's structures.
struct CppMembers {
  std::vector<std::string> parameters{};  ///< of Params, by parameter of the graph: inv.c1
  std::vector<std::string> cells{};       ///< of State, by cell of the program's routine: inv.p
};
CppMembers cpp_members(const Program& program);

}  // namespace hysteron
