#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>

#include "codegen/compile.hpp"
#include "codegen/import/plcopen_import.hpp"
#include "support/atomic_file.hpp"
#include "support/errors.hpp"
#include "support/overwriting.hpp"
#include "support/text_file.hpp"
#include "tool/commands.hpp"

namespace hysteron::tool {
namespace {

constexpr std::string_view import_examples = R"(Examples:
  hysteron import project.xml --out project.st
  hysteron import plc.xml --pou LOOP --ts 10ms --out loop.st

Reads PLCopen TC6 XML, as CODESYS, TwinCAT, OpenPLC and Beremiz export it. Networks of function blocks (FBD) and ladders
of contacts and coils (LD) become diagrams; a body in ST keeps its text. TON is HY_TON, and so on. What is read before it
is worked out becomes a HY_DELAY. What a diagram cannot express is refused by its name and localId, and nothing is written.
Exit codes: 0 done; 1 written, and hysteron check finds errors in the text; 2 refused, or a file cannot be read or written.
)";

struct ImportCommand {
  std::string file;
  std::string out;
  bool force = false;
  ImportOptions options;
};

int import_project(const ImportCommand& command, Console& console) {
  Diagnostics warnings;
  refuse_to_overwrite({.file = command.out, .mend = "give another name for --out."}, {{.file = command.file}});
  const std::string text = import_plcopen(command.file, read_text_file(command.file), command.options, warnings);
  std::error_code unknown;
  if (!command.force && std::filesystem::exists(command.out, unknown) && read_text_file(command.out) != text) {
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
  app.add_option("FILE", command->file, "A project in PLCopen TC6 XML.")->required()->option_text(" ");
  app.add_option("--pou", command->options.pou, "This POU alone, with those that it calls.")->option_text("NAME");
  app.add_option("--ts", command->options.cycle, "The sample time; that of the task where none is given.")
      ->option_text("10ms");
  app.add_option("--out", command->out, "The diagrams, a file in Structured Text.")->required()->option_text("Y.st");
  app.add_flag("--force", command->force, "Overwrites a file that holds another text.");
  app.footer(std::string(import_examples));
  return [command](Console& console) { return import_project(*command, console); };
}

}  // namespace hysteron::tool
