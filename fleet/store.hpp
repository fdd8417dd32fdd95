// The results of a fleet as a file of SQLite, for questions across machines and nights.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "fleet/table.hpp"

namespace hysteron::fleet {

inline constexpr int store_version = 1;  ///< PRAGMA user_version; docs/reference/fleet-database.md

/// Writes `fleet.sqlite` of all runs that the folder knows and of the units that they name. `known` are rows that were
/// read already. The file is made in `work/` and renamed into its place, so that a kill leaves the one before; what is
/// in it is derived, and one of the same folders has the same rows. The caller holds the claim on the results. Throws
/// InputError HY700.
void write_store(const std::filesystem::path& output, const std::vector<Row>& known);

}  // namespace hysteron::fleet
