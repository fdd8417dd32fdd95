// What a tuning for a goal says: as text, as a page with pictures, and the responses as records.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "support/atomic_file.hpp"
#include "tuning/goal/goal_search.hpp"

namespace hysteron::tool {

/// Parameters, figures of each plant before and after, limits, and how the search ended.
[[nodiscard]] std::string goal_text(const GoalProblem& problem, const GoalResult& result);

/// The names of the files of a report in a folder: report.html, report.json and response.csv, response-2.csv … for
/// further plants.
[[nodiscard]] std::vector<std::filesystem::path> goal_report_paths(const std::filesystem::path& folder,
                                                                   std::size_t plants);

/// The files of these names.
[[nodiscard]] std::vector<OutputFile> goal_report_files(const std::filesystem::path& folder, const GoalProblem& problem,
                                                        const GoalResult& result);

}  // namespace hysteron::tool
