// The report of a fleet for programs: JSON and CSV.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "fleet/report/analysis.hpp"

namespace hysteron::fleet {

/// Its schema is in docs/reference/schemas/fleet-report.json.
[[nodiscard]] std::string report_json(const Analysis& all, const std::vector<Row>& rows, std::string_view version);

/// A line for each parameter of each machine.
[[nodiscard]] std::string report_csv(const Analysis& all);

}  // namespace hysteron::fleet
