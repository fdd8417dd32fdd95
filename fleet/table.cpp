#include "fleet/table.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "fleet/claim.hpp"
#include "support/atomic_file.hpp"
#include "support/diagnostic.hpp"
#include "support/numbers.hpp"
#include "support/text_file.hpp"

namespace hysteron::fleet {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

double number_of(const nlohmann::json& value) {
  return value.is_number() ? value.get<double>() : not_a_number;
}

void read_verdict(Row& row, const fs::path& file) {
  row.confidence = row.nominal_rms = row.improved_rms = not_a_number;
  if (row.result.status != Status::Done) {
    return;
  }
  try {
    const auto json = nlohmann::json::parse(read_text_file(file.string()));
    row.verdict = json.at("verdict").get<std::string>();
    for (const auto& effect : json.at("effects")) {
      row.effects += fmt::format("{}{} at {}", row.effects.empty() ? "" : " + ", effect.at("id").get<std::string>(),
                                 effect.at("edge").get<std::string>());
    }
    row.confidence = number_of(json.at("confidence"));
    row.nominal_rms = number_of(json.at("gap").at("nominal_rms"));
    row.improved_rms = number_of(json.at("gap").at("improved_rms"));
    row.unit_of_gap = json.at("gap").at("unit").get<std::string>();
  } catch (const InputError& problem) {
    row.result = {.status = Status::Failed, .reason = problem.what()};
  } catch (const nlohmann::json::exception&) {
    row.result = {.status = Status::Failed, .reason = "its verdict.json was changed; run it again with --retry."};
  }
}

std::string cell(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) {
    return std::string(text);
  }
  std::string quoted = "\"";
  for (const char letter : text) {
    quoted += letter == '"' ? "\"\"" : std::string(1, letter);
  }
  return quoted + '"';
}

std::string cell(double value) {
  return std::isfinite(value) ? number_text(value) : "";
}

ordered_json json_of(double value) {
  return std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr);
}

}  // namespace

std::vector<Row> rows_of(const std::vector<Unit>& units, const std::vector<std::string>& keys, const fs::path& output) {
  std::vector<Row> rows;
  for (std::size_t i = 0; i < units.size(); ++i) {
    const fs::path folder = folder_of(output, keys[i]);
    Row row{.unit = units[i], .key = keys[i], .result = read_result(folder)};
    read_verdict(row, folder / "verdict.json");
    rows.push_back(std::move(row));
  }
  return rows;
}

std::array<std::size_t, 4> counts_of(const std::vector<Row>& rows) {
  std::array<std::size_t, 4> counts{};
  for (const Row& row : rows) {
    ++counts.at(static_cast<std::size_t>(row.result.status));
  }
  return counts;
}

std::string table_csv(const std::vector<Row>& rows) {
  std::string text =
      "machine,when,group,status,verdict,effects,confidence,nominal_rms,improved_rms,unit,reason,folder\n";
  for (const Row& row : rows) {
    text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{}\n", cell(row.unit.machine), cell(row.unit.when),
                        cell(row.unit.group), name_of(row.result.status), row.verdict, cell(row.effects),
                        cell(row.confidence), cell(row.nominal_rms), cell(row.improved_rms), cell(row.unit_of_gap),
                        cell(row.result.reason), folder_of("", row.key).string());
  }
  return text;
}

std::string table_json(const std::vector<Row>& rows, const std::string& version) {
  const auto counts = counts_of(rows);
  ordered_json json{{"schema", "hysteron-fleet/1"}, {"version", version}};
  for (std::size_t i = 0; i < counts.size(); ++i) {
    json["counts"][std::string(name_of(static_cast<Status>(i)))] = counts.at(i);
  }
  json["units"] = ordered_json::array();
  for (const Row& row : rows) {
    json["units"].push_back({{"machine", row.unit.machine},
                             {"when", row.unit.when},
                             {"group", row.unit.group},
                             {"status", name_of(row.result.status)},
                             {"verdict", row.verdict},
                             {"effects", row.effects},
                             {"confidence", json_of(row.confidence)},
                             {"nominal_rms", json_of(row.nominal_rms)},
                             {"improved_rms", json_of(row.improved_rms)},
                             {"unit", row.unit_of_gap},
                             {"reason", row.result.reason},
                             {"seconds", json_of(row.result.seconds)},
                             {"folder", folder_of("", row.key).string()}});
  }
  return json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

std::vector<Row> write_table(const std::vector<Unit>& units, const std::vector<std::string>& keys,
                             const fs::path& output) {
  const Claim alone = Claim::waited_for(output / "claims" / "results");
  auto rows = rows_of(units, keys, output);
  write_file_atomically(output / "results.csv", table_csv(rows));
  return rows;
}

}  // namespace hysteron::fleet
