// What a fit found, for programs: report.json, `tune --json` and the API.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "tuning/output_error.hpp"

namespace hysteron {

/// What is not known is null: JSON has no infinities. The schema: docs/reference/schemas/fit.json.
[[nodiscard]] nlohmann::json fit_json(const OutputErrorProblem& problem, const OutputErrorFit& fit);

}  // namespace hysteron
