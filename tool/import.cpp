#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "codegen/compile.hpp"
#include "codegen/import/global_list.hpp"
#include "codegen/import/plcopen_import.hpp"
#include "codegen/import/twincat_import.hpp"
#include "codegen/language/annotation.hpp"
#include "support/atomic_file.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"
#include "support/overwriting.hpp"
#include "support/text_file.hpp"
#include "tool/commands.hpp"

namespace hysteron::tool {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view import_examples = R"(Examples:
  hysteron import project.xml --out project.st
  hysteron import plc.xml --pou LOOP --ts 10ms --out loop.st
  hysteron import POUs/FB_Axis.TcPOU --ts 1ms --out axis.st

Reads PLCopen TC6 XML, as CODESYS, TwinCAT, OpenPLC and Beremiz export it. Networks of function blocks (FBD) and ladders
of contacts and coils (LD) become diagrams; a body in ST keeps its text. TON is HY_TON, and so on. What is read before it
is worked out becomes a HY_DELAY. What a diagram cannot express is refused by its name and localId, and nothing is written.
A .TcPOU of TwinCAT with a body in ST comes with the blocks, functions, types and global variables that it names, from
the folder of its .plcproj, or from its own folder where there is none.
Exit codes: 0 done; 1 written, and hysteron check finds errors in the text; 2 refused, or a file cannot be read or written.
)";

struct ImportCommand {
  std::string file;
  std::string out;
  bool force = false;
  ImportOptions options;
};

/// Files of objects below a folder, by the name of the object in capitals; lists of global variables by those of the
/// variables, too.
std::map<std::string, fs::path> objects_below(const fs::path& folder) {
  std::map<std::string, fs::path> objects;
  std::vector<fs::path> lists;
  std::error_code unreadable;
  for (fs::recursive_directory_iterator at(folder, fs::directory_options::skip_permission_denied, unreadable), end;
       !unreadable && at != end; at.increment(unreadable)) {
    const std::string ending = in_capitals(at->path().extension().string());
    if (ending == ".TCPOU" || ending == ".TCDUT" || ending == ".TCGVL") {
      objects.emplace(in_capitals(at->path().stem().string()), at->path());
      if (ending == ".TCGVL") {
        lists.push_back(at->path());
      }
    }
  }
  std::ranges::sort(lists);
  for (const fs::path& path : lists) {
    const auto list = global_list_of(read_text_file(path.string()));
    for (const GlobalVariable& variable :
         list && !list->qualified_only ? list->variables : std::vector<GlobalVariable>{}) {
      for (const std::string& name : variable.names) {
        objects.emplace(name, path);
      }
    }
  }
  return objects;
}

/// The folder of the project that a file belongs to: the nearest one above it with a .plcproj; its own where there is
/// none.
fs::path folder_of_project(const fs::path& file) {
  fs::path own = fs::absolute(file).parent_path();
  for (fs::path folder = own; folder != folder.root_path(); folder = folder.parent_path()) {
    std::error_code unreadable;
    for (const auto& one : fs::directory_iterator(folder, unreadable)) {
      if (equal_ignoring_case(one.path().extension().string(), ".plcproj")) {
        return folder;
      }
    }
  }
  return own;
}

std::string text_of(const ImportCommand& command, Diagnostics& warnings) {
  const std::string text = read_text_file(command.file);
  if (!is_twincat_object(text)) {
    return import_plcopen(command.file, text, command.options, warnings);
  }
  const std::map<std::string, fs::path> objects = objects_below(folder_of_project(command.file));
  const auto find = [&](std::string_view name) -> std::optional<ProjectFile> {
    const auto found = objects.find(in_capitals(name));
    return found == objects.end() ? std::nullopt
                                  : std::optional(ProjectFile{.path = found->second.string(),
                                                              .text = read_text_file(found->second.string())});
  };
  return import_twincat({.path = command.file, .text = text}, find, command.options);
}

int import_project(const ImportCommand& command, Console& console) {
  if (const std::string& cycle = command.options.cycle; !cycle.empty()) {
    if (std::int64_t nanoseconds = 0; !language::duration_of(cycle, nanoseconds)) {
      throw InputError(error::bad_usage, {}, fmt::format("{} is no sample time.", cycle),
                       "write a whole number of nanoseconds above 0 in ns, us, ms or s, as in --ts 10ms.");
    }
  }
  Diagnostics warnings;
  refuse_to_overwrite({.file = command.out, .mend = "give another name for --out."}, {{.file = command.file}});
  const std::string text = text_of(command, warnings);
  std::error_code unknown;
  if (!command.force && fs::exists(command.out, unknown) && read_text_file(command.out) != text) {
    throw InputError(error::foreign_file, {.file = command.out},
                     fmt::format("{} is there already, with another text.", command.out),
                     "choose another name for --out, or overwrite the file with --force.");
  }
  write_file_atomically(command.out, text);
  console.report(warnings);
  console.print(command.out + "\n");
  Diagnostics found;
  console.sources().put(command.out, text);
  auto parsed = language::parse(command.out, text, found);
  if (!found.has_errors()) {
    check(std::make_shared<const language::SourceFile>(std::move(parsed)), found);
  }
  console.report(found);
  return found.has_errors() ? exit_findings : exit_ok;
}

}  // namespace

Action add_import(CLI::App& app) {
  const auto command = std::make_shared<ImportCommand>();
  app.add_option("FILE", command->file, "A project in PLCopen TC6 XML, or a .TcPOU.")->required()->option_text(" ");
  app.add_option("--pou", command->options.pou, "This POU alone, with those that it calls.")->option_text("NAME");
  app.add_option("--ts", command->options.cycle, "The sample time; that of the task where none is given.")
      ->option_text("10ms");
  app.add_option("--out", command->out, "The diagrams, a file in Structured Text.")->required()->option_text("Y.st");
  app.add_flag("--force", command->force, "Overwrites a file that holds another text.");
  app.footer(std::string(import_examples));
  return [command](Console& console) { return import_project(*command, console); };
}

}  // namespace hysteron::tool
