// hysteron serve: runs a diagram as a cyclic task.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string_view>
#include <utility>

#include "runtime/host/host.hpp"
#include "support/text_file.hpp"
#include "tool/commands.hpp"
#include "tool/diagram.hpp"
#include "tool/serve_program.hpp"

namespace hysteron::tool {
namespace {

constexpr std::string_view examples = R"(Examples:
  hysteron serve feedforward.st --params tuned.toml --config RUN.toml
  hysteron serve feedforward.st --config RUN.toml --virtual --cycles 100000

RUN.toml says how outputs become safe, and what watches, keeps, records and serves the task. On the virtual clock time
passes as fast as the steps do, with the same bits. SIGTERM and Ctrl-C bring the outputs to their safe values and end it.
Exit codes: 0 it ran and ended as asked; 1 a fault ended it or was there at its end; 2 an error in the diagram, the
parameters, the run file, or what the run file names.
)";

struct Options {
  DiagramOptions diagram;
  std::string config;
  std::string engine;
  std::uint64_t cycles = 0;
  bool virtual_time = false;
};

int serve(const Options& options, Console& console) {
  Diagnostics warnings;
  const Program diagram = load_diagram(options.diagram, warnings);
  const Engine engine = engine_of(options.engine);
  const auto program = step_program(diagram, engine, options.diagram.float32);
  auto config = runtime::parse_run_config(options.config, read_text_file(options.config), program->shape());
  console.report(warnings);
  const bool well = runtime::run_host(*program, std::move(config),
                                      {.how = engine == Engine::compiled ? "compiled" : "interpreted",
                                       .cycles = options.cycles,
                                       .virtual_time = options.virtual_time},
                                      [&](std::string_view text) {
                                        console.print(text);
                                        (void)std::fflush(stdout);
                                      });
  return well ? exit_ok : exit_findings;
}

}  // namespace

Engine engine_of(const std::string& name) {
  return name.empty() ? best_engine() : name == "compiled" ? Engine::compiled : Engine::interpreter;
}

Action add_serve(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  add_diagram_options(app, options->diagram);
  app.add_option("--config", options->config, "The run file.")->required()->option_text("RUN.toml");
  app.add_option("--engine", options->engine, "interpreter, or compiled: the default where there is a compiler.")
      ->check(CLI::IsMember({"interpreter", "compiled"}))
      ->option_text("NAME");
  app.add_option("--cycles", options->cycles, "Ends after so many cycles.")->option_text("N");
  app.add_flag("--virtual", options->virtual_time, "Runs as fast as it can, on a clock of its own.");
  app.footer(std::string(examples));
  return [options](Console& console) { return serve(*options, console); };
}

}  // namespace hysteron::tool
