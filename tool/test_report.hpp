// The results of users' tests: for the terminal, and as JUnit XML for a build server.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "plots/figure.hpp"
#include "tool/test_judge.hpp"

namespace hysteron::tool {

struct CaseResult {
  std::string name{};
  double seconds = 0.0;
  std::vector<Failure> failures{};
  std::optional<plots::Figure> figure{};
  std::string note{};  ///< what else was done: a golden record written
};

struct FileResult {
  std::string file{};  ///< the test file
  std::vector<CaseResult> cases{};
};

/// A line for each case; below those that failed, why, with the plots.
[[nodiscard]] std::string report_text(const FileResult& result, bool colour);

/// "3 passed, 1 failed"
[[nodiscard]] std::string closing_line(const std::vector<FileResult>& results);

[[nodiscard]] std::size_t failed_cases(const std::vector<FileResult>& results);

/// The results as JUnit XML, a test suite for each file.
[[nodiscard]] std::string junit_text(const std::vector<FileResult>& results);

}  // namespace hysteron::tool
