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

constexpr std::string_view schema = "hysteron-fleet-unit/2";
constexpr std::array<std::string_view, 4> names{"open", "done", "refused", "failed"};

/// Parts with their lengths: what ends one and begins the next is not open.
class Parts {
 public:
  void add(std::string_view part) { text_ += fmt::format("{}:{}\n", part.size(), part); }
  [[nodiscard]] std::string digest() const { return sha256(text_); }

 private:
  std::string text_;
};

}  // namespace

std::string_view name_of(Status status) {
  return names.at(static_cast<std::size_t>(status));
}

const std::string& Keys::digest(const std::string& file) {
  const auto [place, is_new] = digests_.emplace(file, "");
  if (is_new) {
    try {
      place->second = "content " + sha256(read_text_file(file));
    } catch (const InputError&) {
      place->second = "name " + file;
    }
  }
  return place->second;
}

const std::string& Keys::digest_of_all(const std::string& file, const NamedFiles& named) {
  const auto [place, is_new] = with_named_.emplace(file, "");
  if (is_new) {
    Parts parts;
    parts.add(digest(file));
    for (const std::string& other : named ? named(file) : std::vector<std::string>()) {
      parts.add(digest(other));
    }
    place->second = parts.digest();
  }
  return place->second;
}

std::string Keys::of(const Unit& unit) {
  Parts parts;
  for (const std::string_view part :
       {schema, std::string_view(version_), name_of(unit.command), std::string_view(unit.machine),
        std::string_view(unit.when), std::string_view(digest_of_all(unit.diagram, named_.by_diagram))}) {
    parts.add(part);
  }
  if (needs_parameters(unit.command)) {
    parts.add(digest_of_all(unit.parameters, named_.by_parameters));
    parts.add(digest(unit.log));
  }
  if (unit.command == Command::Diagnose) {
    for (const std::string& option : options_) {
      parts.add(option);
    }
  }
  return parts.digest();
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
                                    {"command", name_of(unit.command)},
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
    const auto* const status = std::ranges::find(names, json.at("status").get<std::string>());
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
