// Speed, held in continuous integration by counting instructions: a time would not repeat, a count does.
//
// Each piece of work of tests/counted runs once under callgrind. Its count per unit may exceed the budget by 3 %; far
// below the budget fails too, so that the table stays true. After a change that makes something faster or, for a good
// reason, slower, write the printed count into the table. What runs lanes is counted on a processor with AVX2.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iostream>
#include <string>

#include "tests/support/scratch_folder.hpp"

namespace hysteron::house {
namespace {

struct Budget {
  const char* work;
  double units;    ///< steps, instances, iterations or fits in the work
  double counted;  ///< instructions a unit
};

constexpr double margin = 0.03;
constexpr double stale = 0.20;

constexpr Budget budgets[] = {
    {"generated_step", 1e4, 302},    // a step of bench/feedforward.st, most of it pow
    {"interpreted_step", 1e4, 582},  // the same
    {"check", 1e4, 51'900},          // an instance: read twice (once for sequential bodies), checked and scheduled
    {"generate", 1e4, 97'200},       // an instance: write its C++, by code that is compiled with -O2
    {"rollout", 1e4, 794},           // a sample of a lag, a play, a resonance and a creep
    {"derivatives", 1e4, 5'670},     // the same, with the derivatives by six parameters
    {"output_error", 4, 14.45e6},    // an iteration of a fit of six parameters to 1000 samples, start and end included
    {"diagnosis", 1, 2.134e9},       // 500 samples, two effects at each edge; glitches are sought for the floors, too
    {"static_fit", 1, 547'000},      // a fit of 200 points
};

bool has_valgrind() {
  return std::system("valgrind --version > /dev/null 2>&1") == 0;
}

/// The instructions inside counted_region and in the threads that it starts. The mathematical library chooses its code
/// by the processor; it is held to the code that every x86-64 has, so that counts repeat from machine to machine.
double count_instructions(const std::string& work) {
  const test::ScratchFolder folder;
  const std::string file = folder / "callgrind.out";
  const std::string command =
      "GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2,-AVX,-FMA,-FMA4,-AVX512F valgrind --tool=callgrind --collect-atstart=no "
      "--toggle-collect=counted_region '--toggle-collect=std::thread::_State_impl*::_M_run*' --callgrind-out-file=" +
      file + " " + HYSTERON_COUNTED + " " + work + " > " + (folder / "log") + " 2>&1";
  if (std::system(command.c_str()) != 0) {
    ADD_FAILURE() << command << "\n" << test::contents_of(folder / "log");
    return 0.0;
  }
  std::ifstream lines(file);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("totals: ")) {
      return std::stod(line.substr(8));
    }
  }
  ADD_FAILURE() << "callgrind wrote no totals";
  return 0.0;
}

/// Says so, or fails in continuous integration, where valgrind is missing.
bool cannot_count() {
  if (has_valgrind()) {
    return false;
  }
  EXPECT_EQ(std::getenv("CI"), nullptr) << "continuous integration needs valgrind: scripts/install-dependencies test";
  return true;
}

class Instructions : public ::testing::TestWithParam<Budget> {};

TEST_P(Instructions, StayWithinTheBudget) {
  if (cannot_count()) {
    GTEST_SKIP() << "valgrind is not installed: scripts/install-dependencies test";
  }
  const Budget& budget = GetParam();
  const double counted = count_instructions(budget.work) / budget.units;
  RecordProperty("instructions", std::to_string(counted));
  std::cout << budget.work << ": " << counted << " instructions a unit, budget " << budget.counted << "\n";
  EXPECT_LE(counted, budget.counted * (1.0 + margin)) << budget.work << " costs more than its budget";
  EXPECT_GE(counted, budget.counted * (1.0 - stale)) << budget.work << " costs much less: lower its budget";
}

INSTANTIATE_TEST_SUITE_P(Budgets, Instructions, ::testing::ValuesIn(budgets),
                         [](const auto& one) { return std::string(one.param.work); });

class Growth : public ::testing::TestWithParam<const char*> {};

TEST_P(Growth, TenTimesTheInstancesCostTenTimesTheInstructions) {
  if (cannot_count()) {
    GTEST_SKIP() << "valgrind is not installed: scripts/install-dependencies test";
  }
  const std::string work = GetParam();
  const double growth = count_instructions(work) / count_instructions(work + "_fewer");
  RecordProperty("growth", std::to_string(growth));
  EXPECT_LE(growth, 11.0) << work << " does not grow linearly with the number of instances";
}

INSTANTIATE_TEST_SUITE_P(Instances, Growth, ::testing::Values("check", "generate"),
                         [](const auto& one) { return std::string(one.param); });

}  // namespace
}  // namespace hysteron::house
