// hysteron serve: runs a diagram as a cyclic task.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "runtime/host/host.hpp"
#include "runtime/host/notices.hpp"
#include "runtime/task/changeable_program.hpp"
#include "runtime/web/serve_page.hpp"
#include "support/text_file.hpp"
#include "tool/change_channel.hpp"
#include "tool/commands.hpp"
#include "tool/diagram.hpp"
#include "tool/inner_signals.hpp"
#include "tool/live_diagram.hpp"
#include "tool/option_values.hpp"
#include "tool/program_shape.hpp"
#include "tool/serve_program.hpp"
#include "tool/served_versions.hpp"

namespace hysteron::tool {
namespace {

constexpr std::string_view serve_examples = R"(Examples:
  hysteron serve feedforward.st --params tuned.toml --config RUN.toml
  hysteron serve feedforward.st --config RUN.toml --virtual --cycles 100000
  hysteron serve feedforward.st --config RUN.toml --web 127.0.0.1:8080

RUN.toml says how outputs become safe, and what watches, keeps, records and serves the task. On the virtual clock time
passes as fast as the steps do, with the same bits. The live page shows trends, the diagram with its values, parameters
and cycles in a browser; it changes parameters only for who has the token of a file that its owner alone may read.
SIGTERM and Ctrl-C bring the outputs to their safe values and end it.
Exit codes: 0 it ran and ended as asked; 1 a fault ended it or was there at its end; 2 an error in the diagram, the
parameters, the run file, or what the run file names.
)";

struct ServeOptions {
  DiagramOptions diagram;
  std::string config;
  std::string engine;
  std::uint64_t cycles = 0;
  bool virtual_time = false;
  runtime::web::PageOptions page;
};

/// The compiled program needs room for temporary files, and a compiler that works. Where nobody asked for it by name, a
/// task that cannot have it is interpreted.
std::unique_ptr<runtime::StepProgram> program_by(Engine& engine, const ServeOptions& options, const Program& diagram,
                                                 const std::vector<InnerSignal>& inner, const std::string& picture) {
  try {
    return step_program(diagram, engine, options.diagram.float32, inner, picture);
  } catch (const InputError& refused) {
    if (engine == Engine::interpreter || !options.engine.empty()) {
      throw;
    }
    const Diagnostic& why = refused.diagnostics().all().front();
    runtime::tell("Engine", fmt::format("this run is interpreted, with the same bits in a longer step. It cannot be "
                                        "compiled: HY{}: {} Mend: {}",
                                        why.number, why.cause, why.mend));
  }
  engine = Engine::interpreter;
  return step_program(diagram, engine, options.diagram.float32, inner, picture);
}

int serve(const ServeOptions& options, Console& console) {
  Diagnostics warnings;
  LoadedVersion version = first_version(options.diagram, warnings);
  const Program& diagram = version.diagram;
  Engine engine = engine_of(options.engine);
  const std::string run_text = read_text_file(options.config);
  auto config = runtime::parse_run_config(options.config, run_text, shape_of(diagram, engine, options.diagram.float32));
  const auto web = runtime::web::page_server_options(config, options.page);
  if (config.web && !web) {
    runtime::tell("Run file", "[web] has no effect here: the live page is started by listen there, or by --web.");
  }
  const auto inner = web ? inner_signals(diagram) : std::vector<InnerSignal>();
  const std::string picture = web ? live_diagram(diagram.graph, inner) : "";
  auto program = program_by(engine, options, diagram, inner, picture);
  std::vector<InputFile> inputs = inputs_of(options.diagram);
  inputs.push_back({.file = options.config, .named_by = "--config"});
  inputs.push_back({.file = options.page.token_file, .named_by = "--web-token-file"});
  inputs.push_back({.file = options.page.read_token_file, .named_by = "--web-read-token-file"});
  runtime::refuse_to_overwrite_inputs(config, inputs);
  warnings.add_all(config.warnings);
  console.report(warnings);
  const auto page = web ? runtime::web::page_beside(*web, config, program->shape()) : runtime::BesideTask();
  std::unique_ptr<runtime::ChangeableProgram> changeable;
  if (config.online_change) {
    changeable = std::make_unique<runtime::ChangeableProgram>(std::move(program));
  }
  runtime::StepProgram& running = changeable ? *changeable : *program;
  ServedVersions versions(options.diagram, engine, web.has_value(),
                          {.run_file = options.config, .text = run_text, .inputs = std::move(inputs)}, version);
  const auto take_changes = [&, where = config.online_change](runtime::OnlineChange& change,
                                                              std::string& said) -> std::shared_ptr<void> {
    said += fmt::format("; online change on {}", where->socket);
    return std::make_shared<ChangeListener>(
        where->socket, where->place,
        [&](const std::string& request, const ChangeListener::Progress& progress) {
          return versions.answer(change, request, progress);
        },
        [&](bool now) { change.cannot_be_asked_for(now); });
  };
  const bool well = runtime::run_host(running, std::move(config),
                                      {.how = engine == Engine::compiled ? "compiled" : "interpreted",
                                       .cycles = options.cycles,
                                       .virtual_time = options.virtual_time,
                                       .beside = page,
                                       .changeable = changeable.get(),
                                       .take_changes = take_changes},
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
  const auto options = std::make_shared<ServeOptions>();
  add_diagram_options(app, options->diagram);
  app.add_option("--config", options->config, "The run file.")->required()->option_text("RUN.toml");
  app.add_option("--engine", options->engine, "interpreter, or compiled: the default where there is a compiler.")
      ->check(CLI::IsMember({"interpreter", "compiled"}))
      ->option_text("NAME");
  app.add_option("--cycles", options->cycles, "Ends after so many cycles.")
      ->check(whole_number_from(1))
      ->option_text("N");
  app.add_flag("--virtual", options->virtual_time, "Runs as fast as it can, on a clock of its own.");
  app.add_option("--web", options->page.listen, "Serves the live page there: 127.0.0.1:8080.")
      ->option_text("ADDRESS:PORT");
  app.add_option("--web-token-file", options->page.token_file, "Who has its token may change parameters on the page.")
      ->option_text("FILE");
  app.add_option("--web-read-token-file", options->page.read_token_file,
                 "Who has its token may read beyond the loopback, as a scraper, and change nothing.")
      ->option_text("FILE");
  app.footer(std::string(serve_examples));
  return [options](Console& console) { return serve(*options, console); };
}

}  // namespace hysteron::tool
