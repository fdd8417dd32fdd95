// REAL within LREAL code: two numbers that are rounded to 32 bits side by side keep their bits at every level of
// optimisation. GCC 12 makes one vector of both and leaves out the rounding, where nothing stands between.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "codegen/backends/batch/batch.hpp"
#include "codegen/backends/c/c.hpp"
#include "codegen/backends/cpp/cpp.hpp"
#include "codegen/interpreter/machine.hpp"
#include "tests/support/scratch_folder.hpp"

namespace hysteron::testing {
namespace {

/// Two outputs are all that this step stores: a third one would fill another vector, and be right.
constexpr std::string_view pair_of_reals =
    "FUNCTION_BLOCK PAIR (* @ts 1ms @body *)\n"
    "  VAR_INPUT A, B : LREAL; END_VAR\n"
    "  VAR_OUTPUT Y, Z : REAL; END_VAR\n"
    "  Y := LREAL_TO_REAL(A);\n"
    "  Z := LREAL_TO_REAL(B);\n"
    "END_FUNCTION_BLOCK\n";

constexpr std::string_view wanted = "0x1.99999ap-4 0x1.333334p-2\n";  // 0.1 and 0.3 to the nearest of 32 bits

struct Language {
  std::string_view main;
  std::string_view compiler;
  std::string_view source;  ///< of the main
  std::string_view sources;
};

constexpr std::string_view c_main = R"(#include <stdio.h>
#include "pair.h"
int main(void) {
  pair_params params;
  pair_state state;
  pair_in in;
  pair_out out;
  pair_defaults(&params, &in);
  pair_reset(&state, &params);
  in.a = 0.1;
  in.b = 0.3;
  pair_step(&params, &state, &in, &out);
  printf("%a %a\n", out.y, out.z);
  return 0;
}
)";
constexpr std::string_view cpp_main = R"(#include <cstdio>
#include "pair.hpp"
__attribute__((noinline)) void run(const pair::Params& params, pair::State& state, const pair::In& in, pair::Out& out) {
  out = pair::step(params, state, in);
}
int main() {
  pair::Params params;
  pair::State state;
  pair::In in;
  pair::Out out;
  pair::reset(params, state);
  in.a = 0.1;
  in.b = 0.3;
  run(params, state, in, out);
  std::printf("%a %a\n", out.y, out.z);
}
)";
/// Lane 6 and 7: each lane has to be right.
constexpr std::string_view batch_main = R"(#include <cstdio>
#include "pair_batch.hpp"
int main() {
  using namespace pair_batch;
  static Params params;
  static State state;
  static In in;
  static Out out;
  reset(1, &params, &state);
  for (int i = 0; i < 8; ++i) {
    in.a.lane[i] = 0.1;
    in.b.lane[i] = 0.3;
  }
  for (int lanes = lanes_of_processor(); lanes >= 2; lanes /= 2) {
    step(1, &params, &state, &in, &out, lanes);
    for (int i = 0; i < 8; ++i) {
      if (out.y.lane[i] != out.y.lane[0] || out.z.lane[i] != out.z.lane[0]) {
        std::printf("lane %d of %d: ", i, lanes);
      }
    }
  }
  std::printf("%a %a\n", out.y.lane[0], out.z.lane[0]);
}
)";

constexpr std::array languages{
    Language{c_main, "cc -std=c99 -pedantic -Wall -Wextra -Wconversion -Werror", "main.c", "main.c pair.c"},
    Language{cpp_main, "c++ -std=c++11 -Wall -Wextra -Wconversion -Werror", "main.cpp", "main.cpp"},
    Language{batch_main, "c++ -std=c++17 -fno-math-errno -Wno-psabi", "batch.cpp", "batch.cpp"},
};

TEST(Single, TwoSideBySideAreRoundedAtEveryLevelOfOptimisation) {
  const Program program = compile_text(std::string(pair_of_reals));
  Machine<double> machine(program);
  machine.set_input(0, 0.1);
  machine.set_input(1, 0.3);
  machine.step();
  EXPECT_EQ(fmt::format("{:a} {:a}\n", machine.output(0), machine.output(1)), wanted) << "the interpreter";

  const test::ScratchFolder folder;
  for (const auto& files : {generate_c(program), generate_cpp(program), std::vector{generate_batch(program)}}) {
    for (const GeneratedFile& file : files) {
      folder.write(file.name, file.text);
    }
  }
  for (const Language& one : languages) {
    folder.write(one.source, one.main);
    for (const std::string_view level : {"-O0", "-O1", "-O2", "-O3"}) {
      const std::string build =
          fmt::format("cd {} && {} {} {} {} -o run > log 2>&1 && ./run > printed", folder.path().string(), one.compiler,
                      cpp_numeric_flags, level, one.sources);
      ASSERT_EQ(std::system(build.c_str()), 0) << test::contents_of(folder / "log").substr(0, 2000);
      EXPECT_EQ(test::contents_of(folder / "printed"), wanted) << one.source << " at " << level;
    }
  }
}

}  // namespace
}  // namespace hysteron::testing
