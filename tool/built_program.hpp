// Generated C++ compiled by the system's compiler, and kept.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "codegen/backends/shared/generated_file.hpp"
#include "tool/build_cache.hpp"

namespace hysteron::tool {

struct ProgramSources {
  std::string main{};
  std::vector<GeneratedFile> headers{};
  std::vector<std::string> flags{};      ///< of the compiler, without those that a step's bits need
  std::vector<std::string> libraries{};  ///< besides -lm
  std::string without = "leave generated code out with --no-generated";  ///< how the user does without a compiler
};

/// The compiler's command: $CXX, else the first of c++, g++, clang++ on the path. Throws InputError HY725.
[[nodiscard]] std::vector<std::string> compiler_command(std::string_view without = ProgramSources{}.without);

/// Whether there is one.
[[nodiscard]] bool has_compiler();

/// The executable, or the library where a flag says -shared, which is kept by the hash of its sources, of the
/// compiler's version and of the flags, and not compiled again. Throws InputError: HY725 without a compiler, HY726
/// where the compiler refuses.
[[nodiscard]] std::filesystem::path built_program(BuildCache& cache, const ProgramSources& sources);

}  // namespace hysteron::tool
