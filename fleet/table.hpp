// The results of a fleet as one table, derived from the folders of the units at any time.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "fleet/manifest.hpp"
#include "fleet/outcome.hpp"
#include "fleet/result.hpp"

namespace hysteron::fleet {

/// A line of the table: a unit, and what came of it.
struct Row {
  Unit unit{};
  std::string key{};
  Result result{};
  Outcome outcome{};  ///< empty where there is none
};

/// In the order of the manifest.
[[nodiscard]] std::vector<Row> rows_of(const std::vector<Unit>& units, const std::vector<std::string>& keys,
                                       const std::filesystem::path& output);

/// A number in CSV; empty where it is not finite.
[[nodiscard]] std::string number_cell(double value);

/// How many rows have each status, in the order of Status.
[[nodiscard]] std::array<std::size_t, 4> counts_of(const std::vector<Row>& rows);

/// CSV with a header. Its bytes depend on the results alone, not on when or by whom they were made.
[[nodiscard]] std::string table_csv(const std::vector<Row>& rows);

/// The same as JSON, with counts; its schema is in docs/reference/schemas/fleet.json.
[[nodiscard]] std::string table_json(const std::vector<Row>& rows, const std::string& version);

/// Writes results.csv and fleet.sqlite of what lies there now. Of several commands on one folder, none puts an older
/// table over a newer one. Throws InputError HY700. Gives back the rows.
std::vector<Row> write_table(const std::vector<Unit>& units, const std::vector<std::string>& keys,
                             const std::filesystem::path& output);

}  // namespace hysteron::fleet
