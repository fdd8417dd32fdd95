// The report of a fleet: one page of HTML without outside parts.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "fleet/report/analysis.hpp"

namespace hysteron::fleet {

/// `folder` is where the results lie, as seen from the page: links begin with it.
[[nodiscard]] std::string fleet_page(const Analysis& all, const std::vector<Row>& rows,
                                     const std::filesystem::path& folder);

}  // namespace hysteron::fleet
