// hysteron online-change: changes the diagram of a task that runs, without ending it.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "runtime/config/run_config.hpp"
#include "runtime/config/run_keys.hpp"
#include "support/atomic_file.hpp"
#include "support/errors.hpp"
#include "support/numbers.hpp"
#include "support/text_file.hpp"
#include "tool/change_channel.hpp"
#include "tool/change_messages.hpp"
#include "tool/commands.hpp"
#include "tool/option_values.hpp"

namespace hysteron::tool {
namespace {

constexpr std::string_view online_change_examples = R"(Examples:
  hysteron online-change RUN.toml --check
  hysteron online-change RUN.toml
  hysteron online-change RUN.toml --bump U=0.5
  hysteron online-change RUN.toml --load 0.9
  hysteron online-change RUN.toml --back

Edit the diagram that `hysteron serve` was started with, and its parameter file. --check says what would be carried over
and how far each output would jump; without it the task changes to what stands in the files now, between two steps, or
refuses with the reason. --back brings the version before back, and its files; what stood there is kept beside as
FILE.undone. The run file names the socket of the task: socket under [online_change]. What else it says counts from the
next start on; a run file with which the new version could not be started is refused.
Exit codes: 0 changed, nothing to change, or nothing stands against it; 2 refused: the running version goes on.
)";

struct OnlineChangeOptions {
  std::string config{};
  std::vector<std::string> bumps{};
  std::vector<std::string> as_given{};
  std::optional<double> load{};
  bool check = false;
  bool back = false;
  bool json = false;
};

using Socket = runtime::ChangeConfig;

Socket socket_of(const std::string& file) {
  auto socket = runtime::change_config_of(file, read_text_file(file));
  if (!socket) {
    throw InputError(error::no_online_change, {.file = file}, "The run file names no socket for online changes.",
                     "write [online_change] and below it socket = \"online-change.socket\", and start the task anew.");
  }
  return std::move(*socket);
}

std::map<std::string, double> bumps_of(const std::vector<std::string>& words) {
  std::map<std::string, double> bumps;
  for (const std::string& word : words) {
    const std::size_t sign = word.find('=');
    const ParsedNumber number = parse_number(sign == std::string::npos ? "" : std::string_view(word).substr(sign + 1));
    const bool is_limit = number.status == NumberStatus::Finite && number.value >= 0.0;
    if (!is_limit || !bumps.emplace(word.substr(0, sign), number.value).second) {
      throw InputError(error::bad_usage, {}, fmt::format("--bump does not understand \"{}\".", word),
                       "write each output once, with a number from 0 on: --bump U=0.5.");
    }
  }
  return bumps;
}

Json ask(const Socket& socket, const OnlineChangeOptions& options, std::string_view what) {
  Json request{{"what", what}, {"bumps", bumps_of(options.bumps)}, {"as_given", options.as_given}};
  if (options.load) {
    request["load"] = *options.load;
  }
  const auto waits = [&](std::string_view doing) {
    Console::note(options.config, fmt::format("waits; the task {}", doing));
  };
  const Json answer = Json::parse(ask_task(socket.socket, socket.place, request.dump(), waits), nullptr, false);
  if (!answer.is_object()) {
    throw InputError(error::no_online_change, socket.place, "What listens there gives no answer that is understood.",
                     "give the command of the same version as the task.");
  }
  if (answer.contains("errors")) {
    throw InputError(diagnostics_of(answer.at("errors")));
  }
  return answer;
}

std::string number_word(const Json& value) {
  return value.is_null() ? "no number" : fmt::format("{:.6g}", value.get<double>());
}

std::string list_text(std::string_view title, const Json& names) {
  return names.empty() ? "" : fmt::format("{}: {}\n", title, fmt::join(names.get<std::vector<std::string>>(), ", "));
}

/// The first of them, and how many there are beside.
Json register_texts(const Json& registers) {
  constexpr std::size_t most = 8;
  Json texts = Json::array();
  for (const Json& one : registers) {
    const std::string then =
        one.at("after_restart").is_null() ? "" : fmt::format(" (then {})", one.at("after_restart").get<std::string>());
    texts.push_back(one.at("name").get<std::string>() + " at " + one.at("address").get<std::string>() + then);
  }
  if (texts.size() > most) {
    const std::size_t beside = texts.size() - most;
    texts.erase(texts.begin() + most, texts.end());
    texts.push_back(fmt::format("and {} more (--json has all)", beside));
  }
  return texts;
}

std::string edited_run_file_text(const Json& report) {
  return report.at("run_file_edited").get<bool>()
             ? "the run file was edited since the start of the task: what it says now counts from the next start on\n"
             : "";
}

/// The files are those of the version that runs.
std::string nothing_text(const Json& report) {
  return fmt::format("{}: nothing changed; version {} runs on{}\n", report.at("program").get<std::string>(),
                     report.at("version").get<std::uint64_t>(),
                     report.at("way_back").get<bool>() ? ", and --back goes where it went before" : "") +
         edited_run_file_text(report);
}

std::string change_text(const Json& report, bool is_back) {
  std::string text = fmt::format(
      "{}: {}\n{} of {} parameters and {} of {} states {} carried over\n", report.at("program").get<std::string>(),
      !report.at("changed").get<bool>()
          ? fmt::format("nothing stands against it; version {} runs on", report.at("version").get<std::uint64_t>())
          : fmt::format("{}version {} runs", is_back ? "back; " : "", report.at("version").get<std::uint64_t>()),
      report.at("parameters_carried").get<std::size_t>(), report.at("parameters").get<std::size_t>(),
      report.at("states_carried").get<std::size_t>(), report.at("states").get<std::size_t>(),
      report.at("changed").get<bool>() ? "were" : "would be");
  for (const Json& one : report.at("outputs")) {
    const std::string unit = one.at("unit");
    text += fmt::format("  {}: {} to {}{}, a bump of {:.6g}; the limit is {:.6g} ({})\n",
                        one.at("name").get<std::string>(), number_word(one.at("before")), number_word(one.at("after")),
                        unit.empty() ? "" : " " + unit, one.at("bump").get<double>(), one.at("limit").get<double>(),
                        one.at("limit_from").get<std::string>());
  }
  text += list_text("not carried over", report.at("left"));
  text += list_text("as before the change", report.at("as_before"));
  text += list_text(is_back ? "as they run, and not as before the change" : "as they run, and not as in the files",
                    report.at("other_values"));
  text += list_text("new registers", register_texts(report.at("registers")));
  text += list_text("without a register until a restart", report.at("without_register"));
  text += list_text("elsewhere after a restart, for want of lock_file under [modbus]",
                    register_texts(report.at("registers_until_restart")));
  text += fmt::format("a step of it takes {}, {:.2g} % of the period; the limit is {:.3g} %\n",
                      runtime::short_time_text(report.at("step_time_ns").get<double>()),
                      100.0 * report.at("load").get<double>(), 100.0 * report.at("load_limit").get<double>());
  if (!report.at("retained").get<bool>()) {
    text += "its values are not on the disk yet: see task.write_failures\n";
  }
  return text + edited_run_file_text(report);
}

/// Nothing where there is no file.
std::optional<std::string> text_on_disk(const std::filesystem::path& path) {
  std::error_code unknown;
  return std::filesystem::exists(path, unknown) ? std::optional(read_text_file(path.string())) : std::nullopt;
}

/// FILE.undone, or the first of FILE.undone.2, … that is free.
std::filesystem::path free_name(const std::filesystem::path& path) {
  std::error_code unknown;
  std::filesystem::path name = path.string() + ".undone";
  for (int number = 2; std::filesystem::exists(name, unknown); ++number) {
    name = fmt::format("{}.undone.{}", path.string(), number);
  }
  return name;
}

/// The files of the version before stand where a restart reads them, before the task is asked to run it: should this
/// process die in between, a restart still runs what was asked for.
class FilesBack {
 public:
  explicit FilesBack(const std::vector<OutputFile>& former) {
    std::vector<OutputFile> changed;
    for (const OutputFile& one : former) {
      std::optional<std::string> found = text_on_disk(one.path);
      if (found == one.contents) {
        continue;
      }
      changed.push_back(one);
      if (found) {
        kept_.push_back({.path = free_name(one.path), .contents = *found});
        as_they_were_.push_back({.path = one.path, .contents = std::move(*found)});
      } else {
        missing_.push_back(one.path);
      }
    }
    std::vector<OutputFile> all = kept_;
    all.insert(all.end(), changed.begin(), changed.end());
    write_files_atomically(all);
  }
  /// The task goes on with the version that it had.
  void undo() const {
    write_files_atomically(as_they_were_);
    std::vector<std::filesystem::path> made = missing_;
    std::ranges::transform(kept_, std::back_inserter(made), &OutputFile::path);
    for (const std::filesystem::path& path : made) {
      std::error_code unknown;
      std::filesystem::remove(path, unknown);
    }
  }
  [[nodiscard]] std::string text() const {
    std::string text;
    for (std::size_t i = 0; i < kept_.size(); ++i) {
      text += fmt::format("{} is as before; what stood there is in {}\n", as_they_were_[i].path.string(),
                          kept_[i].path.string());
    }
    for (const std::filesystem::path& path : missing_) {
      text += fmt::format("{} was missing, and is as before\n", path.string());
    }
    return text;
  }

 private:
  std::vector<OutputFile> kept_{};                ///< beside each file, what stood there
  std::vector<OutputFile> as_they_were_{};        ///< the files themselves
  std::vector<std::filesystem::path> missing_{};  ///< files that were not there
};

int go_back(const Socket& socket, const OnlineChangeOptions& options, Console& console) {
  // Asked first: nothing is written for a change that is refused anyway.
  (void)ask(socket, options, "check-back");
  const FilesBack files(files_of(ask(socket, options, "files").at("files")));
  try {
    const Json answer = ask(socket, options, "back");
    console.print(options.json ? answer.at("report").dump(2) + "\n"
                               : change_text(answer.at("report"), true) + files.text());
  } catch (const InputError& refused) {
    const auto& all = refused.diagnostics().all();
    const bool is_answered =
        std::ranges::none_of(all, [](const Diagnostic& one) { return one.number == error::no_online_change; });
    if (is_answered) {  // else the task may have changed: the files stay as was asked for
      files.undo();
    }
    throw;
  }
  return exit_ok;
}

int online_change(const OnlineChangeOptions& options, Console& console) {
  const Socket socket = socket_of(options.config);
  if (options.back && !options.check) {
    return go_back(socket, options, console);
  }
  const Json answer = ask(socket, options, options.back ? "check-back" : options.check ? "check" : "change");
  console.report(diagnostics_of(answer.at("warnings")));
  const Json& report = answer.at("report");
  const bool is_nothing = !options.check && !report.at("changed").get<bool>();
  console.print(options.json ? report.dump(2) + "\n"
                : is_nothing ? nothing_text(report)
                             : change_text(report, options.back));
  return exit_ok;
}

}  // namespace

Action add_online_change(CLI::App& app) {
  const auto options = std::make_shared<OnlineChangeOptions>();
  app.add_option("RUN.toml", options->config, "The run file that the task was started with.")
      ->required()
      ->option_text(" ");
  app.add_flag("--check", options->check, "Says what the change would do, and does not do it.");
  app.add_flag("--back", options->back, "Brings the version before back, and its files.");
  app.add_option("--bump", options->bumps, "How far this output may jump at this change, in its unit; may be repeated.")
      ->option_text("NAME=NUMBER");
  app.add_option("--as-given", options->as_given,
                 "A parameter that is taken as the files give it, and not carried over; may be repeated.")
      ->option_text("NAME");
  app.add_option("--load", options->load,
                 "What part of the period a step of the new version may take at this change: 0.9.")
      ->check(number_between(1e-3, 1.0))
      ->option_text("NUMBER");
  app.add_flag("--json", options->json, "Prints JSON.");
  app.footer(std::string(online_change_examples));
  return [options](Console& console) { return online_change(*options, console); };
}

}  // namespace hysteron::tool
