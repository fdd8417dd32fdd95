#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "codegen/compile.hpp"
#include "records/csv.hpp"
#include "support/atomic_file.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"
#include "support/shell_words.hpp"
#include "tool/commands.hpp"
#include "tool/templates.hpp"
#include "tuning/simulation.hpp"

namespace hysteron::tool {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view new_examples = R"(Examples:
  hysteron new stage --template piezo
  hysteron new axis --template servo

Makes a folder with a diagram, its parameters, a block test, a record of a simulated machine, and a README with the
three commands to begin with. The machine is a diagram too, machine.st; put a record of yours in the place of log.csv.
Templates: piezo (hysteresis), servo (inertia and friction), heater (dead time and lag), tank (outflow under a level),
pid (a controller tuned to a response that is wished for).
Exit codes: 0 made; 2 there is such a file or folder already, or no such template.
)";

/// Of the record; its length in time is that many samples of the machine.
constexpr std::size_t rows_of_log = 2000;
constexpr std::string_view machine_file = "machine.st";
constexpr std::string_view name_mark = "@NAME@";

struct NewOptions {
  std::string folder;
  std::string kind;
};

std::vector<std::string> template_names() {
  std::vector<std::string> names;
  for (const TemplateFile& file : template_files()) {
    if (names.empty() || names.back() != file.folder) {
      names.emplace_back(file.folder);
    }
  }
  return names;
}

/// The record of a diagram without inputs: its outputs over the time.
std::string log_of_machine(std::string_view text) {
  const Program program = compile_text(std::string(text));
  const Graph& graph = program.graph;
  Drive drive;
  drive.steps = rows_of_log;
  drive.sample_time = graph.sample_time();
  const auto outputs = interpret(program, drive, output_wires(graph));
  std::vector<double> time(rows_of_log);
  for (std::size_t k = 0; k < time.size(); ++k) {
    time[k] = static_cast<double>(graph.sample_time_ns * static_cast<std::int64_t>(k)) / 1e9;  // 0.41, not 0.41000…03
  }
  records::Record record(std::move(time), graph.sample_time(), {}, {});
  for (std::size_t i = 0; i < graph.outputs.size(); ++i) {
    record.add({.name = graph.outputs[i].name, .unit = graph.outputs[i].unit, .values = outputs[i]});
  }
  return records::csv_text(record);
}

std::string with_name(std::string text, const std::string& name) {
  for (auto at = text.find(name_mark); at != std::string::npos; at = text.find(name_mark, at + name.size())) {
    text.replace(at, name_mark.size(), name);
  }
  return text;
}

void refuse_existing(const fs::path& folder) {
  std::error_code unknown;
  if (fs::exists(fs::symlink_status(folder, unknown))) {
    throw InputError(error::bad_usage, {.file = folder.string()}, fmt::format("{} is there already.", folder.string()),
                     "give another name: nothing is written over.");
  }
  const fs::path parent = fs::absolute(folder).lexically_normal().parent_path();
  if (!fs::is_directory(parent, unknown)) {
    throw InputError(error::unwritable_file, {.file = folder.string()},
                     fmt::format("The folder {} is not there.", parent.string()),
                     "make it first, or give another name.");
  }
}

int make(const NewOptions& options, Console& console) {
  const std::vector<std::string> names = template_names();
  if (std::ranges::find(names, options.kind) == names.end()) {
    const auto near = nearest_name(options.kind, names);
    throw InputError(error::bad_usage, {}, fmt::format("There is no template {}.", options.kind),
                     near.empty() ? fmt::format("the templates are {}.", fmt::join(names, ", "))
                                  : fmt::format("did you mean {}?", near));
  }
  fs::path folder = fs::path(options.folder).lexically_normal();
  folder = folder.has_filename() ? folder : folder.parent_path();
  refuse_existing(folder);
  std::vector<OutputFile> files;
  for (const TemplateFile& file : template_files()) {
    if (file.folder != options.kind) {
      continue;
    }
    files.push_back(
        {.path = folder / file.name, .contents = with_name(std::string(file.text), folder.filename().string())});
    if (file.name == machine_file) {
      files.push_back({.path = folder / "log.csv", .contents = log_of_machine(file.text)});
    }
  }
  write_files_atomically(files);
  std::string text;
  for (const OutputFile& file : files) {
    text += file.path.string() + "\n";
  }
  console.print(fmt::format("{}Next: cd {} && cat README.md\n", text, shell_word(folder.string())));
  return exit_ok;
}

}  // namespace

Action add_new(CLI::App& app) {
  const auto options = std::make_shared<NewOptions>();
  app.add_option("NAME", options->folder, "The folder to be made.")->required()->option_text(" ");
  app.add_option("--template", options->kind, "What is in it.")
      ->required()
      ->option_text(fmt::format("{}", fmt::join(template_names(), "|")));
  app.footer(std::string(new_examples));
  return [options](Console& console) { return make(*options, console); };
}

}  // namespace hysteron::tool
