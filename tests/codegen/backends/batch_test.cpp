// Eight instances in the lanes of a vector against the interpreter: each lane has inputs and parameters of its own.
#include "codegen/backends/batch/batch.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include "codegen/backends/cpp/cpp.hpp"
#include "codegen/interpreter/machine.hpp"
#include "tests/codegen/backends/same_inputs.hpp"
#include "tests/codegen/random_body.hpp"
#include "tests/codegen/random_program.hpp"
#include "tests/support/scratch_folder.hpp"

namespace hysteron::testing {
namespace {

constexpr std::size_t batch_steps = 300;
constexpr std::size_t batch_middle = batch_steps / 2;  ///< a reset before this step

struct BatchDiagram {
  int extremes = 0;  ///< of inputs: 1: equal, denormal, large; 2: infinite and no numbers too
  std::string text{};
  Program program{};
};

BatchDiagram batch_diagram(int number) {
  const auto seed = static_cast<std::uint64_t>(7'000'000 + number);
  const std::string name = fmt::format("P{}", number);
  if (number % 6 == 5) {
    const RandomBody body(seed, name, 6);
    return {.extremes = number % 3, .text = body.text(), .program = body.program()};
  }
  const RandomDiagram diagram(seed, name, 2 + number % 5, {.rates = true, .types = true, .functions = true});
  return {.extremes = number % 3, .text = diagram.text(), .program = diagram.program()};
}

std::uint64_t source_of_lane(int number, std::size_t lane) {
  return 88172645463325252ULL ^
         (static_cast<std::uint64_t>(100 * number + static_cast<int>(lane) + 1) * 0x9E3779B97F4A7C15ULL);
}

std::uint64_t interpreted_hash(const BatchDiagram& diagram, int number, std::size_t lane) {
  Machine<double> machine(diagram.program, diagram.program.graph.sample_time());
  same::source from{source_of_lane(number, lane)};
  std::uint64_t hash = 14695981039346656037ULL;
  for (std::size_t k = 0; k < batch_steps; ++k) {
    if (k == batch_middle) {
      machine.reset();
    }
    std::size_t input = 0;
    for (int i = 0; i < 3; ++i) {
      machine.set_input(input++, same::real_number(&from, diagram.extremes));
    }
    machine.set_input(input++, static_cast<double>(same::next_number(&from) % 2));
    machine.set_input(input++, static_cast<double>(same::next_number(&from) % 8 == 0));
    machine.set_input(input++, static_cast<double>(same::whole_number(&from, 1)));
    if (input < diagram.program.graph.inputs.size()) {
      machine.set_input(input, static_cast<double>(same::next_number(&from) % 65536));
    }
    machine.step();
    for (std::size_t i = 0; i < diagram.program.graph.outputs.size(); ++i) {
      same::mix(&hash, machine.output(i));
    }
  }
  return hash;
}

/// Runs a diagram at one width, and prints a hash for each lane.
std::string runner_of(const BatchDiagram& diagram, int number) {
  const BatchNames names = batch_names(diagram.program);
  std::string sources;
  for (std::size_t lane = 0; lane < batch_width; ++lane) {
    sources += fmt::format("{}{{{}u}}", lane == 0 ? "" : ", ", source_of_lane(number, lane));
  }
  std::string outputs;
  for (std::size_t i = 0; i < names.outputs.size(); ++i) {
    outputs += fmt::format(
        "      mix(&hash[i], {});\n",
        number_of_lane(diagram.program.graph.outputs[i].type, fmt::format("out.{}.lane[i]", names.outputs[i])));
  }
  return fmt::format(
      "static void run_{0}(int lanes) {{\n  static {0}::Params params;\n  static {0}::State state;\n"
      "  static {0}::In in;\n  static {0}::Out out;\n  source from[] = {{{1}}};\n  uint64_t hash[8];\n"
      "  for (uint64_t& one : hash) {{ one = 14695981039346656037u; }}\n  {0}::reset(1, &params, &state);\n"
      "  for (int k = 0; k < {2}; ++k) {{\n    if (k == {3}) {{ {0}::reset(1, &params, &state); }}\n"
      "    for (int i = 0; i < 8; ++i) {{\n      in.x1.lane[i] = real_number(&from[i], {4});\n"
      "      in.x2.lane[i] = real_number(&from[i], {4});\n      in.x3.lane[i] = real_number(&from[i], {4});\n"
      "      in.b1.lane[i] = next_number(&from[i]) % 2 != 0 ? -1 : 0;\n"
      "      in.b2.lane[i] = next_number(&from[i]) % 8 == 0 ? -1 : 0;\n"
      "      in.n1.lane[i] = whole_number(&from[i], 1);\n{5}    }}\n    {0}::step(1, &params, &state, &in, &out, "
      "lanes);\n"
      "    for (int i = 0; i < 8; ++i) {{\n{6}    }}\n  }}\n"
      "  for (const uint64_t one : hash) {{ printf(\"%llu\\n\", (unsigned long long)one); }}\n}}\n",
      names.space, sources, batch_steps, batch_middle, diagram.extremes,
      names.inputs.size() > 6 ? "      in.w1.lane[i] = (std::int64_t)(next_number(&from[i]) % 65536);\n" : "", outputs);
}

/// What a main prints that is compiled as a batch is.
std::string output_of_program(const test::ScratchFolder& folder, const std::string& main, std::string_view more) {
  folder.write("main.cpp", main);
  const std::string build = fmt::format(
      "cd {} && c++ -std=c++17 -Wall -Wextra -Werror {} {} main.cpp -o run {} -lm > log 2>&1 && ./run > out",
      folder.path().string(), cpp_numeric_flags, batch_flags, more);
  EXPECT_EQ(std::system(build.c_str()), 0) << test::contents_of(folder / "log").substr(0, 3000);
  return test::contents_of(folder / "out");
}

class BatchBackend : public ::testing::TestWithParam<int> {};

TEST_P(BatchBackend, HasInEachLaneTheBitsOfTheInterpreter) {
  const test::ScratchFolder folder;
  const int first = 6 * GetParam();
  std::vector<BatchDiagram> diagrams;
  std::string main = "#include <cmath>\n#include <cstdint>\n#include <cstdio>\n#include <cstring>\n";
  std::string calls;
  for (int i = 0; i < 6; ++i) {
    diagrams.push_back(batch_diagram(first + i));
    const GeneratedFile header = generate_batch(diagrams.back().program);
    folder.write(header.name, header.text);
    main += fmt::format("#include \"{}\"\n", header.name);
    calls += fmt::format("    run_{}(lanes);\n", batch_names(diagrams.back().program).space);
  }
  main += "#pragma GCC diagnostic ignored \"-Wunused-function\"\n" + std::string(same::text) + "\n";
  for (int i = 0; i < 6; ++i) {
    main += runner_of(diagrams[static_cast<std::size_t>(i)], first + i);
  }
  main += fmt::format(
      "int main() {{\n  for (int lanes = {}::lanes_of_processor(); lanes >= 2; lanes /= 2) {{\n"
      "    printf(\"lanes %d\\n\", lanes);\n{}  }}\n}}\n",
      batch_names(diagrams.front().program).space, calls);
  std::istringstream printed(output_of_program(folder, main, ""));
  std::string word;
  int widths = 0;
  while (printed >> word) {
    ASSERT_EQ(word, "lanes");
    int lanes = 0;
    printed >> lanes;
    ++widths;
    for (int i = 0; i < 6; ++i) {
      for (std::size_t lane = 0; lane < batch_width; ++lane) {
        std::uint64_t hash = 0;
        printed >> hash;
        EXPECT_EQ(hash, interpreted_hash(diagrams[static_cast<std::size_t>(i)], first + i, lane))
            << "number " << first + i << ", lane " << lane << ", " << lanes << " lanes in a register\n"
            << diagrams[static_cast<std::size_t>(i)].text;
      }
    }
  }
  EXPECT_GE(widths, 1);
}

INSTANTIATE_TEST_SUITE_P(RandomDiagrams, BatchBackend, ::testing::Range(0, 4));

TEST(Batch, HasParametersInEachLane) {
  const test::ScratchFolder folder;
  const Program program = compile_text(
      "FUNCTION_BLOCK SCALED (* @ts 1ms *)\n VAR_INPUT\n  X : LREAL;\n  K : LREAL := 1.0; (* @param *)\n"
      "  LIVE : BOOL := TRUE; (* @param *)\n END_VAR\n VAR_OUTPUT\n  Y : LREAL;\n END_VAR\n"
      " Y := SEL(LIVE, 0.0, K * X);\nEND_FUNCTION_BLOCK\n");
  const GeneratedFile header = generate_batch(program);
  folder.write(header.name, header.text);
  const std::string printed = output_of_program(folder,
                                                fmt::format(R"(#include "{}"
#include <cstdio>
int main() {{
  using namespace scaled_batch;
  static Params params[2];
  static State state[2];
  static In in[2];
  static Out out[2];
  for (int i = 0; i < 16; ++i) {{
    params[i / 8].k.lane[i % 8] = i;
    params[i / 8].live.lane[i % 8] = i == 3 ? 0 : -1;
    in[i / 8].x.lane[i % 8] = 2.0;
  }}
  reset(2, params, state);
  step(2, params, state, in, out);
  for (int i = 0; i < 16; ++i) {{
    std::printf("%g ", out[i / 8].y.lane[i % 8]);
  }}
}}
)",
                                                            header.name),
                                                "");
  EXPECT_EQ(printed, "0 2 4 0 8 10 12 14 16 18 20 22 24 26 28 30 ");
}

#if defined(__x86_64__) && defined(__GLIBC__)
/// The largest distance in units in the last place is printed, and whether special values are those of the C library.
TEST(Batch, HasFastFunctionsWithinFourUnitsInTheLastPlace) {
  const test::ScratchFolder folder;
  const Program program = compile_text(
      "FUNCTION_BLOCK CALLS (* @ts 1ms *)\n VAR_INPUT\n  X : LREAL;\n  P : LREAL;\n END_VAR\n VAR_OUTPUT\n"
      "  E : LREAL; L : LREAL; S : LREAL; C : LREAL; A : LREAL; W : LREAL;\n END_VAR\n"
      " E := EXP(X); L := LN(X); S := SIN(X); C := COS(X); A := ATAN(X); W := X ** P;\nEND_FUNCTION_BLOCK\n");
  const GeneratedFile header = generate_batch(program);
  folder.write(header.name, header.text);
  const std::string printed = output_of_program(folder,
                                                fmt::format(R"(#include "{}"
#include <cstdio>
#include <random>
static double worst = 0.0;
static int odd = 0;
static void hold(double got, double wanted) {{
  if (!std::isfinite(wanted) || std::fabs(wanted) < 1e-300) {{
    odd += std::isnan(wanted) ? !std::isnan(got) : std::fabs(wanted) < 1e-300 ? !(std::fabs(got - wanted) < 1e-299) : got != wanted;
    return;
  }}
  const double unit = std::nextafter(std::fabs(wanted), INFINITY) - std::fabs(wanted);
  const double distance = std::fabs(got - wanted) / unit;
  worst = distance > worst || distance != distance ? distance : worst;
}}
int main() {{
  using namespace calls_batch;
  static Params params;
  static State state;
  static In in;
  static Out out;
  const double special[] = {{0.0, -0.0, 1.0, -1.0, 2.0, 0.5, -3.0, INFINITY, -INFINITY, NAN, 1e-310, 1e300, -1e300}};
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> spread(-20.0, 20.0);
  for (int lanes = lanes_of_processor(); lanes >= 2; lanes /= 2) {{
    for (int k = 0; k < 20000; ++k) {{
      for (int i = 0; i < 8; ++i) {{
        in.x.lane[i] = k % 10 == 0 && random() % 2 ? special[random() % 13] : spread(random);
        in.p.lane[i] = k % 10 == 0 && random() % 2 ? special[random() % 13] : spread(random) / 4.0;
      }}
      step(1, &params, &state, &in, &out, lanes);
      for (int i = 0; i < 8; ++i) {{
        const double x = in.x.lane[i];
        hold(out.e.lane[i], std::exp(x));
        hold(out.l.lane[i], std::log(x));
        hold(out.s.lane[i], std::sin(x));
        hold(out.c.lane[i], std::cos(x));
        hold(out.a.lane[i], std::atan(x));
        hold(out.w.lane[i], in.p.lane[i] == 0.5 ? std::sqrt(x) : std::pow(x, in.p.lane[i]));
      }}
    }}
  }}
  std::printf("%g %d", worst, odd);
}}
)",
                                                            header.name),
                                                "-lmvec -DHYSTERON_BATCH_FAST");
  std::istringstream words(printed);
  double worst = 1e9;
  int odd = -1;
  words >> worst >> odd;
  EXPECT_LE(worst, 4.0);
  EXPECT_GT(worst, 0.0) << "the C library was called";
  EXPECT_EQ(odd, 0);
}
#endif

}  // namespace
}  // namespace hysteron::testing
