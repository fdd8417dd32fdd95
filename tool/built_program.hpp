// Generated C++ compiled by the system's compiler, and kept.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "codegen/backends/shared/generated_file.hpp"
#include "tool/build_cache.hpp"

namespace hysteron::tool {

/// The compiler's command: $CXX, else the first of c++, g++, clang++ on the path. Throws InputError HY725.
[[nodiscard]] std::vector<std::string> compiler_command();

struct ProgramSources {
  std::string main{};
  std::vector<GeneratedFile> headers{};
  std::vector<std::string> flags{};      ///< of the compiler, without those that a step's bits need
  std::vector<std::string> libraries{};  ///< -lm is among them
};

/// The executable, which is kept by the hash of its sources, of the compiler's version and of the flags, and not
/// compiled again. Throws InputError: HY725 without a compiler, HY726 where the compiler refuses.
[[nodiscard]] std::filesystem::path built_program(BuildCache& cache, const ProgramSources& sources);

}  // namespace hysteron::tool
