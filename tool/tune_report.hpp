// What a fit says: as text, as a page with pictures, and the residuals as a record.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "support/atomic_file.hpp"
#include "tuning/output_error.hpp"

namespace hysteron::tool {

struct TuneReport {
  const OutputErrorProblem& problem;
  const OutputErrorFit& fit;
};

[[nodiscard]] std::string as_text(const TuneReport& report);

/// The names of the files of a report in a folder: report.html, report.json and residuals.csv, residuals-2.csv … for
/// further records.
[[nodiscard]] std::vector<std::filesystem::path> report_paths(const std::filesystem::path& folder, std::size_t records);

/// The files of these names.
[[nodiscard]] std::vector<OutputFile> report_files(const std::filesystem::path& folder, const TuneReport& report);

}  // namespace hysteron::tool
