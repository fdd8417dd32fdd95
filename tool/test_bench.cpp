#include "tool/test_bench.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "codegen/backends/st/bench.hpp"
#include "support/errors.hpp"
#include "tool/test_judge.hpp"

namespace hysteron::tool {
namespace {

namespace fs = std::filesystem;

/// What is wrong with a golden record is said as a failure of the test; a bench cannot hold it.
[[noreturn]] void refuse_golden(const PlannedCase& planned, std::string cause) {
  throw InputError(error::unusable_test, planned.test.golden.place,
                   fmt::format("The golden record {} {}.", planned.golden.string(), cause),
                   "write it with `hysteron test --update`, and look it over.");
}

void add_golden(const PlannedCase& planned, std::vector<StExpectation>& expected) {
  std::error_code unknown;
  if (!fs::exists(planned.golden, unknown)) {
    refuse_golden(planned, "is missing");
  }
  const records::Record golden = golden_record(planned);
  if (golden.size() != planned.drive.steps) {
    refuse_golden(planned, fmt::format("has {} rows, the case {} steps", golden.size(), planned.drive.steps));
  }
  const auto& ports = planned.program.graph.outputs;
  for (std::size_t i = 0; i < ports.size(); ++i) {
    const records::Column* const column = golden.find(ports[i].name);
    if (column == nullptr) {
      refuse_golden(planned, fmt::format("has no column {}", ports[i].name));
    }
    expected.push_back({.output = i, .values = golden_values(*column), .place = planned.test.golden.place});
  }
}

}  // namespace

std::vector<GeneratedFile> bench_files(const std::string& diagram, const std::vector<PlannedCase>& cases,
                                       const StDialect& dialect) {
  StBench bench{.name = fs::path(diagram).stem().string() + "_test"};
  for (const PlannedCase& planned : cases) {
    StBenchCase one{.name = planned.test.name,
                    .place = planned.test.place,
                    .diagram = planned.diagram,
                    .program = &planned.program,
                    .float32 = planned.test.float32,
                    .steps = planned.drive.steps,
                    .inputs = planned.drive.inputs,
                    .absolute = planned.test.absolute,
                    .relative = planned.test.relative};
    for (const ExpectedOutput& expected : planned.expected) {
      one.expected.push_back({.output = expected.output, .values = expected.values, .place = expected.place});
    }
    if (!planned.golden.empty()) {
      add_golden(planned, one.expected);
    }
    bench.cases.push_back(std::move(one));
  }
  return generate_st_bench(bench, dialect);
}

}  // namespace hysteron::tool
