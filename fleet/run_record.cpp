#include "fleet/run_record.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <string_view>
#include <system_error>

#include "fleet/when.hpp"
#include "support/atomic_file.hpp"
#include "support/diagnostic.hpp"
#include "support/sha256.hpp"
#include "support/text_file.hpp"

namespace hysteron::fleet {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr std::string_view run_schema = "hysteron-fleet-run/1";

std::string now() {
  const auto since = std::chrono::system_clock::now().time_since_epoch();
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(since);
  const auto rest = std::chrono::duration_cast<std::chrono::microseconds>(since - seconds);
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:06}Z", fmt::gmtime(static_cast<std::time_t>(seconds.count())),
                     rest.count());
}

std::string text_of(const Json& json) {
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Run run_of(const Json& json) {
  Run run{.id = json.at("id"),
          .manifest = json.at("manifest"),
          .version = json.at("version"),
          .options = json.at("options"),
          .last = json.at("last")};
  for (const Json& one : json.at("units")) {
    Unit unit{.machine = one.at("machine"),
              .when = one.at("when"),
              .group = one.at("group"),
              .diagram = one.at("diagram"),
              .parameters = one.at("params"),
              .log = one.at("log"),
              .line = one.at("line")};
    unit.time = seconds_of(unit.when).value_or(not_a_number);
    unit.command = command_named(one.at("command").get<std::string>()).value_or(Command::Diagnose);
    run.units.push_back(std::move(unit));
    run.keys.push_back(one.at("key"));
  }
  return run;
}

}  // namespace

void write_run(const fs::path& output, Run run) {
  Json json{{"schema", run_schema}, {"manifest", run.manifest}, {"version", run.version}, {"options", run.options}};
  json["units"] = Json::array();
  for (std::size_t i = 0; i < run.units.size(); ++i) {
    const Unit& unit = run.units[i];
    json["units"].push_back({{"key", run.keys[i]},
                             {"machine", unit.machine},
                             {"when", unit.when},
                             {"group", unit.group},
                             {"command", name_of(unit.command)},
                             {"diagram", unit.diagram},
                             {"params", unit.parameters},
                             {"log", unit.log},
                             {"line", unit.line}});
  }
  const std::string id = sha256(text_of(json)).substr(0, 16);
  json["id"] = id;
  json["last"] = now();
  write_file_atomically(output / "runs" / (id + ".json"), text_of(json));
}

std::vector<Run> read_runs(const fs::path& output) {
  std::vector<Run> runs;
  std::error_code missing;
  for (const auto& entry : fs::directory_iterator(output / "runs", missing)) {
    try {
      const Json json = Json::parse(read_text_file(entry.path().string()));
      // A writer that was killed leaves its temporary beside the file.
      if (json.at("schema").get<std::string>() == run_schema &&
          entry.path().filename() == json.at("id").get<std::string>() + ".json") {
        runs.push_back(run_of(json));
      }
    } catch (const InputError&) {                 // gone in between
    } catch (const nlohmann::json::exception&) {  // no file of ours
    }
  }
  std::ranges::sort(runs, {}, [](const Run& run) { return std::pair(run.last, run.id); });
  return runs;
}

}  // namespace hysteron::fleet
