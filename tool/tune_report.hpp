// What a fit says: as text, as JSON, as a page with pictures, and the residuals as a record.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "tuning/output_error.hpp"

namespace hysteron::tool {

struct TuneReport {
  const OutputErrorProblem& problem;
  const OutputErrorFit& fit;
};

[[nodiscard]] std::string as_text(const TuneReport& report);
[[nodiscard]] nlohmann::json as_json(const TuneReport& report);

/// Writes report.html, report.json and residuals.csv (residuals-2.csv … for further records) into a folder, which is
/// made. Throws InputError HY700.
void write_report(const std::filesystem::path& folder, const TuneReport& report);

}  // namespace hysteron::tool
