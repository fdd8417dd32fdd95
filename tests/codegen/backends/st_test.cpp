// Structured Text against the interpreter: random programs, translated to C++ token by token and compiled.
#include "codegen/backends/st/st.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "codegen/backends/cpp/cpp.hpp"
#include "tests/codegen/backends/recorded_run.hpp"
#include "tests/codegen/backends/st_as_cpp.hpp"
#include "tests/codegen/random_body.hpp"
#include "tests/codegen/random_program.hpp"
#include "tests/support/scratch_folder.hpp"

namespace hysteron::testing {
namespace {

constexpr std::size_t st_programs = 40;
constexpr std::size_t st_steps = 400;

template <class Real>
void hold_st_against_interpreted() {
  const test::ScratchFolder folder;
  const auto at = [&](const std::string& name) { return (folder.path() / name).string(); };
  std::string text(st_prelude);
  std::string calls;
  std::vector<RecordedRun> runs;
  for (std::size_t i = 0; i < st_programs; ++i) {
    const RandomDiagram diagram(i + 1000 * sizeof(Real) + 7, fmt::format("P{}", i), i % 2 == 0 ? 8 : 30);
    const std::uint64_t seed = i + 5500 + sizeof(Real);
    const Program program = i % 4 == 3 ? RandomBody(seed, fmt::format("P{}", i), 10).program() : diagram.program();
    runs.push_back(record<Real>(program, st_steps, i));
    write_doubles(at(fmt::format("in{}", i)), runs.back().inputs);
    text += StAsCpp(generate_st(program, {.dialect = *st_dialect("portable"), .float32 = sizeof(Real) == 4})[0].text)
                .translated();
    calls += fmt::format("  run<P{0}>(argv[1], {0});\n", i);
  }
  text += fmt::format(R"(using Real = {};
template <class Block>
void run(const char* folder, int number) {{
  const auto made = std::make_unique<Block>();  // a static one is left 0 where -frounding-math rounds a REAL
  Block& block = *made;
  char name[500];
  std::snprintf(name, sizeof(name), "%s/in%d", folder, number);
  std::FILE* in = std::fopen(name, "rb");
  std::snprintf(name, sizeof(name), "%s/out%d", folder, number);
  std::FILE* out = std::fopen(name, "wb");
  int step = 0;
  for (double row[6]; std::fread(row, sizeof(row), 1, in) == 1; ++step) {{
    block.RESET = step == {};
    block.X1 = static_cast<Real>(row[0]);
    block.X2 = static_cast<Real>(row[1]);
    block.X3 = static_cast<Real>(row[2]);
    block.B1 = row[3] != 0;
    block.B2 = row[4] != 0;
    block.N1 = static_cast<DINT>(row[5]);
    block.call();
    const double results[6] = {{block.Y0, block.Y1, block.Y2, block.Y3, double(block.Q), double(block.N)}};
    std::fwrite(results, sizeof(results), 1, out);
  }}
  std::fclose(in);
  std::fclose(out);
}}
int main(int, char** argv) {{
  feenableexcept(FE_DIVBYZERO);  // as on a PLC that a division by 0 stops
{}}}
)",
                      sizeof(Real) == 4 ? "float" : "double", st_steps / 2, calls);
  std::ofstream(at("main.cpp")) << text;
  // -fwrapv: DINT wraps at its ends, as in a PLC.
  const std::string compile = fmt::format("c++ -std=c++20 -O1 -w -fwrapv {} {} -o {} 2> {}", cpp_numeric_flags,
                                          at("main.cpp"), at("run"), at("log"));
  ASSERT_EQ(std::system(compile.c_str()), 0) << test::contents_of(folder.path() / "log").substr(0, 2000);
  ASSERT_EQ(std::system(fmt::format("{} {}", at("run"), folder.path().string()).c_str()), 0);
  std::size_t equal = 0;
  for (std::size_t i = 0; i < st_programs; ++i) {
    const std::size_t same = equal_steps(runs[i], read_doubles(at(fmt::format("out{}", i))));
    equal += same == st_steps ? 1 : 0;
    EXPECT_GE(same, std::min(runs[i].first_exception, st_steps))
        << "program " << i << ", with exceptions from " << runs[i].first_exception;
  }
  // Where the interpreter met an infinity, a block may differ from there on; that must stay the lesser part.
  EXPECT_GE(equal, st_programs / 2);
}

TEST(StructuredText, RandomProgramsHaveTheBitsOfTheInterpreter) {
  hold_st_against_interpreted<double>();
}
TEST(StructuredText, RandomProgramsHaveTheBitsOfTheInterpreterInReal) {
  hold_st_against_interpreted<float>();
}

}  // namespace
}  // namespace hysteron::testing
