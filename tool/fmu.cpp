#include "tool/fmu.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "codegen/backends/cpp/cpp.hpp"
#include "support/atomic_file.hpp"
#include "support/errors.hpp"
#include "support/temporary_folder.hpp"
#include "support/text_file.hpp"
#include "tool/compiler.hpp"
#include "tool/process.hpp"
#include "tool/zip_archive.hpp"

namespace hysteron::tool {
namespace {

namespace fs = std::filesystem;

#if defined(__linux__) && defined(__x86_64__)
constexpr bool machine_is_known = true;
#else
constexpr bool machine_is_known = false;
#endif

/// The binary's bytes. Nothing of the folder gets into them: no debug information, no names of local symbols.
std::string compile(const std::vector<std::string>& compiler, const FmuContents& contents) {
  const TemporaryFolder folder(fs::temp_directory_path());
  for (const GeneratedFile& file : contents.files) {
    write_file_atomically(folder.path() / file.name, file.text);
  }
  auto command = compiler;
  command.insert(command.end(), {"-std=c99", "-O2", "-fPIC", "-shared", "-fvisibility=hidden", "-s"});
  for (const std::string& flag : words_of(cpp_numeric_flags)) {
    command.push_back(flag);
  }
  for (const std::string& source : contents.sources) {
    command.push_back((folder.path() / source).string());
  }
  const auto binary = folder.path() / "binary";
  const auto errors = folder.path() / "errors";
  command.insert(command.end(), {"-o", binary.string(), "-lm"});
  if (const int code = run_program(command, {.errors = errors}); code != 0) {
    throw InputError(error::generated_code_fails, {},
                     fmt::format("The compiler {} refuses the sources of the FMU (exit code {}):{}", command.front(),
                                 code, first_lines(errors)),
                     "set CC to a compiler for C99.");
  }
  return read_text_file(binary.string());
}

}  // namespace

GeneratedFile pack_fmu(const Program& program, const FmuOptions& options, Diagnostics& warnings) {
  const FmuContents contents = generate_fmu(program, options);
  std::vector<ArchivedFile> files;
  for (const GeneratedFile& file : contents.files) {
    // The first stays readable in the archive: it tells that Hysteron made the file, which may then be overwritten.
    files.push_back({.name = file.name, .contents = file.text, .plain = files.empty()});
  }
  const auto compiler = find_compiler("CC", {"cc", "gcc", "clang"});
  if (compiler && machine_is_known) {
    files.push_back({.name = contents.binary, .contents = compile(*compiler, contents)});
  } else {
    warnings.warning(error::fmu_without_binary, program.graph.place(program.graph.sample_time_span),
                     machine_is_known ? "There is no C compiler, so the FMU has sources alone."
                                      : "This is no 64-bit Linux on x86, so the FMU has sources alone.",
                     "set CC to a C compiler (Debian: apt install gcc), or load the FMU where sources are compiled.");
  }
  return {.name = contents.model_identifier + ".fmu", .text = zip_archive(files)};
}

}  // namespace hysteron::tool
