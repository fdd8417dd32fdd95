// Structured Text against the interpreter through outside compilers: MATIEC, where HYSTERON_MATIEC names its folder,
// and STruC++, where HYSTERON_STRUCPP does. HYSTERON_OUTSIDE_DIAGRAMS says how many random diagrams are tried.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "codegen/backends/cpp/cpp.hpp"
#include "codegen/backends/st/c_names.hpp"
#include "codegen/backends/st/st.hpp"
#include "tests/codegen/backends/recorded_run.hpp"
#include "tests/codegen/random_program.hpp"
#include "tests/support/scratch_folder.hpp"

namespace hysteron::testing {
namespace {

constexpr std::size_t outside_steps = 400;  // the host resets in the middle

constexpr std::string_view matiec_host_head = R"(#include <stdio.h>
#include "iec_std_lib.h"
#include "accessor.h"
#include "POUS.h"
TIME __CURRENT_TIME;
BOOL __DEBUG;
#include "POUS.c"
#define RUN(BLOCK, NUMBER) { \
  static BLOCK block; \
  BLOCK##_init__(&block, 0); \
  char name[500]; \
  snprintf(name, sizeof(name), "%s/in%d", folder, NUMBER); \
  FILE* in = fopen(name, "rb"); \
  snprintf(name, sizeof(name), "%s/out%d", folder, NUMBER); \
  FILE* out = fopen(name, "wb"); \
  int step = 0; \
  for (double row[6]; fread(row, sizeof(row), 1, in) == 1; ++step) { \
    block.RESET.value = step == 200; \
    block.X1.value = row[0]; block.X2.value = row[1]; block.X3.value = row[2]; \
    block.B1.value = row[3] != 0; block.B2.value = row[4] != 0; block.N1.value = (DINT)row[5]; \
    BLOCK##_body__(&block); \
    const double results[6] = {block.Y0.value, block.Y1.value, block.Y2.value, block.Y3.value, \
                               block.Q.value, block.N.value}; \
    fwrite(results, sizeof(results), 1, out); \
  } \
  fclose(in); \
  fclose(out); }
int main(int argc, char** argv) {
  const char* folder = argv[argc - 1];
)";

constexpr std::string_view strucpp_host_head = R"(#include <cstdio>
#include "all.hpp"
using namespace strucpp;
template <class Block> void run(const char* folder, int number) {
  static Block block;
  char name[500];
  std::snprintf(name, sizeof(name), "%s/in%d", folder, number);
  std::FILE* in = std::fopen(name, "rb");
  std::snprintf(name, sizeof(name), "%s/out%d", folder, number);
  std::FILE* out = std::fopen(name, "wb");
  int step = 0;
  for (double row[6]; std::fread(row, sizeof(row), 1, in) == 1; ++step) {
    block.RESET = step == 200;
    block.X1 = row[0]; block.X2 = row[1]; block.X3 = row[2];
    block.B1 = row[3] != 0; block.B2 = row[4] != 0; block.N1 = int(row[5]);
    block();
    const double results[6] = {double(block.Y0), double(block.Y1), double(block.Y2), double(block.Y3),
                               double(bool(block.Q)), double(int(block.N))};
    std::fwrite(results, sizeof(results), 1, out);
  }
  std::fclose(in);
  std::fclose(out);
}
#define RUN(BLOCK, NUMBER) run<BLOCK>(folder, NUMBER);
int main(int argc, char** argv) {
  const char* folder = argv[argc - 1];
)";

struct OutsideCompiler {
  std::string_view name;
  std::string_view variable;  ///< of the environment: names its folder
  std::string_view host_name;
  std::string_view host;
  std::string_view build;  ///< {0}: the folder of the test, {1}: the compiler's, {2}: flags
};

constexpr OutsideCompiler matiec{"MATIEC", "HYSTERON_MATIEC", "main.c", matiec_host_head,
                                 "cd {0} && {1}/iec2c -I {1}/lib -T {0} all.st > log 2>&1 && cc -O0 -w -fwrapv {2} "
                                 "-I{1}/lib/C -I. main.c -lm -o run "
                                 ">> log 2>&1 && ./run {0}"};
constexpr OutsideCompiler strucpp{
    "STruC++", "HYSTERON_STRUCPP", "main.cpp", strucpp_host_head,
    "cd {0} && node {1}/dist/node/cli.js all.st -o all.cpp > log 2>&1 && c++ -std=c++17 -O0 -w -fwrapv {2} "
    "-I{1}/src/runtime/include -I. all*.cpp main.cpp -o run >> log 2>&1 && ./run {0}"};

/// The blocks and types of a text, each once: diagrams that stand in one file share the library.
class TextsTogether {
 public:
  void add(const std::string& text) {
    for (std::size_t begin = 0; begin < text.size();) {
      std::size_t end = text.size();
      for (const std::string_view last : {"\nEND_FUNCTION_BLOCK\n", "\nEND_TYPE\n"}) {
        const std::size_t found = text.find(last, begin);
        end = std::min(end, found == std::string::npos ? end : found + last.size());
      }
      const std::string unit = text.substr(begin, end - begin);
      if (std::find(units_.begin(), units_.end(), unit) == units_.end()) {
        units_.push_back(unit);
        text_ += unit;
      }
      begin = end;
      while (begin < text.size() && text[begin] == '\n') {
        ++begin;
      }
    }
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::vector<std::string> units_;
  std::string text_;
};

void hold_through(const OutsideCompiler& compiler, std::string_view what,
                  std::vector<GeneratedFile> (*generate)(const Program& program, const StOptions& options)) {
  const char* const its_folder = std::getenv(std::string(compiler.variable).c_str());
  if (its_folder == nullptr) {
    GTEST_SKIP() << compiler.variable << " names no folder of " << compiler.name;
  }
  const char* const wanted = std::getenv("HYSTERON_OUTSIDE_DIAGRAMS");
  const std::size_t diagrams = wanted != nullptr ? std::strtoul(wanted, nullptr, 10) : 20;
  constexpr std::size_t at_once = 20;  // in one file
  std::size_t equal = 0;
  std::size_t finite = 0;
  std::size_t steps = 0;
  for (std::size_t first = 0; first < diagrams; first += at_once) {
    const test::ScratchFolder folder;
    TextsTogether text;
    std::string host(compiler.host);
    std::vector<RecordedRun> runs;
    for (std::size_t i = 0; i < std::min(at_once, diagrams - first); ++i) {
      const std::size_t seed = first + i;
      const Program program = RandomDiagram(seed + 3000, fmt::format("DIAGRAM{}", i), seed % 2 == 0 ? 8 : 30).program();
      runs.push_back(record<double>(program, outside_steps, seed));
      write_doubles(folder / fmt::format("in{}", i), runs.back().inputs);
      text.add(generate(program, {.dialect = *st_dialect("portable")})[0].text);
      host += fmt::format("  RUN(DIAGRAM{0}, {0})\n", i);
    }
    folder.write("all.st", text.text());
    folder.write(std::string(compiler.host_name), host + "  return 0;\n}\n");
    const std::string build =
        fmt::format(fmt::runtime(compiler.build), folder.path().string(), its_folder, cpp_numeric_flags);
    ASSERT_EQ(std::system(build.c_str()), 0) << test::contents_of(folder / "log").substr(0, 3000);
    for (std::size_t i = 0; i < runs.size(); ++i) {
      // MATIEC's ABS leaves -0 as it is.
      const std::size_t same = equal_steps(runs[i], read_doubles(folder / fmt::format("out{}", i)), true);
      EXPECT_GE(same, std::min(runs[i].first_exception, outside_steps)) << "diagram " << first + i;
      equal += same == outside_steps ? 1 : 0;
      finite += runs[i].first_exception > outside_steps ? 1 : 0;
      steps += same;
    }
  }
  std::printf(
      "%s, %s: %zu random diagrams, %zu of them without an exception of arithmetic; %zu equal in all %zu steps; "
      "%zu steps equal\n",
      std::string(compiler.name).c_str(), std::string(what).c_str(), diagrams, finite, equal, outside_steps, steps);
}

/// A diagram whose block, inputs and variables have every name that C knows in capitals, and forms of functions that
/// MATIEC has for each type.
std::string diagram_of_c_names() {
  std::vector<std::string> names{"MAX_TIME", "ADD_INT", "MUX_DINT_REAL", "BCD_TO_UINT", "STATE", "FLOAT"};
  std::istringstream list{std::string(c_names_in_capitals)};
  for (std::string name; list >> name;) {
    names.push_back(name);
  }
  std::string inputs;
  std::string variables;
  std::string sums = "TOTAL_0 := 0.0;\n";
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] != "NULL" && names[i] != "FILE" &&
        names[i] != "M_PI") {  // a word of the language; names that are taken
      (i % 2 == 0 ? inputs : variables) += names[i] + " : LREAL;\n";
      sums += i % 2 == 0 ? "" : fmt::format("{} := SIN(X + {}.0);\n", names[i], i);
      variables += fmt::format("TOTAL_{} : LREAL;\n", i + 1);
      sums += fmt::format("TOTAL_{} := TOTAL_{} + {} * {};\n", i + 1, i, names[i], names[i]);
    } else {
      variables += fmt::format("TOTAL_{} : LREAL;\n", i + 1);
      sums += fmt::format("TOTAL_{} := TOTAL_{};\n", i + 1, i);
    }
  }
  return fmt::format(
      "FUNCTION_BLOCK FILE (* @ts 1ms *)\nVAR_INPUT X : LREAL;\n{}END_VAR\nVAR_OUTPUT M_PI : LREAL; END_VAR\nVAR\n"
      "TOTAL_0 : LREAL;\n{}END_VAR\n{}M_PI := TOTAL_{};\nEND_FUNCTION_BLOCK\n",
      inputs, variables, sums, names.size());
}

void compile_names_that_c_knows(const OutsideCompiler& compiler) {
  const char* const its_folder = std::getenv(std::string(compiler.variable).c_str());
  if (its_folder == nullptr) {
    GTEST_SKIP() << compiler.variable << " names no folder of " << compiler.name;
  }
  const test::ScratchFolder folder;
  folder.write("all.st", generate_st(compile_text(diagram_of_c_names()), {.dialect = *st_dialect("portable")})[0].text);
  folder.write(std::string(compiler.host_name), std::string(compiler.host) + "  (void)folder;\n  return 0;\n}\n");
  const std::string build =
      fmt::format(fmt::runtime(compiler.build), folder.path().string(), its_folder, cpp_numeric_flags);
  EXPECT_EQ(std::system(build.c_str()), 0) << test::contents_of(folder / "log").substr(0, 3000);
}

TEST(StructuredText, ThroughMatiecNamesThatCKnowsCompile) {
  compile_names_that_c_knows(matiec);
}
TEST(StructuredText, ThroughStrucppNamesThatCKnowsCompile) {
  compile_names_that_c_knows(strucpp);
}
TEST(StructuredText, ThroughMatiecRandomProgramsHaveTheBitsOfTheInterpreter) {
  hold_through(matiec, "one block", generate_st);
}
TEST(StructuredText, ThroughStrucppRandomProgramsHaveTheBitsOfTheInterpreter) {
  hold_through(strucpp, "one block", generate_st);
}
TEST(StructuredText, ThroughMatiecRandomProgramsOfCallsHaveTheBitsOfTheInterpreter) {
  hold_through(matiec, "calls of the library", generate_st_structured);
}

}  // namespace
}  // namespace hysteron::testing
