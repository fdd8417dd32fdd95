// Rows of the table of long counts: what happens to a task on ordinary days, at its start and between its starts.
#pragma once

#include <vector>

#include "tests/soak/rows.hpp"

namespace hysteron::soak {

[[nodiscard]] std::vector<Row> ordinary_days();

}  // namespace hysteron::soak
