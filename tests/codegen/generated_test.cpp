// Generated against interpreted: random programs, compiled by the system's compiler, give the interpreter's bits.
#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "codegen/backends/c_family/c_library_names.hpp"
#include "codegen/backends/c_family/names.hpp"
#include "codegen/backends/c_family/words.hpp"
#include "codegen/backends/cpp/cpp.hpp"
#include "codegen/backends/cpp/cpp_host.hpp"
#include "codegen/interpreter/machine.hpp"
#include "codegen/parameters/apply.hpp"
#include "tests/codegen/random_body.hpp"
#include "tests/codegen/random_program.hpp"
#include "tests/support/scratch_folder.hpp"

namespace hysteron::testing {
namespace {

constexpr int programs = 40;
constexpr int instances = 30;
constexpr int steps = 400;

/// The same pseudo-random inputs here and in the generated program.
struct Inputs {
  std::uint64_t state = 88172645463325252ULL;
  std::uint64_t next() {
    state ^= state << 13U;
    state ^= state >> 7U;
    state ^= state << 17U;
    return state;
  }
  double real() { return static_cast<double>(next() >> 11U) * 0x1p-53 * 6.0 - 3.0; }
};
constexpr std::string_view inputs_text = R"(
struct Inputs {
  std::uint64_t state = 88172645463325252ULL;
  std::uint64_t next() { state ^= state << 13U; state ^= state >> 7U; state ^= state << 17U; return state; }
  double real() { return static_cast<double>(next() >> 11U) * 0x1p-53 * 6.0 - 3.0; }
};
)";

/// A hash of the outputs' bits; all not-a-numbers are one.
template <class Real>
void mix(std::uint64_t& hash, Real value) {
  std::uint64_t bits = 0x7FF8;
  if (value == value) {
    if constexpr (sizeof(Real) == 8) {
      bits = std::bit_cast<std::uint64_t>(value);
    } else {
      bits = std::bit_cast<std::uint32_t>(value);
    }
  }
  hash = (hash ^ bits) * 0x100000001B3ULL;
}

template <class Real>
std::uint64_t interpreted(const Program& program) {
  Machine<Real> machine(program);
  Inputs inputs;
  std::uint64_t hash = 0xCBF29CE484222325ULL;
  for (int k = 0; k < steps; ++k) {
    for (std::size_t i = 0; i < 3; ++i) {
      machine.set_input(i, static_cast<Real>(inputs.real()));
    }
    machine.set_input(3, static_cast<Real>(inputs.next() % 2));
    machine.set_input(4, static_cast<Real>(inputs.next() % 8 == 0));
    machine.set_input(5, static_cast<Real>(inputs.next() % 5));
    machine.step();
    for (std::size_t i = 0; i < program.graph.outputs.size(); ++i) {
      mix(hash, static_cast<Real>(machine.output(i)));
    }
  }
  return hash;
}

std::string text_of(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// What the program of main.cpp in the folder prints, compiled with these flags beside those of a numeric target.
/// Where it does not compile or run, the test fails and shows what the compiler says.
std::string printed_by_main(const test::ScratchFolder& folder, std::string_view flags) {
  const auto at = [&](const char* name) { return (folder.path() / name).string(); };
  const std::string compile = fmt::format("c++ -std=c++20 -O1 {} {} {} -o {} 2> {}", flags, cpp_numeric_flags,
                                          at("main.cpp"), at("run"), at("log"));
  EXPECT_EQ(std::system(compile.c_str()), 0) << text_of(at("log"));
  EXPECT_EQ(std::system(fmt::format("{} > {}", at("run"), at("out")).c_str()), 0);
  return text_of(at("out"));
}

template <class Real>
void hold_generated_against_interpreted() {
  const test::ScratchFolder folder;
  std::string main_text = "#include <bit>\n#include <cstdint>\n#include <cstdio>\n";
  std::string calls;
  std::vector<std::uint64_t> expected;
  for (int i = 0; i < programs; ++i) {
    const std::string name = "P" + std::to_string(i);
    const RandomDiagram diagram(static_cast<std::uint64_t>(i) + 1000 * sizeof(Real), name, instances);
    const auto seed = static_cast<std::uint64_t>(i) + 3300 + sizeof(Real);
    const Program program = i % 4 == 3 ? RandomBody(seed, name, 10).program() : diagram.program();
    expected.push_back(interpreted<Real>(program));
    const GeneratedFile header = generate_cpp_header(program, {.float32 = sizeof(Real) == 4});
    std::ofstream(folder.path() / header.name) << header.text;
    main_text += "#include \"" + header.name + "\"\n";
    calls += fmt::format("  run<p{0}::Params, p{0}::State, p{0}::In>(p{0}::reset, p{0}::step);\n", i);
  }
  main_text += inputs_text;
  main_text += fmt::format("using Real = {};\nusing Bits = {};\n", sizeof(Real) == 4 ? "float" : "double",
                           sizeof(Real) == 4 ? "std::uint32_t" : "std::uint64_t");
  main_text += R"(
void mix(std::uint64_t& hash, Real value) {
  hash = (hash ^ (value == value ? std::uint64_t{std::bit_cast<Bits>(value)} : 0x7FF8U)) * 0x100000001B3ULL;
}
template <class Params, class State, class In, class Reset, class Step>
void run(Reset reset, Step step) {
  Params params;
  State state;
  In in;
  reset(params, state);
  Inputs inputs;
  std::uint64_t hash = 0xCBF29CE484222325ULL;
  for (int k = 0; k < 400; ++k) {
    in.x1 = static_cast<Real>(inputs.real());
    in.x2 = static_cast<Real>(inputs.real());
    in.x3 = static_cast<Real>(inputs.real());
    in.b1 = inputs.next() % 2 != 0;
    in.b2 = inputs.next() % 8 == 0;
    in.n1 = static_cast<std::int32_t>(inputs.next() % 5);
    const auto out = step(params, state, in);
    mix(hash, out.y0);
    mix(hash, out.y1);
    mix(hash, out.y2);
    mix(hash, out.y3);
    mix(hash, static_cast<Real>(out.q));
    mix(hash, static_cast<Real>(out.n));
  }
  std::printf("%llu\n", static_cast<unsigned long long>(hash));
}
int main() {
)" + calls + "}\n";
  std::ofstream(folder.path() / "main.cpp") << main_text;
  std::istringstream hashes(printed_by_main(folder, "-Wall -Wextra -Werror -Wno-tautological-compare"));
  for (int i = 0; i < programs; ++i) {
    std::uint64_t got = 0;
    hashes >> got;
    EXPECT_EQ(got, expected[static_cast<std::size_t>(i)])
        << RandomDiagram(static_cast<std::uint64_t>(i) + 1000 * sizeof(Real), "P", instances).text();
  }
}

TEST(Generated, RandomProgramsHaveTheBitsOfTheInterpreter) {
  hold_generated_against_interpreted<double>();
}
TEST(Generated, RandomProgramsHaveTheBitsOfTheInterpreterInFloat) {
  hold_generated_against_interpreted<float>();
}

/// The lowest standard that the head of a header names.
TEST(Generated, AHeaderIsCpp11AndEveryStandardSince) {
  const test::ScratchFolder folder;
  std::string includes;
  for (int i = 0; i < 12; ++i) {
    const GeneratedFile header =
        generate_cpp_header(RandomDiagram(static_cast<std::uint64_t>(i) + 7000, fmt::format("P{}", i), 40).program(),
                            {.float32 = i % 2 == 1});
    EXPECT_NE(header.text.find("// C++11 or later."), std::string::npos);
    folder.write(header.name, header.text);
    includes += "#include \"" + header.name + "\"\n";
  }
  const std::string main_file = folder.write("main.cpp", includes + "int main() { return 0; }\n");
  for (const char* const standard : {"c++11", "c++14", "c++17", "c++20"}) {
    const std::string compile =
        fmt::format("c++ -std={} -fsyntax-only -pedantic -Wall -Wextra -Werror -Wno-tautological-compare {} {} 2> {}",
                    standard, cpp_numeric_flags, main_file, folder / "log");
    EXPECT_EQ(std::system(compile.c_str()), 0) << standard << ": " << text_of(folder / "log").substr(0, 2000);
  }
}

/// A diagram may be named after anything that C++ or the C library has for itself: its namespace then has another name.
TEST(Generated, NoNamespaceHasANameOfTheLanguageOrTheCLibrary) {
  std::vector<std::string> names{"MAIN", "FLOAT", "DOUBLE", "INLINE", "REGISTER", "AUTO",  "SIGNED", "EXTERN",
                                 "ASM",  "NAN",   "POW",    "SELECT", "REMOVE",   "RAND",  "STRTOD", "STD",
                                 "TM",   "LINUX", "SIGNAL", "INDEX",  "PAUSE",    "ERRNO", "DETAIL", "PLANT"};
  for (const auto* type : {"INT8_T",    "UINT16_T",  "INT32_T", "UINT64_T", "INT_FAST32_T", "UINT_LEAST8_T", "INTMAX_T",
                           "UINTPTR_T", "PTRDIFF_T", "VA_LIST", "WCTYPE_T", "MBSTATE_T",    "PTHREAD_T",     "SIGSET_T",
                           "FD_SET",    "ID_T",      "WCSLEN",  "EXPL",     "STRTOK_R",     "TZNAME"}) {
    EXPECT_NE(namespace_identifier(type), field_identifier(type)) << "is taken";
    names.emplace_back(type);
  }
  names.insert(names.end(), cpp_words.begin(), cpp_words.end());
  std::istringstream library{std::string(c_library_names)};
  for (std::string word; library >> word;) {
    names.push_back(word);
  }
  const test::ScratchFolder folder;
  std::ofstream main_file(folder.path() / "main.cpp");
  main_file << "#include <algorithm>\n#include <array>\n#include <bit>\n#include <cctype>\n#include <charconv>\n"
               "#include <cmath>\n#include <concepts>\n#include <cstddef>\n#include <cstdint>\n#include <cstdio>\n"
               "#include <cstdlib>\n#include <iostream>\n#include <limits>\n#include <string>\n#include <thread>\n"
               "#include <vector>\n";
  for (const std::string& name : names) {
    main_file << "namespace " << namespace_identifier(name) << " { using Real = double; }\n";
  }
  main_file << "int main() { std::puts(\"compiled\"); }\n";
  main_file.close();
  EXPECT_EQ(printed_by_main(folder, ""), "compiled\n");
  EXPECT_EQ(namespace_identifier("PLANT"), "plant") << "others keep theirs";
}

TEST(Generated, AMainWithoutOutputsCompilesWithoutAWarning) {
  const Program program = compile_text(
      "FUNCTION_BLOCK SINK (* @ts 1ms *) VAR_INPUT U : LREAL; END_VAR VAR G : HY_GAIN; END_VAR G(XIN := U); "
      "END_FUNCTION_BLOCK");
  const test::ScratchFolder folder;
  for (const GeneratedFile& file : {generate_cpp_header(program), cpp_host_main(program)}) {
    std::ofstream(folder.path() / file.name) << file.text;
  }
  const std::string compile = fmt::format("c++ -std=c++20 -fsyntax-only -Wall -Wextra -Werror {} {}", cpp_numeric_flags,
                                          (folder.path() / "main.cpp").string());
  EXPECT_EQ(std::system(compile.c_str()), 0);
}

/// A column `R[1]` is an element, also with a unit behind it, of each type.
TEST(Generated, TheMainReadsVectors) {
  const Program program = compile_text(
      "FUNCTION_BLOCK TYPES (* @ts 1ms *) VAR_INPUT R : ARRAY[0..2] OF LREAL; N : ARRAY[0..2] OF DINT;\n"
      "  W : ARRAY[0..2] OF WORD; B : ARRAY[0..2] OF BOOL; END_VAR\n"
      "VAR_OUTPUT YR : ARRAY[0..2] OF LREAL; YN : ARRAY[0..2] OF DINT; YW : ARRAY[0..2] OF WORD;\n"
      "  YB : ARRAY[0..2] OF BOOL; END_VAR\n"
      "YR := R * 2.0; YN := N + 1; YW := W AND 16#F0; YB := NOT B; END_FUNCTION_BLOCK");
  const test::ScratchFolder folder;
  for (const GeneratedFile& file : {generate_cpp_header(program), cpp_host_main(program)}) {
    folder.write(file.name, file.text);
  }
  folder.write("in.csv",
               "t [s],R[0] [um],R[1],R[2],N[0],N[1],N[2],W[0],W[1],W[2],B[0],B[1],B[2]\n0,1,2,3,4,5,6,7,255,9,0,1,0\n");
  const std::string build = fmt::format(
      "cd {} && c++ -std=c++20 -O0 -Wall -Wextra -Werror {} main.cpp -o run > log 2>&1 && ./run < in.csv > out.csv",
      folder.path().string(), cpp_numeric_flags);
  ASSERT_EQ(std::system(build.c_str()), 0) << test::contents_of(folder / "log");
  EXPECT_EQ(test::contents_of(folder / "out.csv"),
            "t,YR[0],YR[1],YR[2],YN[0],YN[1],YN[2],YW[0],YW[1],YW[2],YB[0],YB[1],YB[2]\n0,2,4,6,5,6,7,0,240,0,1,0,1\n");
}

/// Parameters of nested blocks are members of a structure; comments are the user's words.
TEST(Generated, MembersAndCommentsAreSafe) {
  const Program program = compile_text(
      "FUNCTION_BLOCK STAGE VAR_INPUT X : LREAL; FLOAT : LREAL := 2.0; (* @param @doc times */ 2 \\ *) END_VAR\n"
      "VAR_OUTPUT Z : LREAL; END_VAR Z := FLOAT * X; END_FUNCTION_BLOCK\n"
      "FUNCTION_BLOCK SELECT (* @ts 1ms *) VAR_INPUT\n"
      "  U : LREAL; (* @doc in volts \\ *)\n"
      "  K : LREAL := 1.0; (* @param @doc a path: C:\\ *)\nEND_VAR\n"
      "VAR_OUTPUT Y : LREAL; (* @doc ends in \\ *) END_VAR VAR S : STAGE; END_VAR\n"
      "S(X := K * U); Y := S.Z; END_FUNCTION_BLOCK\n",
      {.top = "SELECT"});
  const test::ScratchFolder folder;
  const GeneratedFile header = generate_cpp_header(program, {});
  std::ofstream(folder.path() / header.name) << header.text;
  std::ofstream(folder.path() / "main.cpp") << fmt::format(R"(#include <cstdio>
#include "{}"
int main() {{
  {}::Params params;
  {}::State state;
  std::printf("%g\n", {}::step(params, state, {{.u = 3.0}}).y);
}}
)",
                                                           header.name, "select_2", "select_2", "select_2");
  EXPECT_EQ(printed_by_main(folder, "-Wall -Wextra -Werror"), "6\n") << header.text;
}

/// A target runs for years: 10^10 steps are six days at 50 us. The counter of steps is a DINT, which ends at 2.1·10^9.
/// It stays below the common period of the rates for ever, if it goes from its last value to 0; that passage is tried
/// at the longest of periods, and what runs in the steps round it is held against the interpreter, which counts on.
TEST(Generated, TheCounterOfStepsNeverOverflows) {
  const Program program = compile_text(
      "FUNCTION_BLOCK RATES (* @ts 50us *) VAR_INPUT U : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR\n"
      "VAR A : HY_SAMPLE; (* @every 65536 @phase 1 *) B : HY_SAMPLE; (* @every 32749 *) KA : HY_HOLD; KB : HY_HOLD;\n"
      "END_VAR A(XIN := U); B(XIN := U); KA(XIN := A.XOUT); KB(XIN := B.XOUT); Y := KA.XOUT + 0.5 * KB.XOUT;\n"
      "END_FUNCTION_BLOCK\n");
  constexpr std::int64_t period = std::int64_t{65536} * 32749;
  static_assert(period < longest_common_period);
  constexpr std::int64_t first = 5 * period - 2;  // beyond 10^10
  static_assert(first > 10'000'000'000);
  const test::ScratchFolder folder;
  const GeneratedFile header = generate_cpp_header(program, {});
  std::ofstream(folder.path() / header.name) << header.text;
  std::ofstream(folder.path() / "main.cpp") << fmt::format(R"(#include <cstdio>
#include "{}"
int main() {{
  rates::Params params;
  rates::State state;
  rates::reset(params, state);
  state.steps = {};
  for (int k = 0; k < 6; ++k) {{
    std::printf("%d", static_cast<int>(state.steps));
    std::printf(" %g\n", rates::step(params, state, {{.u = 1.0 + k}}).y);
  }}
}}
)",
                                                           header.name, first % period);
  std::istringstream out(printed_by_main(folder, "-fsanitize=undefined -fno-sanitize-recover=all"));

  Machine<double> machine(program);
  std::vector<std::byte> bytes(machine.saved_size());
  machine.save(bytes);  // its last eight bytes are the count of steps
  std::memcpy(bytes.data() + bytes.size() - sizeof(first), &first, sizeof(first));
  machine.restore(bytes);
  std::vector<double> values;
  for (int k = 0; k < 6; ++k) {
    std::int64_t counter = -1;
    double y = 0.0;
    out >> counter >> y;
    EXPECT_EQ(counter, (first + k) % period);
    machine.set_input(0, 1.0 + k);
    machine.step();
    EXPECT_EQ(y, machine.output(0)) << "step " << first + k;
    values.push_back(y);
  }
  EXPECT_EQ(values, (std::vector{0.0, 0.0, 1.5, 5.5, 5.5, 5.5})) << "B runs in the third of them, A in the fourth";
}

TEST(Generated, StatesBeginWhereTheParameterFileSays) {
  Program program = compile_text(
      "FUNCTION_BLOCK TANK (* @ts 1ms *) VAR_INPUT U : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR\n"
      "VAR SUM : HY_INTEGRAL; LAG : HY_DELAY; END_VAR SUM(XIN := U); LAG(XIN := SUM.XOUT); Y := LAG.XOUT;\n"
      "END_FUNCTION_BLOCK\n");
  const std::string plain = generate_cpp_header(program, {}).text;
  parameters::apply(parameters::parse_parameter_file("p.toml", "[initial.Sum]\nsum = 2.5\n"), program.graph);
  const std::string given = generate_cpp_header(program, {}).text;
  const auto reset_of = [](const std::string& text) {
    const auto begin = text.find("inline void reset(");
    return text.substr(begin, text.find("\n}\n", begin) - begin);
  };
  EXPECT_EQ(reset_of(plain).find("2.5"), std::string::npos);
  EXPECT_NE(reset_of(given).find("state.sum.sum = 2.5;"), std::string::npos) << reset_of(given);
  Machine<float> machine(program);
  machine.step();
  machine.step();
  EXPECT_EQ(machine.output(0), 2.5F);
  machine.reset();
  EXPECT_EQ(*machine.real_state("SUM.SUM"), 2.5F);
}

}  // namespace
}  // namespace hysteron::testing
