// What a fit says: as text, as a page with pictures, and the residuals as a record.
#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "diagnosis/noise/noise_floor.hpp"
#include "support/atomic_file.hpp"
#include "tuning/output_error.hpp"

namespace hysteron::tool {

struct TuneReport {
  const OutputErrorProblem& problem;
  const OutputErrorFit& fit;
  std::string diagnose_command{};               ///< what looks for the cause of what is left; empty: none is named
  std::vector<diagnosis::NoiseFloor> floors{};  ///< by measured output
};

[[nodiscard]] std::string as_text(const TuneReport& report);
/// The fit as fit_json has it, and what is not in the model.
[[nodiscard]] nlohmann::json as_json(const TuneReport& report);

/// The names of the files of a report in a folder: report.html, report.json and residuals.csv, residuals-2.csv … for
/// further records.
[[nodiscard]] std::vector<std::filesystem::path> report_paths(const std::filesystem::path& folder, std::size_t records);

/// The files of these names.
[[nodiscard]] std::vector<OutputFile> report_files(const std::filesystem::path& folder, const TuneReport& report);

}  // namespace hysteron::tool
