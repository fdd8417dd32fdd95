#include "fleet/result.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "support/atomic_file.hpp"
#include "support/diagnostic.hpp"
#include "support/sha256.hpp"
#include "support/text_file.hpp"

namespace hysteron::fleet {
namespace {

constexpr std::string_view schema = "hysteron-fleet-unit/1";
constexpr std::array<std::string_view, 4> names{"open", "done", "refused", "failed"};

std::string content_or_name(const std::string& file) {
  try {
    return "content " + read_text_file(file);
  } catch (const InputError&) {
    return "name " + file;
  }
}

}  // namespace

std::string_view name_of(Status status) {
  return names.at(static_cast<std::size_t>(status));
}

std::string key_of(const Unit& unit, std::string_view version, const std::vector<std::string>& options) {
  std::string text;
  // With their lengths: what ends one and begins the next is not open.
  const auto add = [&](std::string_view part) { text += fmt::format("{}:{}\n", part.size(), part); };
  add(schema);
  add(version);
  add(unit.machine);
  add(unit.when);
  add(read_text_file(unit.diagram));
  add(read_text_file(unit.parameters));
  add(content_or_name(unit.log));
  for (const std::string& option : options) {
    add(option);
  }
  return sha256(text);
}

std::filesystem::path folder_of(const std::filesystem::path& output, const std::string& key) {
  return output / "units" / key;
}

void write_result(const std::filesystem::path& folder, const Unit& unit, std::string_view version,
                  const Result& result) {
  const nlohmann::ordered_json json{{"schema", schema},
                                    {"version", version},
                                    {"machine", unit.machine},
                                    {"when", unit.when},
                                    {"status", name_of(result.status)},
                                    {"exit_code", result.exit_code},
                                    {"reason", result.reason},
                                    {"seconds", result.seconds}};
  write_file_atomically(folder / "result.json",
                        json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

Result read_result(const std::filesystem::path& folder) {
  try {
    const auto json = nlohmann::json::parse(read_text_file((folder / "result.json").string()));
    const auto status = std::ranges::find(names, json.at("status").get<std::string>());
    if (json.at("schema").get<std::string>() == schema && status != names.end()) {
      return {.status = static_cast<Status>(status - names.begin()),
              .exit_code = json.at("exit_code").get<int>(),
              .reason = json.at("reason").get<std::string>(),
              .seconds = json.at("seconds").get<double>()};
    }
  } catch (const InputError&) {                 // not there
  } catch (const nlohmann::json::exception&) {  // no result of ours
  }
  return {};
}

}  // namespace hysteron::fleet
