#include "tool/outside_program.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>

#include "support/atomic_file.hpp"
#include "support/errors.hpp"
#include "support/temporary_folder.hpp"
#include "support/text_file.hpp"
#include "tool/process.hpp"

namespace hysteron::tool {

namespace fs = std::filesystem;

std::string found(const OutsideProgram& program, const std::string& without) {
  const char* const named = std::getenv(program.variable.c_str());
  const bool is_named = named != nullptr && *named != '\0';
  if (const auto path = find_program(is_named ? named : program.name)) {
    return path->string();
  }
  throw InputError(program.missing, {},
                   is_named ? fmt::format("{} is \"{}\", which cannot be run.", program.variable, named)
                            : fmt::format("There is no program {} on the path.", program.name),
                   fmt::format("install the Debian package {}, or name another {} by {}; {} needs none.",
                               program.package, program.name, program.variable, without));
}

std::string converted(const OutsideProgram& program, const std::vector<std::string>& arguments, const std::string& text,
                      const std::string& without) {
  const std::string path = found(program, without);
  const TemporaryFolder folder(fs::temp_directory_path());
  const fs::path source = folder.path() / "source";
  const fs::path picture = folder.path() / "picture";
  const fs::path complaints = folder.path() / "complaints";
  write_file_atomically(source, text);
  std::vector<std::string> command{path};
  command.insert(command.end(), arguments.begin(), arguments.end());
  command.push_back(source.string());
  const int code = run_program(command, {.output = picture, .errors = complaints});
  std::error_code unknown;
  if (code != 0 || fs::file_size(picture, unknown) == 0 || unknown) {
    std::string said = fs::exists(complaints) ? read_text_file(complaints.string()) : "";
    said = said.substr(0, said.find('\n'));
    throw InputError(program.failed, {},
                     fmt::format("{} ended with {}{}{}.", path, code, said.empty() ? "" : ": ", said),
                     fmt::format("{}; {} needs none.", program.trial, without));
  }
  return read_text_file(picture.string());
}

}  // namespace hysteron::tool
