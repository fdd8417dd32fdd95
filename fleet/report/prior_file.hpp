// What the records of a fleet say of a machine of the same kind before its own record is looked at.
#pragma once

#include <string>
#include <vector>

#include "fleet/table.hpp"

namespace hysteron::fleet {

/// For each machine of a group, of each record that was diagnosed: its digest, and the probability of each family of
/// effects by that record alone. JSON, which `hysteron diagnose --prior` reads; its schema is in
/// docs/reference/schemas/prior.json. Without a group the fleet has to have one alone. Throws InputError HY730 for a
/// group that is not there or is needed, or where no record was diagnosed; `folder` stands in it.
[[nodiscard]] std::string prior_json(const std::vector<Row>& rows, const std::string& group, const std::string& folder);

}  // namespace hysteron::fleet
