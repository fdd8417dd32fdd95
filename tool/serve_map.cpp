// hysteron map: the registers under which a served diagram shows itself.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "runtime/host/host.hpp"
#include "runtime/host/served_map.hpp"
#include "runtime/modbus/map_text.hpp"
#include "support/text_file.hpp"
#include "tool/commands.hpp"
#include "tool/diagram.hpp"
#include "tool/serve_program.hpp"

namespace hysteron::tool {
namespace {

constexpr std::string_view serve_map_examples = R"(Examples:
  hysteron map feedforward.st
  hysteron map feedforward.st --format csv
  hysteron map feedforward.st --format cpp --config RUN.toml

Without a run file the map is that of a task without devices: every input is a register that clients write. With one,
its limits, devices, word order and lock file count, as in `hysteron serve`.
Exit codes: 0 done; 2 an error in the diagram, the run file or the lock file.
)";

struct ServeMapOptions {
  DiagramOptions diagram;
  std::string format = "markdown";
  std::string config;
};

runtime::RunConfig run_config_or_default(const std::string& file, const runtime::ProgramShape& shape) {
  if (!file.empty()) {
    return runtime::parse_run_config(file, read_text_file(file), shape);
  }
  runtime::RunConfig config;
  config.task.inputs.resize(shape.inputs.size());
  config.task.outputs.resize(shape.outputs.size());
  return config;
}

}  // namespace

Action add_map(CLI::App& app) {
  const auto options = std::make_shared<ServeMapOptions>();
  add_diagram_options(app, options->diagram);
  app.add_option("--format", options->format, "markdown, csv, json or cpp.")
      ->check(CLI::IsMember({"markdown", "csv", "json", "cpp"}))
      ->option_text("NAME");
  app.add_option("--config", options->config, "The run file.")->option_text("RUN.toml");
  app.footer(std::string(serve_map_examples));
  return [options](Console& console) {
    Diagnostics warnings;
    const Program diagram = load_diagram(options->diagram, warnings);
    const auto program = step_program(diagram, Engine::interpreter, options->diagram.float32);
    const runtime::RunConfig config = run_config_or_default(options->config, program->shape());
    std::vector<InputFile> inputs = inputs_of(options->diagram);
    inputs.push_back({.file = options->config, .named_by = "--config"});
    runtime::refuse_to_overwrite_inputs(config, std::move(inputs));
    const auto map = runtime::register_map_of(config, *program);
    for (const Diagnostics* const more : {&config.warnings, &map.warnings()}) {
      std::ranges::for_each(more->all(), [&](const Diagnostic& one) { warnings.add(one); });
    }
    console.report(warnings);
    console.print(options->format == "csv"    ? runtime::modbus::as_csv(map)
                  : options->format == "json" ? runtime::modbus::as_json(map)
                  : options->format == "cpp"  ? runtime::modbus::as_cpp(map)
                                              : runtime::modbus::as_markdown(map));
    return exit_ok;
  };
}

}  // namespace hysteron::tool
