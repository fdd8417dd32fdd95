// hysteron generate: what it writes compiles, has the bits of `hysteron run`, and overwrites nothing of the user's.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <string>

#include "codegen/compile.hpp"
#include "records/read.hpp"
#include "tests/tool/workbench.hpp"
#include "tool/compiled.hpp"
#include "tuning/float32_run.hpp"

namespace hysteron {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr std::string_view feedforward = R"(FUNCTION_BLOCK FEEDFORWARD  (* @ts 1ms *)
  VAR_INPUT
    Y_REF : LREAL;
    RESET : BOOL := FALSE;
    COUNT : DINT := 3;
  END_VAR
  VAR_OUTPUT
    U    : LREAL;
    TURN : BOOL;
    N    : DINT;
  END_VAR
  VAR
    RATE   : HY_DERIVATIVE;
    SMOOTH : HY_LAG := (T1 := 0.003);
    SUM    : HY_INTEGRAL;
  END_VAR

  RATE(XIN := Y_REF);
  SMOOTH(XIN := RATE.XOUT);
  SUM(XIN := SMOOTH.XOUT ** 3.0 + SIN(Y_REF) * EXP(0.01 * SMOOTH.XOUT), R1 := RESET);
  U := SUM.XOUT / (1.0 + ABS(SMOOTH.XOUT));
  TURN := SMOOTH.XOUT > 0.0;
  N := COUNT * 3 - 1;
END_FUNCTION_BLOCK
)";

/// A reference with reversals, as CSV; plain enough for the reader of the generated main.
std::string reference_log() {
  std::string text = "t,y_ref,reset\n";
  for (int k = 0; k < 300; ++k) {
    text += fmt::format("{},{},{}\n", 0.001 * k, std::sin(0.05 * k) * 3.0 + 0.01 * k, k == 150 ? 1 : 0);
  }
  return text;
}

TEST(Generate, WritesAllFilesAndListsThem) {
  const test::Workbench bench;
  bench.write("plant.st", test::plant);
  const auto outcome = bench.shell("hysteron generate plant.st --target cpp --out made/here");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "made/here/plant.hpp\nmade/here/main.cpp\nmade/here/CMakeLists.txt\n");
  for (const char* const name : {"plant.hpp", "main.cpp", "CMakeLists.txt"}) {
    EXPECT_THAT(bench.read(std::string("made/here/") + name), HasSubstr("enerated by Hysteron"));
  }
}

TEST(Generate, ParametersAreInTheText) {
  const test::Workbench bench;
  bench.write("plant.st", test::plant);
  bench.write("p.toml", "[parameters.AMP]\nK = 123.25\n");
  ASSERT_EQ(bench.shell("hysteron generate plant.st --target cpp --out g --params p.toml").code, 0);
  EXPECT_THAT(bench.read("g/plant.hpp"), HasSubstr("123.25"));
}

TEST(Generate, CompiledItHasTheBitsOfRun) {
  const test::Workbench bench;
  bench.write("ff.st", feedforward);
  bench.write("log.csv", reference_log());
  for (const std::string option : {"", " --float32"}) {
    ASSERT_EQ(bench.shell("hysteron generate ff.st --target cpp --out g" + option).code, 0);
    ASSERT_EQ(bench.shell("hysteron run ff.st --in log.csv --out run.csv" + option).code, 0);
    const auto built = bench.shell(
        "c++ -std=c++20 -O2 -ffp-contract=off -frounding-math g/main.cpp -o program && "
        "./program < log.csv > generated.csv");
    ASSERT_EQ(built.code, 0) << built.err;
    const auto run = records::read_record((bench.path() / "run.csv").string());
    const auto generated = records::read_record((bench.path() / "generated.csv").string());
    for (const char* const name : {"U", "TURN", "N"}) {
      for (std::size_t k = 0; k < run.size(); ++k) {
        const auto bits = [&](const records::Record& record) {
          const double value = record.column(name).values[k];
          return option.empty() ? std::bit_cast<std::uint64_t>(value)
                                : std::bit_cast<std::uint32_t>(static_cast<float>(value));
        };
        ASSERT_EQ(bits(run), bits(generated)) << name << option << " at step " << k;
      }
    }
  }
}

TEST(Generate, CompiledItWritesTheTextOfRun) {
  const test::Workbench bench;
  bench.write("scale.st",
              "FUNCTION_BLOCK SCALE (* @ts 1ms *) VAR_INPUT X : LREAL; END_VAR\n"
              "VAR_OUTPUT Y : LREAL; Z : LREAL; Q : BOOL; N : DINT; END_VAR\n"
              "Y := X;\nZ := X / 3.0;\nQ := X < 0.0;\nN := LREAL_TO_DINT(LIMIT(-9.0, X, 9.0));\nEND_FUNCTION_BLOCK\n");
  std::string log = "t,x\n";
  int row = 0;
  for (const char* const x :
       {"0", "-0.0", "1", "100000", "0.1", "1e-5", "9.999999e-6", "-2.1e-5", "1.25e-11", "5e-324", "123456.789",
        "9007199254740993", "9999999999999998", "1e16", "-1.7976931348623157e308"}) {
    log += fmt::format("{},{}\n", 0.001 * row++, x);
  }
  bench.write("log.csv", log);
  for (const std::string option : {"", " --float32"}) {
    ASSERT_EQ(bench.shell("hysteron generate scale.st --target cpp --out g" + option).code, 0);
    // Beyond the range of a 32-bit float, infinity is written, and said: exit code 1.
    ASSERT_EQ(bench.shell("hysteron run scale.st --in log.csv --out run.csv" + option).code, option.empty() ? 0 : 1);
    const auto built = bench.shell(
        "c++ -std=c++20 -O1 -ffp-contract=off -frounding-math g/main.cpp -o program && "
        "./program < log.csv > generated.csv");
    ASSERT_EQ(built.code, 0) << built.err;
    EXPECT_EQ(bench.read("generated.csv"), bench.read("run.csv")) << option;
  }
}

/// The generated main reads what a spreadsheet writes, and refuses what it would have to guess at.
TEST(Generate, TheMainRefusesBadRecordsWithLineAndCause) {
  const test::Workbench bench;
  bench.write("types.st",
              "FUNCTION_BLOCK TYPES (* @ts 1ms *) VAR_INPUT X : LREAL; B : BOOL := FALSE; N : DINT := 0; END_VAR\n"
              "VAR_OUTPUT Y : LREAL; END_VAR\n"
              "Y := SEL(B, X, -X) + DINT_TO_LREAL(N);\nEND_FUNCTION_BLOCK\n");
  ASSERT_EQ(bench.shell("hysteron generate types.st --target cpp --out g").code, 0);
  const auto built = bench.shell("c++ -std=c++20 -Wall -Wextra -Werror g/main.cpp -o program");
  ASSERT_EQ(built.code, 0) << built.err;
  const auto run = [&](const std::string& log) {
    bench.write("log.csv", log);
    return bench.shell("./program < log.csv");
  };
  const std::string expected = "t,Y\n0,1.5\n0.001,2\n";
  EXPECT_EQ(run("t,x\n0,1.5\n0.001,2\n").out, expected);
  EXPECT_EQ(run("\xEF\xBB\xBFt;\"X\";b\r\n0;+1.5;0\r\n0.001;2;0\r\n;;\r\n").out, expected);
  EXPECT_EQ(run("t\t x [V]\n0\t1.5\n0.001\t 2 \n").out, expected);
  struct Refused {
    std::string log;
    std::string message;
  };
  for (const auto& [log, message] : {
           Refused{"", "line 1: there is no column t\n"},
           Refused{"x\n1\n", "line 1: there is no column t\n"},
           Refused{"t,b\n0,1\n", "line 1: there is no column x\n"},
           Refused{"t,x,X\n0,1,1\n", "line 1: two columns are named x\n"},
           Refused{"t,x\n", "line 1: there is no row of numbers\n"},
           Refused{"t,x\n0,1\n0.001\n", "line 3: 1 columns, the header has 2\n"},
           Refused{"t,x\n0,one\n", "line 2: column x: 'one' is not a finite number\n"},
           Refused{"t,x\n0,nan\n", "line 2: column x: 'nan' is not a finite number\n"},
           Refused{"t,x\n0,inf\n", "line 2: column x: 'inf' is not a finite number\n"},
           Refused{"t,x\n0,1\n0.002,1\n", "line 3: t leaves the even steps of 0.001 s from the first row on\n"},
           Refused{"t,x\n0,1\n-0.001,1\n", "line 3: t leaves the even steps of 0.001 s from the first row on\n"},
           Refused{"t,x,n\n0,1,1.5\n", "line 2: column n takes whole numbers from -2147483648 to 2147483647\n"},
           Refused{"t,x,n\n0,1,3e9\n", "line 2: column n takes whole numbers from -2147483648 to 2147483647\n"},
           Refused{"t,x,b\n0,1,2\n", "line 2: column b takes whole numbers from 0 to 1\n"},
       }) {
    const auto outcome = run(log);
    EXPECT_EQ(outcome.code, 2) << log;
    EXPECT_EQ(outcome.err, message) << log;
    EXPECT_EQ(outcome.out, "") << log;
  }
}

TEST(Generate, BuildsAloneWithCMake) {
  const test::Workbench bench;
  bench.write("ff.st", feedforward);
  bench.write("log.csv", "t,y_ref\n0,1\n0.001,1\n");
  ASSERT_EQ(bench.shell("hysteron generate ff.st --target cpp --out g").code, 0);
  const auto built = bench.shell("cmake -S g -B b && cmake --build b && b/feedforward_run < log.csv");
  EXPECT_EQ(built.code, 0) << built.err;
  EXPECT_THAT(built.out, HasSubstr("\nt,U,TURN,N\n"));
}

TEST(Generate, ForeignFilesAreNotOverwritten) {
  const test::Workbench bench;
  bench.write("plant.st", test::plant);
  const std::string own = "cmake_minimum_required(VERSION 3.16)\nproject(mine)\n";
  bench.write("CMakeLists.txt", own);
  const auto before = bench.names();
  const auto refused = bench.shell("hysteron generate plant.st --target cpp --out .");
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.err, AllOf(HasSubstr("HY731"), HasSubstr("CMakeLists.txt"), HasSubstr("--force")));
  EXPECT_EQ(bench.names(), before);
  EXPECT_EQ(bench.read("CMakeLists.txt"), own);
  EXPECT_EQ(bench.shell("hysteron generate plant.st --target cpp --out . --force").code, 0);
  EXPECT_EQ(bench.shell("hysteron generate plant.st --target cpp --out .").code, 0);
}

TEST(Generate, NothingIsWrittenWhereSomethingFails) {
  const test::Workbench bench;
  bench.write("plant.st", test::plant);
  bench.write("g/main.cpp/in_the_way", "");
  const auto before = bench.names();
  const auto refused = bench.shell("hysteron generate plant.st --target cpp --out g");
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.err, HasSubstr("HY700"));
  EXPECT_EQ(bench.names(), before);
}

TEST(Generate, NeedsASampleTime) {
  const test::Workbench bench;
  bench.write("plant.st",
              "FUNCTION_BLOCK P VAR_INPUT X : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR\nY := X;\n"
              "END_FUNCTION_BLOCK\n");
  const auto refused = bench.shell("hysteron generate plant.st --target cpp --out g");
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.err, AllOf(HasSubstr("HY404"), HasSubstr("@ts")));
  EXPECT_FALSE(bench.has("g"));
}

TEST(Generate, WritesCAndStructuredTextByName) {
  const test::Workbench bench;
  bench.write("plant.st", test::plant);
  EXPECT_EQ(bench.shell("hysteron generate plant.st --target C --out c").out, "c/plant.h\nc/plant.c\n");
  EXPECT_EQ(bench.shell("hysteron generate plant.st --target st --out st").out, "st/plant.st\nst/plant_program.st\n");
  EXPECT_EQ(bench.shell("hysteron generate plant.st --target st --dialect TwinCAT --out t").out, "t/plant.TcPOU\n");
  EXPECT_EQ(bench.shell("hysteron generate plant.st --target st --dialect siemens-scl --out s").out, "s/plant.scl\n");
  EXPECT_THAT(bench.read("st/plant.st"),
              AllOf(HasSubstr("AMP_K : LREAL := 2.0;"), HasSubstr("(* SUM : HY_INTEGRAL *)"), HasSubstr("RESET_ALL")));
  ASSERT_EQ(bench.shell("hysteron generate plant.st --target st --float32 --out r").code, 0);
  EXPECT_THAT(bench.read("r/plant.st"), HasSubstr("AMP_K : REAL := 2.0;"));
}

/// The diagram has the name that the text would get.
TEST(Generate, DoesNotOverwriteTheDiagramByItsText) {
  const test::Workbench bench;
  bench.write("plant.st", test::plant);
  const auto refused = bench.shell("hysteron generate plant.st --target st --out . --force");
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.err, AllOf(HasSubstr("HY709"), HasSubstr("--out")));
  EXPECT_EQ(bench.read("plant.st"), test::plant);
  EXPECT_FALSE(bench.has("plant_program.st"));
}

TEST(Generate, AnUnknownTargetOrDialectIsNamed) {
  const test::Workbench bench;
  bench.write("plant.st", test::plant);
  const auto refused = [&](const std::string& options) {
    const auto outcome = bench.shell("hysteron generate plant.st --out g " + options);
    EXPECT_EQ(outcome.code, 2);
    EXPECT_FALSE(bench.has("g"));
    return outcome.err;
  };
  EXPECT_THAT(refused("--target rust"), AllOf(HasSubstr("HY730"), HasSubstr("cpp, c, batch, st")));
  EXPECT_THAT(refused("--target st --dialect rockwell"), AllOf(HasSubstr("HY730"), HasSubstr("siemens-scl")));
  EXPECT_THAT(refused("--target c --dialect codesys"), AllOf(HasSubstr("HY730"), HasSubstr("--target st")));
}

TEST(Compiled, SeveralProgramsInOneExecutable) {
  const Program plain = compile_text(std::string(feedforward));
  Program other = plain;
  other.graph.parameters[static_cast<std::size_t>(find_parameter(other.graph, "SMOOTH.T1"))].value = {0.02};
  const tool::CompiledPrograms compiled({{&plain, false}, {&other, false}, {&plain, true}});
  Drive drive{.inputs = {{}, {0.0}, {7.0}}, .steps = 500};
  for (std::size_t k = 0; k < drive.steps; ++k) {
    drive.inputs[0].push_back(std::cos(0.02 * static_cast<double>(k)) * 4.0);
  }
  const auto wires = output_wires(plain.graph);
  const auto interpreted = interpret(plain, drive, wires);
  EXPECT_EQ(compiled.run(0, drive), interpreted);
  EXPECT_EQ(compiled.run(1, drive), interpret(other, drive, wires));
  EXPECT_EQ(compiled.run(2, drive), interpret(plain, drive, wires, true));
  EXPECT_NE(compiled.run(1, drive)[0], interpreted[0]);
  EXPECT_EQ(interpreted[2], Signal(drive.steps, 20.0));
}

TEST(Compiled, FirstDifferenceCountsBits) {
  EXPECT_EQ(tool::first_difference({1.0, 2.0}, {1.0, 2.0}), tool::same_bits);
  EXPECT_EQ(tool::first_difference({1.0, 0.0}, {1.0, -0.0}), 1U);
  EXPECT_EQ(tool::first_difference({NAN}, {-NAN}), tool::same_bits);
  EXPECT_EQ(tool::first_difference({1.0, 2.0}, {1.0}), 1U);
}

/// One diagram in every target, each run beside the interpreter: the bits are the same.
TEST(GenerateCommand, AllTargetsHaveTheBitsOfTheInterpreter) {
  const test::Workbench bench;
  const std::string root = HYSTERON_SOURCE_DIR;
  for (const std::string diagram :
       {"/examples/04_piezo_stack/feedforward.st", "/examples/09_axis/axis.st", "/examples/03_feedforward/servo.st"}) {
    SCOPED_TRACE(diagram);
    const auto outcome = bench.shell("hysteron generate '" + root + diagram + "' --target all --out all --force");
    EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
    std::size_t equal = 0;
    for (auto at = outcome.out.find("2000  equal\n"); at != std::string::npos;
         at = outcome.out.find("2000  equal\n", at + 1)) {
      ++equal;
    }
    EXPECT_EQ(equal, 6U) << outcome.out;
  }
  EXPECT_TRUE(bench.has("all/fmu"));
}

}  // namespace
}  // namespace hysteron
