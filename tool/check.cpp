#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "codegen/compile.hpp"
#include "support/errors.hpp"
#include "support/progress.hpp"
#include "tool/commands.hpp"

namespace hysteron::tool {
namespace {

constexpr std::string_view check_examples = R"(Examples:
  hysteron check plant.st
  hysteron check --json src/*.st

Each diagnostic has its cause, its mend and a number; docs/errors has a page for each number.
Exit codes: 0 no errors (there may be warnings); 1 errors; 2 a file cannot be read.
)";

struct CheckOptions {
  std::vector<std::string> files;
  bool json = false;
};

/// All diagnostics of one file; whether it could be read at all.
bool check_file(const std::string& path, Diagnostics& found) {
  Diagnostics own;
  auto parsed = language::parse_file(path, own);
  const bool valid = parsed.valid && !own.has_errors();
  const auto source = std::make_shared<const language::SourceFile>(std::move(parsed));
  if (valid) {
    check(source, own);
  }
  bool readable = true;
  for (const Diagnostic& one : own.all()) {
    found.add(one);
    readable = readable && one.number != error::unreadable_file;
  }
  return readable;
}

int check_files(const CheckOptions& options, Console& console) {
  Diagnostics found;
  bool readable = true;
  Progress progress("Checking");
  for (std::size_t i = 0; i < options.files.size(); ++i) {
    progress.update(static_cast<double>(i) / static_cast<double>(options.files.size()), options.files[i]);
    readable = check_file(options.files[i], found) && readable;
  }
  progress.finish();
  if (options.json) {
    console.print(as_json(found).dump(2) + "\n");
  } else if (!found.all().empty()) {
    console.print(found);
  } else {
    console.print(options.files.size() == 1 ? fmt::format("{}: no errors\n", options.files.front())
                                            : fmt::format("{} files: no errors\n", options.files.size()));
  }
  if (!readable) {
    return exit_bad_input;
  }
  return found.has_errors() ? exit_findings : exit_ok;
}

}  // namespace

Action add_check(CLI::App& app) {
  const auto options = std::make_shared<CheckOptions>();
  app.add_option("FILE", options->files, "Diagrams, files in Structured Text.")->required()->option_text(" ");
  app.add_flag("--json", options->json, "Prints the diagnostics as a list of JSON objects.");
  app.footer(std::string(check_examples));
  return [options](Console& console) { return check_files(*options, console); };
}

}  // namespace hysteron::tool
