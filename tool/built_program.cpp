#include "tool/built_program.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <optional>

#include "codegen/backends/cpp/cpp.hpp"
#include "support/errors.hpp"
#include "support/sha256.hpp"
#include "support/temporary_folder.hpp"
#include "support/text_file.hpp"
#include "tool/compiler.hpp"
#include "tool/process.hpp"
#include "tool/row_program.hpp"

namespace hysteron::tool {
namespace {

namespace fs = std::filesystem;

std::optional<std::vector<std::string>> compiler_found() {
  return find_compiler("CXX", {"c++", "g++", "clang++"});
}

std::string version_of(const std::vector<std::string>& compiler, const fs::path& folder) {
  auto command = compiler;
  command.emplace_back("--version");
  const auto output = folder / "version";
  return run_program(command, {.output = output}) == 0 ? read_text_file(output.string()) : std::string();
}

void compile_sources(const ProgramSources& sources, std::vector<std::string> command, const fs::path& executable) {
  const auto folder = executable.parent_path();
  for (const GeneratedFile& header : sources.headers) {
    write_scratch(folder / header.name, header.text);
  }
  write_scratch(folder / "main.cpp", sources.main);
  command.insert(command.end(), sources.flags.begin(), sources.flags.end());
  for (const std::string& flag : words_of(cpp_numeric_flags)) {
    command.push_back(flag);
  }
  command.insert(command.end(), {(folder / "main.cpp").string(), "-o", executable.string()});
  command.insert(command.end(), sources.libraries.begin(), sources.libraries.end());
  command.emplace_back("-lm");
  const auto errors = folder / "errors";
  if (const int code = run_program(command, {.errors = errors}); code != 0) {
    throw InputError(error::generated_code_fails, {},
                     fmt::format("The compiler {} refuses the generated code (exit code {}):{}", command.front(), code,
                                 first_lines(errors)),
                     fmt::format("set CXX to a compiler for C++20, or {}.", sources.without));
  }
}

}  // namespace

bool has_compiler() {
  return compiler_found().has_value();
}

std::vector<std::string> compiler_command(std::string_view without) {
  if (auto command = compiler_found()) {
    return *command;
  }
  if (const char* const set = std::getenv("CXX"); set != nullptr && *set != '\0') {
    throw InputError(error::no_compiler, {}, fmt::format("CXX is \"{}\", which cannot be run.", set),
                     "set CXX to a C++ compiler, or unset it.");
  }
  throw InputError(error::no_compiler, {}, "There is no C++ compiler (c++, g++ or clang++) on the path.",
                   fmt::format("install one (Debian: apt install g++), set CXX, or {}.", without));
}

fs::path built_program(BuildCache& cache, const ProgramSources& sources) {
  const auto compiler = compiler_command(sources.without);
  std::string everything = sources.main;
  for (const GeneratedFile& header : sources.headers) {
    everything += header.text;
  }
  for (const auto* const words : {&compiler, &sources.flags, &sources.libraries}) {
    for (const std::string& word : *words) {
      everything += word + " ";
    }
  }
  everything += cpp_numeric_flags;
  {
    const TemporaryFolder folder(cache.folder());
    everything += version_of(compiler, folder.path());
  }
  return cache.find_or_build(sha256(everything),
                             [&](const fs::path& path) { compile_sources(sources, compiler, path); });
}

}  // namespace hysteron::tool
