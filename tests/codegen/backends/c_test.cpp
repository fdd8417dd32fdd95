// C99 against the interpreter: random programs, compiled without a warning by the compilers that are there.
#include "codegen/backends/c/c.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "codegen/backends/cpp/cpp.hpp"
#include "tests/codegen/backends/recorded_run.hpp"
#include "tests/codegen/random_body.hpp"
#include "tests/codegen/random_program.hpp"
#include "tests/support/scratch_folder.hpp"

namespace hysteron::testing {
namespace {

constexpr std::size_t c_programs = 24;
constexpr std::size_t c_steps = 400;
constexpr std::string_view c_warnings = "-std=c99 -pedantic -Wall -Wextra -Wconversion -Werror";

/// Two instances of each program run side by side; the second one, which gets other inputs, must not disturb the first.
constexpr std::string_view c_run = R"(
static void run_{name}(const char *folder) {{
  {name}_params params;
  {name}_in in;
  {name}_in other_in;
  {name}_state state;
  {name}_state other;
  {name}_out out;
  double row[6];
  int step = 0;
  char file[500];
  FILE *source;
  FILE *target;
  {name}_defaults(&params, &in);
  {name}_reset(&state, &params);
  {name}_reset(&other, &params);
  (void)snprintf(file, sizeof(file), "%s/in{number}", folder);
  source = fopen(file, "rb");
  (void)snprintf(file, sizeof(file), "%s/out{number}", folder);
  target = fopen(file, "wb");
  while (fread(row, sizeof(row), 1, source) == 1) {{
    double results[6];
    if (step == {middle}) {{
      {name}_reset(&state, &params);
    }}
    ++step;
    in.x1 = ({real})row[0];
    in.x2 = ({real})row[1];
    in.x3 = ({real})row[2];
    in.b1 = row[3] != 0.0;
    in.b2 = row[4] != 0.0;
    in.n1 = (int32_t)row[5];
    other_in = in;
    other_in.x1 = in.x2;
    {name}_step(&params, &other, &other_in, &out);
    {name}_step(&params, &state, &in, &out);
    results[0] = (double)out.y0;
    results[1] = (double)out.y1;
    results[2] = (double)out.y2;
    results[3] = (double)out.y3;
    results[4] = out.q ? 1.0 : 0.0;
    results[5] = (double)out.n;
    (void)fwrite(results, sizeof(results), 1, target);
  }}
  (void)fclose(source);
  (void)fclose(target);
}}
)";

bool is_there(std::string_view compiler) {
  return std::system(fmt::format("{} --version > /dev/null 2>&1", compiler).c_str()) == 0;
}

template <class Real>
void hold_c_against_interpreted(std::string_view compiler) {
  if (!is_there(compiler)) {
    std::printf("%s is not installed\n", std::string(compiler).c_str());
    return;
  }
  const test::ScratchFolder folder;
  std::string main_text = "#include <stdio.h>\n";
  std::string runs_text;
  std::string calls;
  std::vector<RecordedRun> runs;
  for (std::size_t i = 0; i < c_programs; ++i) {
    const RandomDiagram diagram(i + 1000 * sizeof(Real) + 77, fmt::format("P{}", i), 30);
    const std::uint64_t seed = i + 7700 + sizeof(Real);
    const Program program = i % 4 == 3 ? RandomBody(seed, fmt::format("P{}", i), 10).program() : diagram.program();
    runs.push_back(record<Real>(program, c_steps, i));
    write_doubles(folder / fmt::format("in{}", i), runs.back().inputs);
    for (const GeneratedFile& file : generate_c(program, {.float32 = sizeof(Real) == 4})) {
      folder.write(file.name, file.text);
    }
    main_text += fmt::format("#include \"p{}.h\"\n", i);
    runs_text += fmt::format(fmt::runtime(c_run), fmt::arg("name", fmt::format("p{}", i)), fmt::arg("number", i),
                             fmt::arg("middle", c_steps / 2), fmt::arg("real", sizeof(Real) == 4 ? "float" : "double"));
    calls += fmt::format("  run_p{}(argv[argc - 1]);\n", i);
  }
  folder.write("main.c", main_text + runs_text + "int main(int argc, char **argv) {\n" + calls + "  return 0;\n}\n");
  const std::string path = folder.path().string();
  const std::string build = fmt::format("cd {} && {} -O1 {} {} *.c -o run -lm > log 2>&1 && ./run {}", path, compiler,
                                        c_warnings, cpp_numeric_flags, path);
  ASSERT_EQ(std::system(build.c_str()), 0) << test::contents_of(folder / "log").substr(0, 3000);
  for (std::size_t i = 0; i < c_programs; ++i) {
    EXPECT_EQ(equal_steps(runs[i], read_doubles(folder / fmt::format("out{}", i))), c_steps) << "program " << i;
  }
}

/// Names of C, of its library and of the generated text itself; comments that would run on; nothing to keep.
TEST(GeneratedC, NamesAndCommentsAreSafe) {
  const Program program = compile_text(
      "FUNCTION_BLOCK PRINTF (* @ts 1ms *) VAR_INPUT RESTRICT : LREAL; (* @doc ends in \\ *)\n"
      "INLINE, NORETURN : LREAL; STATE : DINT; END_VAR VAR_OUTPUT FABS : LREAL; PARAMS : LREAL; REAL_MIN : DINT; "
      "END_VAR\n"
      "VAR POW : HY_GAIN := (K := 3.0); COMPLEX : HY_LAG; END_VAR POW(XIN := RESTRICT); COMPLEX(XIN := NORETURN);\n"
      "FABS := EXP(POW.XOUT) + COMPLEX.XOUT + MIN(POW.XOUT, INLINE) ** INLINE; PARAMS := FABS + POW.XOUT; REAL_MIN := "
      "STATE + 1;\n"
      "END_FUNCTION_BLOCK");
  const test::ScratchFolder folder;
  for (const GeneratedFile& file : generate_c(program)) {
    folder.write(file.name, file.text);
  }
  const std::string build = fmt::format(
      "cd {0} && cc -fsyntax-only {1} {2} *.c > log 2>&1 && c++ -fsyntax-only -Wall -Wextra -Werror -x c++ -include "
      "printf_2.h /dev/null >> log 2>&1 && cc -fsyntax-only -x c -include complex.h -include stdnoreturn.h -include "
      "printf_2.h /dev/null >> log 2>&1",
      folder.path().string(), c_warnings, cpp_numeric_flags);
  EXPECT_EQ(std::system(build.c_str()), 0) << test::contents_of(folder / "log").substr(0, 2000);
}

TEST(GeneratedC, RandomProgramsHaveTheBitsOfTheInterpreter) {
  hold_c_against_interpreted<double>("cc");
}
TEST(GeneratedC, RandomProgramsHaveTheBitsOfTheInterpreterInFloat) {
  hold_c_against_interpreted<float>("cc");
}
TEST(GeneratedC, RandomProgramsHaveTheBitsOfTheInterpreterWithClang) {
  hold_c_against_interpreted<double>("clang");
}

}  // namespace
}  // namespace hysteron::testing
