#include "tool/graphviz.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>

#include "support/atomic_file.hpp"
#include "support/diagnostic.hpp"
#include "support/errors.hpp"
#include "support/temporary_folder.hpp"
#include "support/text_file.hpp"
#include "tool/process.hpp"

namespace hysteron::tool {
namespace {

namespace fs = std::filesystem;

std::string graphviz(const std::string& without) {
  const char* const named = std::getenv("GRAPHVIZ_DOT");
  const std::string name = named != nullptr && *named != '\0' ? named : "dot";
  if (const auto found = find_program(name)) {
    return found->string();
  }
  throw InputError(
      error::no_graphviz, {},
      named != nullptr && *named != '\0'
          ? fmt::format("GRAPHVIZ_DOT is \"{}\", which cannot be run.", name)
          : std::string("There is no program dot on the path: Graphviz is not installed."),
      fmt::format("install the Debian package graphviz, or name another dot by GRAPHVIZ_DOT; {} needs none.", without));
}

}  // namespace

std::string drawn_by_graphviz(const std::string& text, const std::string& format, const std::string& without) {
  const std::string program = graphviz(without);
  const TemporaryFolder folder(fs::temp_directory_path());
  const fs::path source = folder.path() / "diagram.dot";
  const fs::path picture = folder.path() / "picture";
  const fs::path complaints = folder.path() / "complaints";
  write_file_atomically(source, text);
  const int code = run_program({program, "-T" + format, source.string()}, {.output = picture, .errors = complaints});
  std::error_code unknown;
  if (code != 0 || fs::file_size(picture, unknown) == 0 || unknown) {
    std::string said = fs::exists(complaints) ? read_text_file(complaints.string()) : "";
    said = said.substr(0, said.find('\n'));
    throw InputError(
        error::graphviz_failed, {}, fmt::format("{} ended with {}{}{}.", program, code, said.empty() ? "" : ": ", said),
        "see whether this dot draws anything: echo 'digraph {a}' | dot -Tsvg; " + without + " needs none.");
  }
  return read_text_file(picture.string());
}

}  // namespace hysteron::tool
