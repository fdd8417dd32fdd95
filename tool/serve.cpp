// hysteron serve: runs a diagram as a cyclic task.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <chrono>
#include <csignal>
#include <memory>
#include <optional>
#include <system_error>
#include <thread>

#include "runtime/config/device_field.hpp"
#include "runtime/config/run_config.hpp"
#include "support/errors.hpp"
#include "support/text_file.hpp"
#include "tool/commands.hpp"
#include "tool/diagram.hpp"
#include "tool/serve_modbus.hpp"
#include "tool/serve_program.hpp"

namespace hysteron::tool {
namespace {

using namespace runtime;  // NOLINT(google-build-using-namespace): this file is about nothing else

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

std::atomic<bool> stop_asked{false};
static_assert(std::atomic<bool>::is_always_lock_free, "it is set by a signal handler");

void ask_to_stop(int /*signal*/) {
  stop_asked.store(true, std::memory_order_relaxed);
}

std::string status_line(const Task& task, const std::string& how) {
  const LoopStatistics& s = task.statistics();
  const auto events = [&](Cause cause) { return s.events[static_cast<std::size_t>(cause)]; };
  return fmt::format(
      "{}; {} cycles, {} skipped; late: {} woken, {} own CPU, {} pre-empted, {} steal; start p99.99 {:.1f} us, worst "
      "{:.1f} us in cycle {}; fault: {}\n",
      how, s.run, s.skipped, events(Cause::late_wake), events(Cause::own_cpu), events(Cause::preempted),
      events(Cause::host_steal), static_cast<double>(s.lateness.percentile(0.9999)) * 1e-3,
      static_cast<double>(s.lateness.worst()) * 1e-3, s.lateness.worst_cycle(), name_of(task.fault()));
}

/// What the run file asks to keep: read before the program starts.
Recovery recover_into(RetainFiles& files, const RetainConfig& retain, StepProgram& program) {
  Recovery recovery = recover(files, program.shape().layout, retain.mismatch);
  if (!recovery.refused.empty()) {
    throw InputError(error::retained_values_unfit, retain.place, recovery.refused,
                     "run the diagram that they are of, name another folder, or write mismatch = \"cold\", which puts "
                     "the files aside.");
  }
  if (recovery.values) {
    for (std::size_t i = 0; i < recovery.values->parameters.size(); ++i) {
      program.set_parameter(i, recovery.values->parameters[i]);
    }
    program.restore(recovery.values->state);
  }
  return recovery;
}

std::unique_ptr<Trace> open_trace(const TraceSettings& settings, const Place& place, const StepProgram& program) {
  try {
    return std::make_unique<Trace>(settings, program);
  } catch (const std::system_error& problem) {
    throw InputError(error::trace_not_writable, place, fmt::format("The trace cannot be written: {}.", problem.what()),
                     "name a file in a folder that is there and may be written to.");
  }
}

int serve(const Options& options, Console& console) {
  Diagnostics warnings;
  const Program diagram = load_diagram(options.diagram, warnings);
  const Engine engine = engine_of(options.engine);
  const auto program = step_program(diagram, engine, options.diagram.float32);
  RunConfig config = parse_run_config(options.config, read_text_file(options.config), program->shape());
  console.report(warnings);
  config.task.loop.cycles = options.cycles;
  if (config.trace) {
    config.trace->waits = options.virtual_time;
  }

  const std::int64_t period = program->shape().period;
  std::string how =
      fmt::format("{}: {}", program->shape().name, engine == Engine::compiled ? "compiled" : "interpreted");
  std::optional<RetainFolder> folder;
  Recovery recovery;
  if (config.retain) {
    folder.emplace(config.retain->folder);
    recovery = recover_into(*folder, *config.retain, *program);
    how += recovery.values ? fmt::format(", from retained state {}", recovery.sequence) : "";
    how += recovery.note.empty() ? "" : ", " + recovery.note;
  }
  // The guard is forked before there is any thread.
  const bool has_devices = !config.devices.empty();
  DeviceOutputs device_outputs(config);
  std::unique_ptr<Guard> guard;
  if (config.guard && has_devices && !options.virtual_time) {
    guard = std::make_unique<Guard>(
        GuardSettings{.watchdog = config.task.watchdog, .period = period, .silence = config.silence},
        SafeOutputs(config.task.outputs, static_cast<double>(period) * 1e-9), device_outputs);
  }
  const auto trace = config.trace ? open_trace(*config.trace, config.trace_place, *program) : nullptr;
  std::unique_ptr<Retainer> retainer;
  if (folder) {
    retainer = std::make_unique<Retainer>(*folder, *program, recovery);
  }
  std::unique_ptr<DeviceField> field;
  if (has_devices) {
    field = std::make_unique<DeviceField>(config, period, options.virtual_time);
  }
  Task task(*program, config.task,
            {.field = field.get(), .guard = guard.get(), .retainer = retainer.get(), .trace = trace.get()});
  const auto server = config.modbus ? serve_modbus(*config.modbus, program->shape().name, task.door(),
                                                   [&](bool lost) { task.client_lost(lost); })
                                    : nullptr;
  how += server ? fmt::format("; Modbus on {}:{}", config.modbus->listen, server->port()) : "";

  stop_asked.store(false);
  (void)std::signal(SIGTERM, ask_to_stop);
  (void)std::signal(SIGINT, ask_to_stop);
  LoopEnd end = LoopEnd::stopped;
  std::string obtained;
  std::atomic<bool> started{false};
  std::thread cyclic([&] {
    default_floating_point();
    touch_stack();
    if (options.virtual_time) {
      VirtualClock clock;
      obtained = "virtual clock";
      started.store(true);
      end = task.run(clock, stop_asked);
    } else {
      MonotonicClock clock;
      SchedulingRequest request = config.scheduling;
      request.period = period;
      request.runtime = period / 2;
      const auto got = obtain_scheduling(request);
      obtained = description_of(got) + (got.refused.empty() ? "" : " (refused: " + got.refused + ")");
      started.store(true);
      end = task.run(clock, stop_asked);
    }
  });
  while (!started.load()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  how += "; " + obtained;
  console.print(how + "\n");
  (void)std::fflush(stdout);
  cyclic.join();
  console.print(status_line(task, program->shape().name + ": " + std::string(name_of(end))));
  const bool well = (end == LoopEnd::stopped || end == LoopEnd::done) && task.fault() == Fault::stop;
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
