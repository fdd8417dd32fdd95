#include "tool/command_line.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <map>
#include <new>
#include <string_view>

#include "support/errors.hpp"
#include "support/names.hpp"
#include "support/trimmed.hpp"
#include "support/wrapped.hpp"
#include "tool/commands.hpp"
#include "tool/version.hpp"

namespace hysteron::tool {
namespace {

constexpr std::string_view program_examples = R"(Examples:
  hysteron check plant.st
  hysteron run plant.st --in log.csv --out out.csv
  hysteron generate plant.st --target cpp --out generated
  hysteron help run

Each error has a number, and a page: `hysteron explain HYnnn`.
Exit codes: 0 done; 1 done, and something was found; 2 bad usage or input.
)";

InputError bad_usage(std::string cause, std::string mend) {
  return {error::bad_usage, {}, std::move(cause), std::move(mend)};
}

std::vector<std::string> command_names() {
  std::vector<std::string> names;
  for (const Command& command : commands()) {
    names.emplace_back(command.name);
  }
  return names;
}

void check_command(const std::string& name) {
  const auto names = command_names();
  if (std::find(names.begin(), names.end(), name) != names.end()) {
    return;
  }
  const auto near = nearest_name(name, names);
  throw bad_usage(fmt::format("There is no command {}.", name),
                  near.empty() ? fmt::format("the commands are {}.", fmt::join(names, ", "))
                               : fmt::format("did you mean {}?", near));
}

/// The nearest option of a command to one that it does not have.
std::string nearest_option(const CLI::App& app, std::string option) {
  option = option.substr(0, option.find('='));
  std::vector<std::string> names;
  for (const CLI::Option* known : app.get_options()) {
    for (const std::string& name : known->get_lnames()) {
      names.push_back("--" + name);
    }
  }
  return std::string(nearest_name(option, names));
}

/// HY730 for an argument that is empty: no option and no argument of any command takes one, and what stands there is
/// most often a variable of the shell that is not set. To go on would be to leave the option out without a word.
void refuse_empty_arguments(const CLI::App& app, const std::vector<std::string>& arguments) {
  const auto full_name = "hysteron " + arguments.front();
  const auto takes_value = [&](const std::string& name) {
    const CLI::Option* const option = app.get_option_no_throw(name);
    return option != nullptr && !option->get_positional() && option->get_expected_max() > 0;
  };
  const auto refuse_value = [&](const std::string& name) {
    const bool required = takes_value(name) && app.get_option(name)->get_required();
    throw bad_usage(fmt::format("{}: the value of {} is empty.", full_name, name),
                    fmt::format("give a value{}; of a variable of the shell, see whether it is set.",
                                required ? "" : fmt::format(", or leave {} out", name)));
  };
  for (std::size_t i = 1; i < arguments.size(); ++i) {
    const std::string& argument = arguments[i];
    if (argument.starts_with("--") && argument.find('=') == argument.size() - 1) {
      refuse_value(argument.substr(0, argument.size() - 1));
    }
    if (!argument.empty()) {
      continue;
    }
    if (takes_value(arguments[i - 1])) {
      refuse_value(arguments[i - 1]);
    }
    throw bad_usage(fmt::format("{}: an argument is empty.", full_name),
                    "give a name, or leave it out; of a variable of the shell, see whether it is set.");
  }
}

/// `--in is required`: what the option is for stands beside it.
InputError missing_option(const CLI::App& command, const std::string& full_name, const std::string& text,
                          const std::string& see) {
  const std::string name = text.substr(0, text.find(' '));
  const CLI::Option* const option = command.get_option_no_throw(name);
  if (option == nullptr || option->get_description().empty()) {
    return bad_usage(fmt::format("{}: {}.", full_name, text), see);
  }
  const auto shown = trimmed(option->get_option_text());
  const std::string label = option->get_positional() ? std::string(shown.empty() ? std::string_view(name) : shown)
                            : shown.empty()          ? name
                                                     : fmt::format("{} {}", name, shown);
  return bad_usage(fmt::format("{}: {}.", full_name, text),
                   fmt::format("give {}: {} {}", label, option->get_description(), see));
}

/// What the library says of a bad command line, as a diagnostic.
InputError translated(const CLI::App& app, const CLI::ParseError& said) {
  const auto chosen = app.get_subcommands();
  const CLI::App& command = chosen.empty() ? app : *chosen.front();
  const auto full_name = chosen.empty() ? std::string("hysteron") : "hysteron " + command.get_name();
  const auto see = fmt::format("`{} --help` shows its options, with examples.", full_name);
  const bool is_required = dynamic_cast<const CLI::RequiredError*>(&said) != nullptr;
  if (is_required || dynamic_cast<const CLI::ExtrasError*>(&said) != nullptr) {
    for (const std::string& extra : app.remaining(true)) {  // --inn, before the missing --in
      if (extra.starts_with('-') && extra != "-") {
        const auto near = nearest_option(command, extra);
        return bad_usage(fmt::format("{} has no option {}.", full_name, extra),
                         near.empty() ? see : fmt::format("did you mean {}?", near));
      }
    }
  }
  if (is_required) {
    return missing_option(command, full_name, said.what(), see);
  }
  if (dynamic_cast<const CLI::ExtrasError*>(&said) != nullptr) {
    return bad_usage(fmt::format("{} does not take the argument {}.", full_name, app.remaining(true).front()), see);
  }
  const std::string text = said.what();
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&said) != nullptr && text.starts_with('-')) {
    if (text.find(": At Most ") != std::string::npos) {
      return bad_usage(fmt::format("{}: {} is given more than once.", full_name, text.substr(0, text.find(':'))),
                       "give it once: it takes one value.");
    }
    return bad_usage(fmt::format("{}: {} needs a value.", full_name, text.substr(0, text.find(':'))), see);
  }
  return bad_usage(fmt::format("{}: {}.", full_name, text), see);
}

bool given(const CLI::App& command, const char* name) {
  const CLI::Option* const option = command.get_option_no_throw(name);
  return option != nullptr && option->count() > 0;
}

/// `--out -`: the result itself goes to the standard output.
bool out_is_standard(const CLI::App& command) {
  return given(command, "--out") && command.get_option("--out")->results().back() == "-";
}

/// Nobody wants a file or a folder that is called -.
void refuse_product_called_dash(const CLI::App& command) {
  if (command.get_name() == "run") {
    return;
  }
  for (const char* const name : {"--out", "--report", "--bench"}) {
    if (given(command, name) && command.get_option(name)->results().back() == "-") {
      throw bad_usage(fmt::format("hysteron {}: {} takes no -, which would be a file or folder of this name.",
                                  command.get_name(), name),
                      "give a name; the standard output is /dev/stdout, where a file is wanted.");
    }
  }
}

class CommandLine {
 public:
  CommandLine() {
    app_.name("hysteron");
    app_.set_help_flag("-h,--help", "Shows this help.");
    app_.set_version_flag("--version", fmt::format("hysteron {}\n", version), "Shows the version.");
    app_.footer(std::string(program_examples));
    app_.get_formatter()->label("SUBCOMMAND", "COMMAND");
    for (const Command& command : commands()) {
      CLI::App* const options = app_.add_subcommand(std::string(command.name), std::string(command.summary));
      options->set_help_flag("-h,--help", "Shows this help.");
      options->group("Commands");
      options->get_formatter()->label("Positionals", "Arguments");
      actions_[options] = {command.add(*options), command.results};
      options->add_flag("--quiet", quiet_,
                        command.results == Results::Report
                            ? "Says errors and warnings alone: no report, no notes, no progress."
                            : "No notes, no progress; results are printed all the same.");
    }
  }

  int run(std::vector<std::string> arguments, Console& console) {
    if (arguments.empty()) {
      throw bad_usage("No command is given.", fmt::format("the commands are {}; `hysteron help` says what they do.",
                                                          fmt::join(command_names(), ", ")));
    }
    if (arguments.front() == "help") {
      arguments.front() = "--help";
      if (arguments.size() > 1) {
        std::swap(arguments[0], arguments[1]);
      }
    }
    // The library would take `man tune` for two commands.
    if (arguments.front() == "man" && arguments.size() > 1 && !arguments[1].starts_with('-')) {
      arguments[1] = "--command=" + arguments[1];
    }
    if (!arguments.front().starts_with('-')) {
      check_command(arguments.front());
      refuse_empty_arguments(*app_.get_subcommand(arguments.front()), arguments);
    }
    try {
      std::reverse(arguments.begin(), arguments.end());  // so the library wants them
      app_.parse(arguments);
    } catch (const CLI::CallForHelp&) {
      console.print(wrapped(app_.help(), terminal_width(stdout)));
      return exit_ok;
    } catch (const CLI::CallForVersion& version_text) {
      console.print(version_text.what());
      return exit_ok;
    } catch (const CLI::ParseError& said) {
      throw translated(app_, said);
    }
    const auto chosen = app_.get_subcommands();
    if (chosen.empty()) {
      throw bad_usage("No command is given.", "`hysteron help` lists the commands.");
    }
    refuse_product_called_dash(*chosen.front());
    const auto& [action, results] = actions_.at(chosen.front());
    const bool is_product =
        given(*chosen.front(), "--json") || given(*chosen.front(), "--markdown") || out_is_standard(*chosen.front());
    console.speak({.quiet = quiet_, .results = is_product ? Results::Product : results});
    return action(console);
  }

 private:
  CLI::App app_{"Block diagrams for hysteresis and its compensation: check, run, tune, generate."};
  struct Chosen {
    Action action{};
    Results results = Results::Product;
  };
  std::map<const CLI::App*, Chosen> actions_;
  bool quiet_ = false;
};

}  // namespace

int run_command_line(std::vector<std::string> arguments, Console& console) {
  int exit_code = exit_bad_input;
  try {
    exit_code = CommandLine().run(std::move(arguments), console);
  } catch (const InputError& refused) {
    console.report(refused.diagnostics());
  } catch (const std::bad_alloc&) {
    (void)std::fputs("hysteron: there is not enough memory for this input.\n", stderr);
  } catch (const std::exception& fault) {
    (void)std::fputs(fmt::format("hysteron: a fault of the tool itself, please report it: {}\n", fault.what()).c_str(),
                     stderr);
  }
  return console.finish(exit_code);
}

}  // namespace hysteron::tool
