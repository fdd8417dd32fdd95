#include "tool/manual.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <sstream>
#include <vector>

#include "support/shell_words.hpp"
#include "tool/version.hpp"

namespace hysteron::tool {
namespace {

/// Text that roff takes as it is: a backslash, a hyphen, a point or a quote at the begin of a line has a meaning.
std::string as_roff(std::string_view text) {
  std::string result;
  bool line_begins = true;
  for (const char c : text) {
    if (line_begins && (c == '.' || c == '\'')) {
      result += "\\&";
    }
    result += c == '\\' ? std::string("\\e") : c == '-' ? std::string("\\-") : std::string(1, c);
    line_begins = c == '\n';
  }
  return result;
}

std::string option_name(const CLI::Option& option) {
  std::string name = option.get_positional() ? option.get_name(true, false) : option.get_name(false, true);
  return name;
}

std::vector<const CLI::App*> commands_of(const CLI::App& program) {
  return program.get_subcommands([](const CLI::App*) { return true; });
}

std::vector<const CLI::Option*> options_of(const CLI::App& command, bool positional) {
  std::vector<const CLI::Option*> result;
  for (const CLI::Option* const option : command.get_options()) {
    if (option->get_positional() == positional) {
      result.push_back(option);
    }
  }
  return result;
}

/// The long names, as --params.
std::vector<std::string> long_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* const option : options_of(command, false)) {
    for (const std::string& name : option->get_lnames()) {
      names.push_back("--" + name);
    }
  }
  return names;
}

/// The words of linear|hold|average; none where an option takes what it will.
std::vector<std::string> words_of(const CLI::Option& option) {
  std::vector<std::string> words;
  const std::string text = option.get_option_text();
  if (text.find('|') != std::string::npos) {
    std::istringstream parts(text);
    for (std::string word; std::getline(parts, word, '|');) {
      words.push_back(word);
    }
  }
  return words;
}

bool takes_value(const CLI::Option& option) {
  return option.get_expected_max() > 0;
}

std::string for_bash(const CLI::App& program) {
  std::vector<std::string> names;
  std::string options;
  std::string words;
  for (const CLI::App* const command : commands_of(program)) {
    names.push_back(command->get_name());
    options += fmt::format("    {}) options='{}' ;;\n", command->get_name(), fmt::join(long_names(*command), " "));
    for (const CLI::Option* const option : options_of(*command, false)) {
      if (const auto known = words_of(*option); !known.empty()) {
        words += fmt::format("    {}:--{}) COMPREPLY=($(compgen -W '{}' -- \"$cur\")); return ;;\n",
                             command->get_name(), option->get_lnames().front(), fmt::join(known, " "));
      }
    }
  }
  return fmt::format(R"(# Completion of hysteron for bash, printed by `hysteron completion bash`.
_hysteron() {{
  local cur=${{COMP_WORDS[COMP_CWORD]}} prev=${{COMP_WORDS[COMP_CWORD-1]}} command=${{COMP_WORDS[1]}} options=
  if [ "$COMP_CWORD" -eq 1 ]; then
    COMPREPLY=($(compgen -W 'help {0} --help --version' -- "$cur"))
    return
  fi
  case "$command" in
    help) COMPREPLY=($(compgen -W '{0}' -- "$cur")); return ;;
{1}  esac
  case "$command:$prev" in
{2}  esac
  case "$cur" in
    -*) COMPREPLY=($(compgen -W "$options" -- "$cur")) ;;
    *) COMPREPLY=($(compgen -f -- "$cur")) ;;
  esac
}}
complete -o filenames -F _hysteron hysteron
)",
                     fmt::join(names, " "), options, words);
}

std::string for_zsh(const CLI::App& program) {
  std::string names;
  std::string arguments;
  // A colon and brackets have a meaning in a description.
  const auto plain = [](std::string text) {
    std::ranges::replace(text, ':', ';');
    std::ranges::replace(text, '[', '(');
    std::ranges::replace(text, ']', ')');
    return text;
  };
  for (const CLI::App* const command : commands_of(program)) {
    names += fmt::format("    {}\n", shell_quoted(command->get_name() + ":" + plain(command->get_description())));
    arguments += fmt::format("    {}) _arguments", command->get_name());
    for (const CLI::Option* const option : options_of(*command, false)) {
      const auto words = words_of(*option);
      const std::string value = !takes_value(*option) ? ""
                                : words.empty()       ? fmt::format(":{}:_files", plain(option->get_option_text()))
                                                      : fmt::format(":value:({})", fmt::join(words, " "));
      for (const std::string& name : option->get_lnames()) {
        arguments += " " + shell_quoted(fmt::format("--{}[{}]{}", name, plain(option->get_description()), value));
      }
    }
    arguments += " '*:file:_files' ;;\n";
  }
  return fmt::format(R"(#compdef hysteron
# Completion of hysteron for zsh, printed by `hysteron completion zsh`.
_hysteron() {{
  local -a commands=(
{}  )
  if (( CURRENT == 2 )); then
    _describe command commands
    return
  fi
  local command=$words[2]
  shift words
  (( CURRENT-- ))
  case "$command" in
{}  esac
}}
_hysteron "$@"
)",
                     names, arguments);
}

std::string for_fish(const CLI::App& program) {
  std::string text = "# Completion of hysteron for fish, printed by `hysteron completion fish`.\n";
  for (const CLI::App* const command : commands_of(program)) {
    text += fmt::format("complete -c hysteron -n __fish_use_subcommand -a {} -d {}\n", command->get_name(),
                        shell_quoted(command->get_description()));
    for (const CLI::Option* const option : options_of(*command, false)) {
      const auto words = words_of(*option);
      for (const std::string& name : option->get_lnames()) {
        text += fmt::format("complete -c hysteron -n '__fish_seen_subcommand_from {}' -l {} -d {}{}{}\n",
                            command->get_name(), name, shell_quoted(option->get_description()),
                            takes_value(*option) ? " -r" : "",
                            words.empty() ? "" : fmt::format(" -x -a '{}'", fmt::join(words, " ")));
      }
    }
  }
  return text;
}

}  // namespace

std::string manual_page(const CLI::App& command) {
  const bool is_program = command.get_parent() == nullptr;
  const std::string name = is_program ? "hysteron" : "hysteron-" + command.get_name();
  std::string capitals = name;
  std::ranges::transform(capitals, capitals.begin(),
                         [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 32) : c; });
  std::string summary = command.get_description();
  if (summary.ends_with('.')) {
    summary.pop_back();
  }
  std::string text = fmt::format(".TH {} 1 \"\" \"hysteron {}\"\n.SH NAME\n{} \\- {}\n.SH SYNOPSIS\n.B hysteron",
                                 capitals, version, as_roff(name), as_roff(summary));
  if (is_program) {
    text += "\n.I COMMAND\n[OPTIONS]\n.SH COMMANDS\n";
    for (const CLI::App* const one : commands_of(command)) {
      text += fmt::format(".TP\n.BR hysteron\\-{} (1)\n{}\n", one->get_name(), as_roff(one->get_description()));
    }
  } else {
    text += fmt::format(" {}\n[OPTIONS]\n", command.get_name());
    for (const CLI::Option* const option : options_of(command, true)) {
      text += fmt::format(".I {}\n", as_roff(option_name(*option)));
    }
    text += ".SH OPTIONS\n";
    for (const bool positional : {true, false}) {
      for (const CLI::Option* const option : options_of(command, positional)) {
        const std::string value =
            positional || !takes_value(*option) ? "" : " \\fI" + as_roff(option->get_option_text()) + "\\fR";
        text += fmt::format(".TP\n\\fB{}\\fR{}\n{}\n", as_roff(option_name(*option)), value,
                            as_roff(option->get_description()));
      }
    }
  }
  text += fmt::format(".SH EXAMPLES AND NOTES\n.nf\n{}.fi\n", as_roff(command.get_footer()));
  return text;
}

std::string completion(const CLI::App& program, std::string_view shell) {
  return shell == "bash" ? for_bash(program) : shell == "zsh" ? for_zsh(program) : for_fish(program);
}

}  // namespace hysteron::tool
