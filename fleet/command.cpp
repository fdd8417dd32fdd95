#include "fleet/command.hpp"

#include <array>

#include "fleet/manifest.hpp"

namespace hysteron::fleet {
namespace {

struct Described {
  std::string_view name;
  std::string_view product;
  std::string_view refusal;
};
constexpr std::array<Described, 3> described{
    {{"diagnose", "verdict.json", "the record cannot be diagnosed, verdict.json says why."},
     {"tune", "report.json", "the fit did not converge, or limits of a goal are broken; report.json says why."},
     {"check", "diagnostics.json", "the diagram has errors, diagnostics.json says which."}}};

const Described& description(Command command) {
  return described.at(static_cast<std::size_t>(command));
}

}  // namespace

std::string_view name_of(Command command) {
  return description(command).name;
}

std::optional<Command> command_named(std::string_view text) {
  for (std::size_t i = 0; i < described.size(); ++i) {
    if (described.at(i).name == text) {
      return static_cast<Command>(i);
    }
  }
  return std::nullopt;
}

std::string_view product_of(Command command) {
  return description(command).product;
}

std::string_view refusal_of(Command command) {
  return description(command).refusal;
}

std::vector<std::string> arguments_of(const Unit& unit, const std::filesystem::path& folder,
                                      const std::vector<std::string>& options) {
  std::vector<std::string> words{std::string(name_of(unit.command)), unit.diagram};
  if (unit.command == Command::Check) {
    words.emplace_back("--json");
    return words;
  }
  if (!unit.log.empty()) {
    words.insert(words.end(), {"--log", unit.log});
  }
  words.insert(words.end(), {"--params", unit.parameters, "--out"});
  if (unit.command == Command::Tune) {
    words.insert(words.end(), {(folder / "tuned.toml").string(), "--report", folder.string()});
  } else {
    words.push_back(folder.string());
    words.insert(words.end(), options.begin(), options.end());
  }
  return words;
}

}  // namespace hysteron::fleet
