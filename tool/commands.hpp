// The commands of the tool. A new one is a file with its `add_` function and one line in commands.cpp.
#pragma once

#include <functional>
#include <span>
#include <string_view>

#include "tool/console.hpp"

namespace CLI {  // NOLINT(readability-identifier-naming): the library is so named
class App;
}

namespace hysteron::tool {

/// What the tool says to the shell.
inline constexpr int exit_ok = 0;
inline constexpr int exit_findings = 1;   ///< the work was done, and something was found: errors, failed tests
inline constexpr int exit_bad_input = 2;  ///< the work could not be done: bad usage, bad input

/// Runs a command once its options are read; gives back the exit code. An InputError that it lets out is printed by
/// the caller, and is exit_bad_input.
using Action = std::function<int(Console&)>;

struct Command {
  std::string_view name;
  std::string_view summary;
  Action (*add)(CLI::App& app);        ///< adds the options of the command
  Results results = Results::Product;  ///< where they are not asked for as JSON
};

/// All commands, in the order in which the help lists them.
[[nodiscard]] std::span<const Command> commands();

Action add_new(CLI::App& app);
Action add_check(CLI::App& app);
Action add_fmt(CLI::App& app);
Action add_draw(CLI::App& app);
Action add_record(CLI::App& app);
Action add_plot(CLI::App& app);
Action add_compare(CLI::App& app);
Action add_run(CLI::App& app);
Action add_generate(CLI::App& app);
Action add_export(CLI::App& app);
Action add_library(CLI::App& app);
Action add_import(CLI::App& app);
Action add_tune(CLI::App& app);
Action add_relay(CLI::App& app);
Action add_diagnose(CLI::App& app);
Action add_fleet(CLI::App& app);
Action add_fleet_report(CLI::App& app);
Action add_lsp(CLI::App& app);
Action add_test(CLI::App& app);
Action add_serve(CLI::App& app);
Action add_online_change(CLI::App& app);
Action add_replay(CLI::App& app);
Action add_history(CLI::App& app);
Action add_map(CLI::App& app);
Action add_retained(CLI::App& app);
Action add_doctor(CLI::App& app);
Action add_blocks(CLI::App& app);
Action add_explain(CLI::App& app);
Action add_man(CLI::App& app);
Action add_completion(CLI::App& app);

}  // namespace hysteron::tool
