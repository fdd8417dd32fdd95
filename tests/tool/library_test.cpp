// The tests beside the library's diagrams: every block of the catalogue stands in one of them, and what comes out of it
// is held against what a case expects.
#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "codegen/compile.hpp"
#include "codegen/trace/sized_block.hpp"
#include "support/diagnostic.hpp"
#include "tool/test_file.hpp"
#include "tool/test_plan.hpp"

namespace hysteron::tool {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> library_diagrams() {
  std::vector<fs::path> diagrams;
  for (const auto& entry : fs::directory_iterator(fs::path(HYSTERON_SOURCE_DIR) / "tests" / "library")) {
    if (entry.path().extension() == ".st") {
      diagrams.push_back(entry.path());
    }
  }
  return diagrams;
}

/// The blocks on which the expected outputs of a case depend; others in the diagram could do what they like.
std::set<std::string_view> exercised_by(const PlannedCase& planned) {
  const Graph& graph = planned.program.graph;
  std::vector<Wire> open;
  for (const ExpectedOutput& expected : planned.expected) {
    open.push_back(graph.outputs[expected.output].wire);
  }
  std::set<std::uint32_t> seen;
  std::set<std::string_view> blocks;
  while (!open.empty()) {
    const Wire wire = open.back();
    open.pop_back();
    if (wire.from != Wire::From::Node || !seen.insert(wire.index).second) {
      continue;
    }
    const Node& node = graph.nodes[wire.index];
    if (node.block != nullptr) {
      blocks.insert(node.block->about.name);
    }
    for (std::size_t pin = 0; pin < node.wire_count; ++pin) {
      open.push_back(graph.wire(node, pin));
    }
  }
  return blocks;
}

TEST(Library, EveryBlockIsExercisedByACaseBesideItsDiagrams) {
  std::set<std::string_view> exercised;
  for (const fs::path& diagram : library_diagrams()) {
    auto tests = diagram;
    const TestFile file = read_test_file(tests.replace_extension(".test.toml").string());
    TestPlanner planner(diagram.string(), diagram.parent_path());
    for (const TestCase& test : file.cases) {
      Diagnostics diagnostics;
      const PlannedCase planned = planner.plan(test, diagnostics);
      ASSERT_FALSE(diagnostics.has_errors()) << file.path << ": " << test.name;
      exercised.merge(exercised_by(planned));
    }
  }
  for (const BlockType* const block : documented_blocks()) {
    EXPECT_TRUE(exercised.contains(block->about.name))
        << block->about.name << ": no case in tests/library expects what comes out of it";
  }
}

}  // namespace
}  // namespace hysteron::tool
