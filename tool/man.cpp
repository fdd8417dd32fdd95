#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "support/atomic_file.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"
#include "tool/commands.hpp"
#include "tool/manual.hpp"

namespace hysteron::tool {
namespace {

constexpr std::string_view man_examples = R"(Examples:
  hysteron man tune | man -l -
  hysteron man --out /usr/local/share/man/man1

Prints the manual page of the tool or of a command, or writes them all.
Exit codes: 0 done; 2 there is no such command, or a page cannot be written.
)";

constexpr std::string_view completion_examples = R"(Examples:
  hysteron completion bash > ~/.local/share/bash-completion/completions/hysteron
  hysteron completion zsh > ~/.zfunc/_hysteron
  hysteron completion fish > ~/.config/fish/completions/hysteron.fish

Prints what completes commands, options and their words on Tab.
Exit codes: 0 done; 2 another shell.
)";

struct ManOptions {
  std::string command;
  std::string folder;
};

int man(const CLI::App& program, const ManOptions& options, Console& console) {
  if (!options.folder.empty()) {
    std::vector<OutputFile> pages{
        {.path = std::filesystem::path(options.folder) / "hysteron.1", .contents = manual_page(program)}};
    for (const CLI::App* const one : program.get_subcommands([](const CLI::App*) { return true; })) {
      pages.push_back({.path = std::filesystem::path(options.folder) / fmt::format("hysteron-{}.1", one->get_name()),
                       .contents = manual_page(*one)});
    }
    write_files_atomically(pages);
    return exit_ok;
  }
  const CLI::App* page = &program;
  if (!options.command.empty()) {
    const auto all = program.get_subcommands([](const CLI::App*) { return true; });
    const auto found =
        std::ranges::find_if(all, [&](const CLI::App* one) { return one->get_name() == options.command; });
    if (found == all.end()) {
      throw InputError(error::bad_usage, {}, fmt::format("There is no command {}.", options.command),
                       "`hysteron help` lists the commands.");
    }
    page = *found;
  }
  console.print(manual_page(*page));
  return exit_ok;
}

}  // namespace

Action add_man(CLI::App& app) {
  const auto options = std::make_shared<ManOptions>();
  app.add_option("--command", options->command,
                 "The command, also without --command; the tool itself where none is named.")
      ->option_text("COMMAND");
  app.add_option("--out", options->folder, "Writes the pages of all commands into this folder.")->option_text("DIR");
  app.footer(std::string(man_examples));
  return [options, &app](Console& console) { return man(*app.get_parent(), *options, console); };
}

Action add_completion(CLI::App& app) {
  const auto shell = std::make_shared<std::string>();
  app.add_option("SHELL", *shell, "bash, zsh or fish.")->required();
  app.footer(std::string(completion_examples));
  return [shell, &app](Console& console) {
    if (*shell != "bash" && *shell != "zsh" && *shell != "fish") {
      throw InputError(error::bad_usage, {}, fmt::format("There is no completion for {}.", *shell),
                       "the shells are: bash, zsh, fish.");
    }
    console.print(completion(*app.get_parent(), *shell));
    return exit_ok;
  };
}

}  // namespace hysteron::tool
