#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "codegen/compile.hpp"
#include "codegen/language/syntax.hpp"
#include "support/atomic_file.hpp"
#include "support/text_file.hpp"
#include "tool/commands.hpp"

namespace hysteron::tool {
namespace {

constexpr std::string_view fmt_examples = R"(Examples:
  hysteron fmt plant.st                     format in place
  hysteron fmt --check src/*.st             for a build server: lists what would change
  hysteron fmt --stdout /dev/stdin < a.st   for an editor
  hysteron fmt --any-order drawn.st         sorts the statements by the data flow

Comments are kept; formatting twice changes nothing. A file with a sequential body is left as it is, with its diagrams,
and a note says so. A file with syntax errors is left as it is, and so is one that reads a value on the wrong side of its
assignment or call (HY402, HY405): to move it would change what an IEC compiler makes of the text. --any-order says that
the order means nothing, as in what a drawing tool wrote.
Exit codes: 0 done; 1 with --check, files would change; 2 a file cannot be read, understood or written.
)";

struct FmtOptions {
  std::vector<std::string> files;
  bool check = false;
  bool to_stdout = false;
  bool any_order = false;
};

/// A body has a layout of its own, and comes back as it stands: with the file around it.
void tell_of_bodies(const std::string& path, const std::string& text) {
  Diagnostics ignored;
  const language::SourceFile file = language::parse(path, text, ignored);
  const auto body = std::ranges::find_if(file.blocks, &language::FunctionBlock::sequential);
  if (file.bodies && body != file.blocks.end()) {
    const auto diagrams = std::ranges::count_if(file.blocks, [](const auto& one) { return !one.sequential; });
    Console::note(path, fmt::format("{} has a sequential body, so the file is left as it stands{}", body->name.text,
                                    diagrams == 0 ? "" : "; in a file of their own its diagrams are formatted"));
  }
}

int format_files(const FmtOptions& options, Console& console) {
  Diagnostics refused;
  bool would_change = false;
  for (const std::string& path : options.files) {
    try {
      const auto text = read_text_file(path);
      Diagnostics own;
      console.sources().put(path, text);
      const auto formatted = format_text(path, text, own, {.any_order = options.any_order});
      if (own.has_errors()) {
        throw InputError(own);
      }
      if (!own.all().empty()) {
        console.report(own);
      }
      tell_of_bodies(path, text);
      if (options.check) {
        if (formatted != text) {
          would_change = true;
          console.print(path + " would change\n");
        }
      } else if (options.to_stdout) {
        console.print(formatted);
      } else if (formatted != text) {
        write_file_atomically(path, formatted);
        console.print(path + " formatted\n");
      }
    } catch (const InputError& error) {
      refused.add_all(error.diagnostics());
    }
  }
  if (refused.has_errors()) {
    throw InputError(refused);
  }
  return would_change ? exit_findings : exit_ok;
}

}  // namespace

Action add_fmt(CLI::App& app) {
  const auto options = std::make_shared<FmtOptions>();
  app.add_option("FILE", options->files, "Diagrams, files in Structured Text.")->required()->option_text(" ");
  auto* const check = app.add_flag("--check", options->check, "Changes nothing; lists the files that would change.");
  app.add_flag("--stdout", options->to_stdout, "Prints the formatted text instead of writing it.")->excludes(check);
  app.add_flag("--any-order", options->any_order, "The order of the statements means nothing: sorts them.");
  app.footer(std::string(fmt_examples));
  return [options](Console& console) { return format_files(*options, console); };
}

}  // namespace hysteron::tool
