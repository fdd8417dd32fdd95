// What is done with a record: one command of the tool, and the file that says what came of it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace hysteron::fleet {

enum class Command : std::uint8_t {
  Diagnose,  ///< verdict.json
  Tune,      ///< report.json and tuned.toml
  Check      ///< diagnostics.json, of the diagram alone
};

[[nodiscard]] std::string_view name_of(Command command);
/// Nothing where the text names none.
[[nodiscard]] std::optional<Command> command_named(std::string_view text);

/// Whether it reads parameters beside the diagram, and a record where there is one.
[[nodiscard]] constexpr bool needs_parameters(Command command) {
  return command != Command::Check;
}

/// Whether it always reads a record: `tune` does not where the parameters have a [goal] with a signal of its own.
[[nodiscard]] constexpr bool always_needs_log(Command command) {
  return command == Command::Diagnose;
}

/// The file in the folder of a unit that holds what was found, as JSON.
[[nodiscard]] std::string_view product_of(Command command);

/// Why there is no result, where the command ended with exit code 1 and wrote its product.
[[nodiscard]] std::string_view refusal_of(Command command);

struct Unit;
/// The words of the command line, without the program. `options` are those of `diagnose`.
[[nodiscard]] std::vector<std::string> arguments_of(const Unit& unit, const std::filesystem::path& folder,
                                                    const std::vector<std::string>& options);

}  // namespace hysteron::fleet
