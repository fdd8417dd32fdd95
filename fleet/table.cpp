#include "fleet/table.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "fleet/claim.hpp"
#include "fleet/store.hpp"
#include "support/atomic_file.hpp"
#include "support/csv_cell.hpp"
#include "support/diagnostic.hpp"
#include "support/json_number.hpp"
#include "support/numbers.hpp"
#include "support/text_file.hpp"

namespace hysteron::fleet {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

void read_product(Row& row, const fs::path& folder) {
  if (row.result.status != Status::Done) {
    return;
  }
  try {
    row.outcome = read_outcome(row.unit.command, folder);
  } catch (const InputError& problem) {
    row.result = {.status = Status::Failed, .reason = problem.what()};
  } catch (const nlohmann::json::exception&) {
    row.result = {
        .status = Status::Failed,
        .reason = fmt::format("its {} was changed; run it again with --retry.", product_of(row.unit.command))};
  }
}

}  // namespace

std::string number_cell(double value) {
  return std::isfinite(value) ? number_text(value) : "";
}

std::vector<Row> rows_of(const std::vector<Unit>& units, const std::vector<std::string>& keys, const fs::path& output) {
  std::vector<Row> rows;
  for (std::size_t i = 0; i < units.size(); ++i) {
    const fs::path folder = folder_of(output, keys[i]);
    Row row{.unit = units[i], .key = keys[i], .result = read_result(folder)};
    read_product(row, folder);
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
      "machine,when,group,command,status,verdict,effects,confidence,nominal_rms,improved_rms,unit,reason,folder\n";
  for (const Row& row : rows) {
    text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{}\n", csv_cell(row.unit.machine), csv_cell(row.unit.when),
                        csv_cell(row.unit.group), name_of(row.unit.command), name_of(row.result.status),
                        csv_cell(row.outcome.verdict), csv_cell(effects_text(row.outcome)),
                        number_cell(row.outcome.confidence), number_cell(row.outcome.nominal_rms),
                        number_cell(row.outcome.improved_rms), csv_cell(row.outcome.unit_of_gap),
                        csv_cell(row.result.reason), folder_of("", row.key).string());
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
                             {"command", name_of(row.unit.command)},
                             {"status", name_of(row.result.status)},
                             {"verdict", row.outcome.verdict},
                             {"effects", effects_text(row.outcome)},
                             {"confidence", number_or_null<ordered_json>(row.outcome.confidence)},
                             {"nominal_rms", number_or_null<ordered_json>(row.outcome.nominal_rms)},
                             {"improved_rms", number_or_null<ordered_json>(row.outcome.improved_rms)},
                             {"unit", row.outcome.unit_of_gap},
                             {"reason", row.result.reason},
                             {"seconds", number_or_null<ordered_json>(row.result.seconds)},
                             {"folder", folder_of("", row.key).string()}});
  }
  return json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

std::vector<Row> write_table(const std::vector<Unit>& units, const std::vector<std::string>& keys,
                             const fs::path& output) {
  const Claim alone = Claim::waited_for(output / "claims" / "results");
  auto rows = rows_of(units, keys, output);
  write_file_atomically(output / "results.csv", table_csv(rows));
  write_store(output, rows);
  return rows;
}

}  // namespace hysteron::fleet
