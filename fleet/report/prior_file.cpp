#include "fleet/report/prior_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "fleet/report/analysis.hpp"
#include "support/diagnostic.hpp"
#include "support/errors.hpp"
#include "support/sha256.hpp"
#include "support/text_file.hpp"

namespace hysteron::fleet {

std::string prior_json(const std::vector<Row>& rows, const std::string& group, const std::string& folder) {
  using Json = nlohmann::ordered_json;
  std::map<std::string, std::vector<const Row*>> groups;
  for (const Row& row : rows) {
    if (row.unit.command == Command::Diagnose && row.result.status == Status::Done) {
      groups[kind_of(row.unit).group].push_back(&row);
    }
  }
  if (groups.empty()) {
    throw InputError(error::bad_usage, {.file = folder}, "No record of the fleet was diagnosed.",
                     "let `hysteron fleet` diagnose some first.");
  }
  if (group.empty() ? groups.size() > 1 : !groups.contains(group)) {
    std::string names;
    for (const auto& [name, records] : groups) {
      names += (names.empty() ? "" : ", ") + name;
    }
    throw InputError(error::bad_usage, {.file = folder},
                     group.empty() ? "The fleet has several groups, and a prior is of one."
                                   : fmt::format("The fleet has no group {}.", group),
                     fmt::format("say --group with one of {}.", names));
  }
  const auto& [name, diagnosed] = group.empty() ? *groups.begin() : *groups.find(group);
  std::map<std::string, Json> machines;
  for (const Row* const row : diagnosed) {
    Json families = Json::object();
    for (const auto& [family, probability] : row->outcome.families) {
      if (std::isfinite(probability)) {
        families[family] = probability;
      }
    }
    machines.try_emplace(row->unit.machine, Json::array())
        .first->second.push_back({{"log", sha256(read_text_file(row->unit.log))}, {"families", std::move(families)}});
  }
  Json list = Json::array();
  for (auto& [machine, records] : machines) {
    list.push_back({{"machine", machine}, {"records", std::move(records)}});
  }
  const Json result = {{"schema", "hysteron-prior/1"}, {"group", name}, {"machines", std::move(list)}};
  return result.dump(2) + "\n";
}

}  // namespace hysteron::fleet
