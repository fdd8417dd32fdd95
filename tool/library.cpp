#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "codegen/backends/st/st.hpp"
#include "codegen/language/annotation.hpp"
#include "support/atomic_file.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"
#include "tool/commands.hpp"
#include "tool/writable.hpp"

namespace hysteron::tool {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view library_examples = R"(Examples:
  hysteron library --target st --ts 1ms --out plc
  hysteron library --target st --ts 50us --dialect codesys --out plc

Each block of the library as a FUNCTION_BLOCK in Structured Text, so that a PLC's editor takes a diagram as it is written.
--ts is the cycle of the task. A block that runs less often gets its own: SLOW : HY_LAG := (TS := 0.004).
The dialects: portable and siemens-scl (one file), codesys and twincat (a file for each block).
A diagram with just the blocks that it uses: hysteron generate FILE.st --target st --structured.
Exit codes: 0 done; 2 bad usage, or a folder that cannot be written.
)";

struct LibraryOptions {
  std::string target;
  std::string dialect = "portable";
  std::string sample_time;
  std::string folder;
  bool float32 = false;
};

[[noreturn]] void refuse(std::string cause, std::string mend) {
  throw InputError(error::bad_usage, {}, std::move(cause), std::move(mend));
}

int write_library(const LibraryOptions& options, Console& console) {
  if (!equal_ignoring_case(options.target, "st")) {
    refuse(fmt::format("The library is not written in {}.", options.target), "write --target st.");
  }
  const auto dialect = st_dialect(options.dialect);
  if (!dialect) {
    refuse(fmt::format("There is no dialect {}.", options.dialect),
           fmt::format("the dialects are: {}.", st_dialect_names()));
  }
  std::int64_t nanoseconds = 0;
  if (!language::duration_of(options.sample_time, nanoseconds)) {
    refuse(fmt::format("{} is no sample time.", options.sample_time),
           "write a whole number of nanoseconds above 0 in ns, us, ms or s, as in --ts 50us.");
  }
  std::vector<OutputFile> files;
  for (const GeneratedFile& file :
       generate_st_library(nanoseconds, {.dialect = *dialect, .float32 = options.float32})) {
    files.push_back({.path = fs::path(options.folder) / file.name, .contents = file.text});
    refuse_foreign_file(files.back().path, file.text, "choose another folder with --out.");
  }
  write_files_atomically(files);
  for (const OutputFile& file : files) {
    console.print(file.path.string() + "\n");
  }
  return exit_ok;
}

}  // namespace

Action add_library(CLI::App& app) {
  const auto options = std::make_shared<LibraryOptions>();
  app.add_option("--target", options->target, "The language: st (Structured Text).")->required()->option_text("st");
  app.add_option("--ts", options->sample_time, "The sample time: the cycle of the task.")
      ->required()
      ->option_text("TIME");
  app.add_option("--dialect", options->dialect, "Of Structured Text; portable where none is given.")
      ->option_text("DIALECT");
  app.add_option("--out", options->folder, "The folder for the files; it is made where there is none.")
      ->required()
      ->option_text("DIR");
  app.add_flag("--float32", options->float32, "REAL in place of LREAL.");
  app.footer(std::string(library_examples));
  return [options](Console& console) { return write_library(*options, console); };
}

}  // namespace hysteron::tool
