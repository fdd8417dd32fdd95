#include "runtime/host/host_program.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <cstdio>
#include <exception>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include "runtime/config/run_config.hpp"
#include "runtime/host/notices.hpp"
#include "runtime/host/served_map.hpp"
#include "runtime/modbus/map_text.hpp"
#include "support/errors.hpp"
#include "support/failed_writes.hpp"
#include "support/render.hpp"
#include "support/text_file.hpp"
#include "support/whole_number.hpp"

namespace hysteron::runtime {
namespace {

constexpr std::string_view help = R"({title} as a cyclic task.
  {name} RUN.toml                runs it until SIGTERM, which brings its outputs to their safe values
  {name} RUN.toml --virtual      as fast as it can, on a clock of its own
  {name} RUN.toml --cycles N     ends after so many cycles
  {name} RUN.toml --map          prints its registers as CSV
Exit codes: 0 it ran and ended as asked; 1 a fault ended it or was there at its end; 2 an error in the command line, the
run file, or what the run file names.
)";

struct CommandLine {
  std::string run_file{};
  std::uint64_t cycles = 0;
  bool virtual_time = false;
  bool map = false;
  bool help = false;
};

InputError bad_usage(const std::string& cause, const std::string& name) {
  return {error::bad_usage, {}, cause, fmt::format("`{} --help` shows how it is run.", name)};
}

std::uint64_t parse_cycles(std::string_view text, const std::string& name) {
  const auto cycles = whole_number<std::uint64_t>(text, 1);
  if (!cycles) {
    throw bad_usage(fmt::format("--cycles needs a whole number from 1 on, and has \"{}\".", text), name);
  }
  return *cycles;
}

CommandLine parse(std::span<const char* const> words, const std::string& name) {
  CommandLine line;
  for (std::size_t i = 1; i < words.size(); ++i) {
    const std::string_view word = words[i];
    if (word == "--help" || word == "-h") {
      line.help = true;
    } else if (word == "--virtual") {
      line.virtual_time = true;
    } else if (word == "--map") {
      line.map = true;
    } else if (word == "--cycles") {
      ++i;
      line.cycles = parse_cycles(i < words.size() ? words[i] : "", name);
    } else if (word.starts_with('-') || !line.run_file.empty()) {
      throw bad_usage(fmt::format("{} does not take {}.", name, word), name);
    } else {
      line.run_file = word;
    }
  }
  if (line.run_file.empty() && !line.help) {
    throw bad_usage("No run file is given.", name);
  }
  return line;
}

void print(std::string_view text) {
  (void)std::fwrite(text.data(), 1, text.size(), stdout);
  (void)std::fflush(stdout);
}

/// To the standard error, with the lines that they speak of.
void say(const Diagnostics& diagnostics) {
  Sources sources;
  const std::string text = as_text(diagnostics, sources, {.colour = wants_colour(stderr)});
  (void)std::fputs(weighted(text, diagnostics.has_errors() ? Weight::error : Weight::warning).c_str(), stderr);
}

int run(StepProgram& program, const HostProgram& host, std::span<const char* const> words) {
  const CommandLine line = parse(words, host.name);
  if (line.help) {
    print(fmt::format(fmt::runtime(help), fmt::arg("title", program.shape().name), fmt::arg("name", host.name)));
    return 0;
  }
  RunConfig config = parse_run_config(line.run_file, read_text_file(line.run_file), program.shape());
  refuse_to_overwrite_inputs(config, {{.file = line.run_file}});
  if (config.modbus) {
    config.modbus->first_addresses = host.addresses;
  }
  if (line.map) {
    const modbus::RegisterMap map = register_map_of(config, program);
    say(config.warnings);
    say(map.warnings());
    print(modbus::as_csv(map));
    return 0;
  }
  say(config.warnings);
  if (config.web && !host.page) {
    tell("Run file", "[web] has no effect here: this host has no live page. Generate it anew with listen under [web].");
  }
  auto page = host.page ? host.page(config, program.shape()) : nullptr;
  const bool well = run_host(
      program, std::move(config),
      {.how = "generated", .cycles = line.cycles, .virtual_time = line.virtual_time, .beside = std::move(page)}, print);
  return well ? 0 : 1;
}

}  // namespace

int host_program(StepProgram& program, const HostProgram& host, int argc, const char* const* argv) {
  let_writes_fail();  // whoever reads what it prints may go: the task stays
  try {
    return run(program, host, {argv, static_cast<std::size_t>(argc)});
  } catch (const InputError& refused) {
    say(refused.diagnostics());
  } catch (const std::exception& fault) {
    (void)std::fputs(weighted(fmt::format("{}: {}\n", host.name, fault.what()), Weight::error).c_str(), stderr);
  }
  return 2;
}

}  // namespace hysteron::runtime
