// hysteron doctor: whether this machine can run a cyclic task in time, and what to change.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "runtime/config/run_config.hpp"
#include "runtime/config/run_keys.hpp"
#include "support/errors.hpp"
#include "support/numbers.hpp"
#include "support/wrapped.hpp"
#include "tool/commands.hpp"
#include "tool/jitter.hpp"
#include "tool/option_values.hpp"
#include "tool/processor_list.hpp"
#include "tool/realtime_host.hpp"

namespace hysteron::tool {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view doctor_examples = R"(Examples:
  hysteron doctor --rt
  hysteron doctor --rt --processor 3 --seconds 60
  hysteron doctor --rt --json > machine.json

--rt looks at what makes a task late: kernel, preemption, power saving, interrupts, rights; then it runs an empty task for
10 s and shows how late it woke. What can be better comes with the command for it. Nothing is changed, and no right is
needed; with less rights than the task will have, the measurement is worse than the task's own.
Exit codes: 0 nothing is bad; 1 something is; 2 bad usage.
)";

struct DoctorOptions {
  bool rt = false;
  double seconds = 10.0;
  std::string period = "1ms";
  std::optional<unsigned> processor{};
  int priority = 80;
  std::string root = "/";
  bool json = false;
};

std::int64_t period_of(const std::string& text) {
  constexpr std::int64_t shortest = 10'000;
  constexpr std::int64_t longest = 1'000'000'000;
  const auto period = runtime::parse_duration(text);
  if (!period || *period < shortest || *period > longest) {
    throw InputError(error::bad_usage, {}, fmt::format("--period does not understand \"{}\".", text),
                     "write a time from 10us to 1s: --period 1ms.");
  }
  return *period;
}

/// Refuses a folder that is no machine's, and a processor that the machine has not.
void check_machine(const DoctorOptions& options) {
  const std::filesystem::path root = options.root;
  std::error_code none;
  if (!std::filesystem::is_directory(root / "proc", none) && !std::filesystem::is_directory(root / "sys", none)) {
    throw InputError(error::bad_usage, {},
                     fmt::format("--root {}: there is neither a folder proc nor a folder sys in it.", options.root),
                     "name the folder into which /proc and /sys of the other machine were copied.");
  }
  const std::vector<unsigned> processors = processors_of(root);
  if (options.processor && !processors.empty() &&
      std::ranges::find(processors, *options.processor) == processors.end()) {
    throw InputError(error::bad_usage, {},
                     fmt::format("--processor {}: the processors of this machine are {}.", *options.processor,
                                 processors_text(processors)),
                     fmt::format("name one of these: --processor {}.", processors.back()));
  }
}

/// In three columns of the width of a terminal, 0 for none; where the third would be narrow, below the others. The
/// console breaks what has a line to itself, and leaves rows of three columns as they are.
std::string findings_text(const std::vector<HostFinding>& findings, std::size_t width) {
  constexpr std::size_t least_third = 30;
  std::size_t widest = 0;
  for (const HostFinding& one : findings) {
    widest = std::max(widest, one.name.size());
  }
  const bool is_below = width != 0 && width < 14 + widest + least_third;
  const std::string margin(is_below ? 4 : 14 + widest, ' ');
  std::string text;
  for (const HostFinding& one : findings) {
    text += is_below ? fmt::format("{:<10}  {}\n{}{}\n", name_of(one.rating), one.name, margin, one.found)
                     : fmt::format("{:<10}  {:<{}}  {}\n", name_of(one.rating), one.name, widest,
                                   wrapped(margin + one.found, width).substr(margin.size()));
    text += one.why.empty() ? "" : fmt::format("{}{}\n", margin, one.why);
    for (std::size_t begin = 0; begin < one.command.size();) {
      const std::size_t end = std::min(one.command.find('\n', begin), one.command.size());
      text += fmt::format("{}$ {}\n", margin, one.command.substr(begin, end - begin));
      begin = end + 1;
    }
  }
  return text;
}

std::string jitter_text(const JitterRequest& request, const Jitter& jitter, std::size_t width) {
  const auto time = [](std::int64_t value) { return runtime::short_time_text(static_cast<double>(value)); };
  std::string text = fmt::format(
      "\nwoken {} times, every {}, {}: 99 % within {}, 99.99 % within {}, the worst {} late; {} periods missed\n",
      jitter.lateness.count(), time(request.period), jitter.obtained, time(jitter.lateness.percentile(0.99)),
      time(jitter.lateness.percentile(0.9999)), time(jitter.lateness.worst()), jitter.skipped);
  constexpr std::size_t before_bar = 26;
  const auto longest_bar =
      static_cast<double>(width == 0 ? 40 : std::clamp<std::size_t>(width, before_bar, 66) - before_bar);
  std::uint64_t most = 1;
  for (const JitterClass& one : jitter.classes) {
    most = std::max(most, one.count);
  }
  for (const JitterClass& one : jitter.classes) {
    // By the logarithm: one late wake-up of ten thousand is what counts.
    const double part =
        one.count == 0 ? 0.0 : std::log1p(static_cast<double>(one.count)) / std::log1p(static_cast<double>(most));
    const std::string bar(static_cast<std::size_t>(std::lround(part * longest_bar)), '#');
    text += fmt::format("  below {:>6}  {:>8}  {}\n", time(one.below), one.count, bar);
  }
  return text;
}

Json as_json(const std::vector<HostFinding>& findings, const JitterRequest& request,
             const std::optional<Jitter>& jitter) {
  Json list = Json::array();
  for (const HostFinding& one : findings) {
    list.push_back({{"name", one.name},
                    {"found", one.found},
                    {"rating", name_of(one.rating)},
                    {"why", one.why},
                    {"command", one.command}});
  }
  Json json{{"findings", list}, {"jitter", nullptr}};
  if (jitter) {
    Json classes = Json::array();
    for (const JitterClass& one : jitter->classes) {
      classes.push_back({{"below_ns", one.below}, {"count", one.count}});
    }
    json["jitter"] = {{"period_ns", request.period},
                      {"scheduling", jitter->obtained},
                      {"cycles", jitter->lateness.count()},
                      {"missed", jitter->skipped},
                      {"p99_ns", jitter->lateness.percentile(0.99)},
                      {"p9999_ns", jitter->lateness.percentile(0.9999)},
                      {"worst_ns", jitter->lateness.worst()},
                      {"classes", classes}};
  }
  return json;
}

int doctor(const DoctorOptions& options, Console& console) {
  if (!options.rt) {
    throw InputError(error::bad_usage, {}, "The doctor was not asked anything.",
                     "give --rt: whether this machine can run a cyclic task in time.");
  }
  JitterRequest request{.period = period_of(options.period)};
  request.cycles = static_cast<std::uint64_t>(options.seconds * 1e9 / static_cast<double>(request.period));
  request.scheduling = {.priority = options.priority,
                        .processor = options.processor ? static_cast<int>(*options.processor) : -1};
  check_machine(options);
  const bool is_measured = options.seconds > 0.0 && std::filesystem::equivalent(options.root, "/");
  if (is_measured && request.cycles == 0) {
    throw InputError(
        error::bad_usage, {},
        fmt::format("--seconds {} is shorter than one period of {}: nothing would be measured.",
                    number_text(options.seconds), options.period),
        fmt::format("give {} or more, or 0 for no measurement.", static_cast<double>(request.period) * 1e-9));
  }
  const auto findings =
      look_at_host({.root = options.root, .processor = options.processor, .priority = options.priority});
  if (!options.json) {
    console.print(findings_text(findings, terminal_width(stdout)));
  }
  std::optional<Jitter> jitter;
  // The measurement is of this machine.
  if (is_measured) {
    runtime::MonotonicClock clock;
    jitter = measure_jitter(request, clock);
  }
  console.print(options.json ? as_json(findings, request, jitter).dump(2) + "\n"
                : jitter     ? jitter_text(request, *jitter, terminal_width(stdout))
                             : "");
  const bool is_any_bad =
      std::ranges::any_of(findings, [](const HostFinding& one) { return one.rating == Rating::bad; });
  return is_any_bad || (jitter && jitter->skipped > 0) ? exit_findings : exit_ok;
}

}  // namespace

Action add_doctor(CLI::App& app) {
  const auto options = std::make_shared<DoctorOptions>();
  app.add_flag("--rt", options->rt, "Whether this machine can run a cyclic task in time.");
  app.add_option("--seconds", options->seconds, "How long the measurement takes; 0: none. Else 10.")
      ->check(number_between(0.0, 86'400.0))
      ->option_text("N");
  app.add_option("--period", options->period, "Of the measurement; else 1ms.")->option_text("TIME");
  app.add_option("--processor", options->processor, "The processor that the task keeps to, as processor under [task].")
      ->check(CLI::Range(0U, 1023U))
      ->option_text("N");
  app.add_option("--priority", options->priority, "Of the task, as priority under [task]; else 80.")
      ->check(CLI::Range(1, 99))
      ->option_text("N");
  app.add_option("--root", options->root,
                 "Another machine's /proc and /sys are below this folder; without a measurement "
                 "of it.")
      ->option_text("FOLDER");
  app.add_flag("--json", options->json, "Prints JSON.");
  app.footer(std::string(doctor_examples));
  return [options](Console& console) { return doctor(*options, console); };
}

}  // namespace hysteron::tool
