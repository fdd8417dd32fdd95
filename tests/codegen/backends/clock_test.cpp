// TIME() across the end of its 32 bits, 49.7 days, in the interpreter and in generated code.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include "codegen/backends/c/c.hpp"
#include "codegen/backends/cpp/cpp.hpp"
#include "codegen/backends/st/st.hpp"
#include "codegen/interpreter/machine.hpp"
#include "tests/support/scratch_folder.hpp"

namespace hysteron::testing {
namespace {

constexpr double clock_period = 3000.0;        // s
constexpr std::size_t clock_start = 1430;      // a step before the 32 bits of milliseconds end, in step 1431.7
constexpr std::size_t clock_steps = 5 * 1432;  // five rounds of them

/// A waiting time by TIME(), the same by a number of 32 bits, and TIME() itself.
const std::string clock_text = fmt::format(R"(FUNCTION_BLOCK WAIT  (* @ts {}s @body *)
VAR_OUTPUT PASSED, NOW : TIME; OVER, OVER_BY_NUMBER : BOOL; MS : DWORD; END_VAR
VAR N : DINT; START : TIME; BEGUN : UDINT; END_VAR
  IF N = {} THEN START := TIME(); BEGUN := TIME_TO_UDINT(TIME()); END_IF;
  PASSED := TIME() - START;
  NOW := TIME();
  OVER := TIME() - START >= T#9000s;
  OVER_BY_NUMBER := TIME_TO_UDINT(TIME()) - BEGUN >= UDINT#9000000;
  MS := TIME_TO_DWORD(TIME());
  N := N + 1;
END_FUNCTION_BLOCK
)",
                                           clock_period, clock_start);

std::vector<double> clock_run(const Program& program) {
  std::vector<double> values;
  Machine<double> machine(program, clock_period);
  for (std::size_t k = 0; k < clock_steps; ++k) {
    machine.step();
    for (std::size_t i = 0; i < program.graph.outputs.size(); ++i) {
      values.push_back(machine.output(i));
    }
  }
  return values;
}

TEST(Clock, ATimeGoesOnAcrossTheEndOfItsBits) {
  const std::vector<double> run = clock_run(compile_text(clock_text));
  for (std::size_t k = clock_start; k < clock_steps; ++k) {
    const double passed = static_cast<double>(k - clock_start) * clock_period;
    const double* const row = &run[5 * k];
    ASSERT_EQ(row[0], passed) << "step " << k;
    ASSERT_EQ(row[1], static_cast<double>(k) * clock_period) << "step " << k;
    ASSERT_EQ(row[2] != 0.0, passed >= 9000.0) << "step " << k;
    // A number of 32 bits begins anew, and its difference with it: as in a PLC, up to 49.7 days.
    const auto ms = static_cast<std::uint32_t>(static_cast<std::uint64_t>(k) * 3'000'000U);
    ASSERT_EQ(row[4], static_cast<double>(static_cast<std::int32_t>(ms))) << "step " << k;
    const auto since = static_cast<std::uint32_t>(static_cast<std::uint64_t>(k - clock_start) * 3'000'000U);
    ASSERT_EQ(row[3] != 0.0, since >= 9'000'000U) << "step " << k;
  }
}

TEST(Clock, GeneratedCodeGoesOnTheSameWay) {
  const Program program = compile_text(clock_text);
  const std::vector<double> wanted = clock_run(program);
  EXPECT_EQ(clock_run(compile_text(generate_st(program, {.dialect = *st_dialect("portable")}).front().text)), wanted);

  const test::ScratchFolder folder;
  for (const GeneratedFile& file : generate_c(program)) {
    folder.write(file.name, file.text);
  }
  folder.write("main.c", fmt::format(R"(#include "wait.h"
#include <stdio.h>
int main(void) {{
  wait_params params; wait_state state; wait_in in; wait_out out;
  wait_defaults(&params, &in);
  wait_reset(&state, &params);
  for (int k = 0; k < {}; ++k) {{
    wait_step(&params, &state, &in, &out);
    printf("%.17g %.17g %d %d %ld\n", out.passed, out.now, out.over, out.over_by_number, (long)out.ms);
  }}
  return 0;
}}
)",
                                     clock_steps));
  const std::string build = fmt::format("cd {} && cc -std=c99 {} main.c wait*.c -o run -lm > log 2>&1 && ./run > out",
                                        folder.path().string(), cpp_numeric_flags);
  ASSERT_EQ(std::system(build.c_str()), 0) << test::contents_of(folder / "log");
  std::istringstream out(test::contents_of(folder / "out"));
  std::vector<double> got;
  for (double value = 0.0; out >> value;) {
    got.push_back(value);
  }
  EXPECT_EQ(got, wanted);
}

}  // namespace
}  // namespace hysteron::testing
