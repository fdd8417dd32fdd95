// A test case made ready to run: the diagram compiled, inputs and expectations laid out over the steps.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "codegen/compile.hpp"
#include "support/diagnostic.hpp"
#include "tool/test_file.hpp"
#include "tuning/simulation.hpp"

namespace hysteron::tool {

struct ExpectedOutput {
  std::size_t output = 0;
  ValuesByStep values{};
  Place place{};  ///< of the values in the test file
};

struct PlannedCase {
  TestCase test{};
  const Program* diagram = nullptr;  ///< without the parameters of the case; it lives as long as the planner
  Program program{};
  Drive drive{};
  std::vector<double> time{};
  std::vector<ExpectedOutput> expected{};
  std::filesystem::path golden{};                            ///< empty: none
  std::vector<std::pair<std::string, std::string>> notes{};  ///< what was understood of its record: file, sentence
};

/// Plans the cases of one file. The diagram is compiled once for each top block. Files that a case names are looked for
/// beside the test file.
class TestPlanner {
 public:
  TestPlanner(std::string diagram, std::filesystem::path folder)
      : diagram_(std::move(diagram)), folder_(std::move(folder)) {}

  /// Reports what keeps a case from being run; it is then not to be used.
  [[nodiscard]] PlannedCase plan(const TestCase& test, Diagnostics& diagnostics);

 private:
  const Program* program_of(const TestCase& test, Diagnostics& diagnostics);

  std::string diagram_;
  std::filesystem::path folder_;
  std::map<std::string, Program> programs_;  ///< by top block, in capitals
};

}  // namespace hysteron::tool
