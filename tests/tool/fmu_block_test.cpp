// An FMU as a block: what it gives, what its pins are called, and what is said where it does not do its work.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "tests/tool/motor_bench.hpp"
#include "tests/tool/workbench.hpp"

namespace hysteron {
namespace {

using test::motor_loop;
using test::MotorBench;
using test::Workbench;
using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(FmuBlock, GivesItsOutputsOneStepAfterItsInputs) {
  const MotorBench bench;
  const auto done = bench.shell("hysteron run loop.st --in log.csv --out out.csv");
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_EQ(bench.read("out.csv"), "t,Y,COUNT,BUSY\n0,0,0,0\n0.001,0.002,1,1\n0.002,0.01,2,1\n0.003,0.0105,3,0\n");
  EXPECT_THAT(done.err, HasSubstr("the motor prints"));  // and so not among our own output
}

TEST(FmuBlock, TakesParametersFromTheTextAndFromAFile) {
  const MotorBench bench;
  bench.write("p.toml", "[parameters]\nGAIN = 4.0\n");
  ASSERT_EQ(bench.shell("hysteron run loop.st --in log.csv --out out.csv --params p.toml").code, 0);
  EXPECT_THAT(bench.read("out.csv"), HasSubstr("0.001,0.004,1,1\n"));
  bench.write("own.st", R"(FUNCTION_BLOCK OWN  (* @ts 1ms *)
  VAR_INPUT U : LREAL; END_VAR
  VAR_OUTPUT Y : LREAL; END_VAR
  VAR PLANT : HY_FMU := (GAIN := 3.0);  (* @file motor.fmu *) END_VAR
  Y := PLANT.Y;
  PLANT(U := U, MOTOR_N := 0, ON_1 := FALSE);
END_FUNCTION_BLOCK
)");
  ASSERT_EQ(bench.shell("hysteron run own.st --in log.csv --out out.csv").code, 0);
  EXPECT_THAT(bench.read("out.csv"), HasSubstr("0.001,0.003\n"));
  bench.write("p.toml", "[parameters.PLANT]\nGAIN = 5.0\n");
  const auto set = bench.shell("hysteron run own.st --in log.csv --out out.csv --params p.toml");
  ASSERT_EQ(set.code, 0) << set.err;
  EXPECT_THAT(bench.read("out.csv"), HasSubstr("0.001,0.005\n"));
}

/// A vector of a diagram comes back from its FMU as elements: by one array of FMI 3.0, or one by one in FMI 2.0.
TEST(FmuBlock, AnArrayHasAPinForEachElement) {
  const Workbench bench;
  bench.write("rack.st", R"(FUNCTION_BLOCK RACK  (* @ts 1ms *)
  VAR_INPUT
    X : ARRAY[0..2] OF LREAL;
    B : BOOL;
    K : ARRAY[0..2] OF LREAL := [1.0, 2.0, 3.0];  (* @param *)
  END_VAR
  VAR_OUTPUT
    Y : ARRAY[0..2] OF LREAL;
    SUM_OF : LREAL;
    Q : ARRAY[0..1] OF BOOL;
  END_VAR
  Y := X * K;
  SUM_OF := SUM(X);
  Q[0] := B;
  Q[1] := NOT B;
END_FUNCTION_BLOCK
)");
  bench.write("log.csv", "t,A\n0.000,1.0\n0.001,2.0\n0.002,3.0\n");
  for (const auto& [version, first] : {std::pair{"3", 1}, {"2", 0}}) {
    ASSERT_EQ(bench.shell(fmt::format("hysteron generate rack.st --target fmu --fmi {} --out .", version)).code, 0);
    const auto at = [&](const char* name, int i) { return fmt::format("{}_{}", name, first + i); };
    bench.write(
        "own.st",
        fmt::format(
            "FUNCTION_BLOCK OWN  (* @ts 1ms *)\n  VAR_INPUT A : LREAL; END_VAR\n  VAR_OUTPUT Y : LREAL; Z : LREAL; "
            "S : LREAL; Q : BOOL; END_VAR\n  VAR R : HY_FMU := ({5} := 5.0);  (* @file rack.fmu *) END_VAR\n"
            "  Y := R.{0};\n  Z := R.{1};\n  S := R.SUM_OF;\n  Q := R.{6};\n"
            "  R({2} := A, {3} := 10.0 * A, {4} := 100.0 * A, B := A > 1.5);\nEND_FUNCTION_BLOCK\n",
            at("Y", 0), at("Y", 2), at("X", 0), at("X", 1), at("X", 2), "K_2", at("Q", 0)));
    const auto done = bench.shell("hysteron run own.st --in log.csv --out out.csv");
    ASSERT_EQ(done.code, 0) << done.err;
    EXPECT_EQ(bench.read("out.csv"), "t,Y,Z,S,Q\n0,0,0,0,0\n0.001,1,500,111,0\n0.002,2,1000,222,1\n") << version;
  }
}

TEST(FmuBlock, ALoopGoesThroughIt) {
  const MotorBench bench;
  bench.write("closed.st", R"(FUNCTION_BLOCK CLOSED  (* @ts 1ms *)
  VAR_INPUT SP : LREAL; END_VAR
  VAR_OUTPUT Y : LREAL; END_VAR
  VAR PLANT : HY_FMU;  (* @file motor.fmu *) END_VAR
  Y := PLANT.Y;
  PLANT(U := 100.0 * (SP - PLANT.Y), MOTOR_N := 0, ON_1 := FALSE);
END_FUNCTION_BLOCK
)");
  bench.write("log.csv", "t,SP\n0.000,1.0\n0.001,1.0\n0.002,1.0\n");
  const auto done = bench.shell("hysteron run closed.st --in log.csv --out out.csv");
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_EQ(bench.read("out.csv"), "t,Y\n0,0\n0.001,0.2\n0.002,0.36\n");
}

TEST(FmuBlock, ASlowerOneStepsLonger) {
  const MotorBench bench;
  bench.write("slow.st", R"(FUNCTION_BLOCK SLOW  (* @ts 1ms *)
  VAR_INPUT U : LREAL; END_VAR
  VAR_OUTPUT Y : LREAL; END_VAR
  VAR
    TAKEN : HY_SAMPLE;  (* @every 2 *)
    PLANT : HY_FMU;  (* @file motor.fmu @every 2 *)
    HELD : HY_HOLD;
  END_VAR
  TAKEN(XIN := U);
  HELD(XIN := PLANT.Y);
  PLANT(U := TAKEN.XOUT, MOTOR_N := 0, ON_1 := FALSE);
  Y := HELD.XOUT;
END_FUNCTION_BLOCK
)");
  bench.write("log.csv", "t,U\n0.000,1.0\n0.001,1.0\n0.002,1.0\n0.003,1.0\n0.004,1.0\n");
  const auto done = bench.shell("hysteron run slow.st --in log.csv --out out.csv");
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_THAT(bench.read("out.csv"), HasSubstr("0.002,0.004\n0.003,0.004\n0.004,0.008\n"));
}

/// What the FMU does wrong, the number, and words of the message.
struct Misdeed {
  int mode;
  const char* number;
  const char* words;
};

TEST(FmuBlock, EachMisdeedIsAnErrorMessageAndNothingIsWritten) {
  const MotorBench bench;
  for (const Misdeed& one : {Misdeed{1, "HY752", "crashed (Segmentation fault) in the step from t = 0.002 s"},
                             Misdeed{2, "HY753", "took longer than 0.3 s in the step from t = 0.002 s"},
                             Misdeed{3, "HY751", "refuses in the step from t = 0.002 s: fmi2DoStep discards it"},
                             Misdeed{4, "HY751", "The FMU says: no convergence at u = 0.25"},
                             Misdeed{5, "HY752", "ended its process (exit code 7)"},
                             Misdeed{6, "HY750", "The FMU says: no start for gain 2"},
                             Misdeed{7, "HY751", "y of the FMU of PLANT gives nan at t = 0.003 s"}}) {
    bench.write("p.toml", fmt::format("[parameters.PLANT]\nMODE = {}\n", one.mode));
    const auto done =
        bench.shell("hysteron run loop.st --in log.csv --out out.csv --params p.toml --fmu-time-limit 0.3");
    EXPECT_EQ(done.code, 2) << one.mode;
    EXPECT_THAT(done.err, AllOf(HasSubstr(one.number), HasSubstr(one.words))) << one.mode;
    EXPECT_FALSE(bench.has("out.csv")) << one.mode;
  }
  bench.write("p.toml", "[parameters.PLANT]\nMODE = 9\n");  // a warning is none
  EXPECT_EQ(bench.shell("hysteron run loop.st --in log.csv --out out.csv --params p.toml").code, 0);
}

TEST(FmuBlock, IsGivenNoNumberThatIsNone) {
  const MotorBench bench;
  bench.write("log.csv", "t,u\n0.000,1.0\n0.001,inf\n");
  std::string text(motor_loop);
  text.replace(text.find("U := U,"), 7, "U := 1.0 / (U - 1.0),");
  bench.write("loop.st", text);
  bench.write("log.csv", "t,u\n0.000,0.0\n0.001,1.0\n0.002,1.0\n");
  const auto done = bench.shell("hysteron run loop.st --in log.csv --out out.csv");
  EXPECT_EQ(done.code, 2);
  EXPECT_THAT(done.err, HasSubstr("u of the FMU of PLANT is given inf at t = 0.001 s"));
}

TEST(FmuBlock, NoFolderAndNoProcessStays) {
  const MotorBench bench;
  std::filesystem::create_directories(bench.path() / "tmp");
  for (const int mode : {0, 1, 2, 3}) {
    bench.write("p.toml", fmt::format("[parameters.PLANT]\nMODE = {}\n", mode));
    (void)bench.shell(
        "TMPDIR=\"$PWD/tmp\" hysteron run loop.st --in log.csv --out out.csv --params p.toml --fmu-time-limit 0.2");
    EXPECT_TRUE(std::filesystem::is_empty(bench.path() / "tmp")) << mode;
  }
  const auto left = bench.shell("ls -l /proc/*/cwd 2>/dev/null | grep \"$PWD/tmp\"");
  EXPECT_EQ(left.out, "");
}

TEST(FmuBlock, TheWorkerEndsWithTheToolThatIsKilled) {
  const MotorBench bench;
  std::filesystem::create_directories(bench.path() / "tmp");
  bench.write("p.toml", "[parameters.PLANT]\nMODE = 2\n");
  const auto killed = bench.shell(
      "export TMPDIR=\"$PWD/tmp\"; timeout -s KILL 1 hysteron run loop.st --in log.csv --out out.csv --params p.toml; "
      "for i in 1 2 3 4 5 6 7 8 9 10; do sleep 0.2; "
      "ls -l /proc/*/cwd 2>/dev/null | grep -q \"$PWD/tmp\" || [ -n \"$(ls tmp)\" ] || exit 0; done; exit 1");
  EXPECT_EQ(killed.code, 0) << killed.err;
}

TEST(FmuBlock, ItsCardNamesPinsUnitsAndWhatIsLeftOut) {
  const MotorBench bench;
  const auto card = bench.shell("hysteron blocks motor.fmu");
  ASSERT_EQ(card.code, 0) << card.err;
  for (const char* const words :
       {"HY_FMU: Motor", "LREAL  N*m", "motor_n is motor.n of the FMU", "on_1 is on of the FMU", "y_2 is y_ of the FMU",
        "STEP_1 is STEP of the FMU", "label: its type is String", "rad/(N*m*s)", "of the motor", "FMU of FMI 2.0",
        "no input, so it can close a loop"}) {
    EXPECT_THAT(card.out, HasSubstr(words));
  }
}

TEST(FmuBlock, UnitsAndTypesAreThoseOfTheFmu) {
  const MotorBench bench;
  std::string text(motor_loop);
  text.replace(text.find("U : LREAL;"), 10, "U : LREAL;  (* @unit V *)");
  bench.write("loop.st", text);
  EXPECT_THAT(bench.shell("hysteron check loop.st").out, HasSubstr("HY301"));
  text = motor_loop;
  text.replace(text.find("MOTOR_N := N"), 12, "MOTOR_N := U");
  bench.write("loop.st", text);
  EXPECT_THAT(bench.shell("hysteron check loop.st").out, HasSubstr("HY207"));
}

TEST(FmuBlock, ASignalDrivesNoParameter) {
  const MotorBench bench;
  for (const char* const value : {"U", "2.0 * GAIN"}) {
    std::string text(motor_loop);
    text.replace(text.find("GAIN := GAIN"), 12, fmt::format("GAIN := {}", value));
    bench.write("loop.st", text);
    const auto checked = bench.shell("hysteron check loop.st");
    EXPECT_THAT(checked.out, AllOf(HasSubstr("HY207"), HasSubstr("gain is a parameter of an FMU"))) << value;
  }
}

/// More than a set of pins holds: a model of Modelica has hundreds.
TEST(FmuBlock, HasAsManyParametersAsItsModel) {
  const MotorBench bench;
  std::string xml(test::model_xml);
  std::string further;
  for (int i = 0; i < 100; ++i) {
    further += fmt::format(
        "<ScalarVariable name=\"part[{}].mass\" valueReference=\"6\" causality=\"parameter\" "
        "variability=\"fixed\"><Real start=\"9\"/></ScalarVariable>",
        i);
  }
  further +=
      "<ScalarVariable name=\"last.gain\" valueReference=\"4\" causality=\"parameter\"><Real start=\"2\"/>"
      "</ScalarVariable>";
  xml.insert(xml.find("</ModelVariables>"), further);
  test::write_motor(bench.path() / "motor.fmu", xml);
  bench.write("p.toml", "[parameters.PLANT]\nLAST_GAIN = 7.0\nPART_99_MASS = 3.0\n");
  const auto done = bench.shell("hysteron run loop.st --in log.csv --out out.csv --params p.toml");
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_THAT(bench.read("out.csv"), HasSubstr("0.001,0.007,1,1\n"));
}

TEST(FmuBlock, WhatCannotBeUsedIsToldWithItsReason) {
  const MotorBench bench;
  const auto with_xml = [&](std::string_view from, std::string_view to) {
    std::string xml(test::model_xml);
    xml.replace(xml.find(from), from.size(), to);
    test::write_motor(bench.path() / "motor.fmu", xml);
    return bench.shell("hysteron check loop.st").out;
  };
  EXPECT_THAT(with_xml("\"2.0\"", "\"1.0\""), AllOf(HasSubstr("HY219"), HasSubstr("FMI 1.0")));
  EXPECT_THAT(with_xml("CoSimulation", "ModelExchange"), HasSubstr("model exchange alone"));
  EXPECT_THAT(with_xml("canHandleVariableCommunicationStepSize=\"false\"", "needsExecutionTool=\"true\""),
              HasSubstr("needsExecutionTool"));
  EXPECT_THAT(with_xml("=\"motor\" can", "=\"../motor\" can"), HasSubstr("modelIdentifier"));
  EXPECT_THAT(with_xml("<ModelVariables>", "<ModelVariables"), HasSubstr("no XML"));
  bench.write("motor.fmu", "PK no archive");
  EXPECT_THAT(bench.shell("hysteron check loop.st").out, HasSubstr("HY219"));
  std::filesystem::remove(bench.path() / "motor.fmu");
  EXPECT_THAT(bench.shell("hysteron check loop.st").out, HasSubstr("There is no file motor.fmu"));
  std::string text(motor_loop);
  text.replace(text.find("(* @file motor.fmu *)"), 21, "");
  bench.write("loop.st", text);
  EXPECT_THAT(bench.shell("hysteron check loop.st").out, HasSubstr("names no file"));
}

TEST(FmuBlock, WhatCannotStartIsToldWithTheWayOut) {
  const MotorBench bench;
  const auto started = [&](const std::map<std::string, std::string>& files) {
    test::write_archive(bench.path() / "motor.fmu", files);
    return bench.shell("hysteron run loop.st --in log.csv --out out.csv").err;
  };
  const std::string xml(test::model_xml);
  EXPECT_THAT(started({{"modelDescription.xml", xml}, {"binaries/win64/motor.dll", ""}, {"sources/motor.c", ""}}),
              AllOf(HasSubstr("HY750"), HasSubstr("it has those of win64"), HasSubstr("cc -shared")));
  EXPECT_THAT(started({{"modelDescription.xml", xml}, {"binaries/linux64/motor.so", "no library"}}),
              AllOf(HasSubstr("HY750"), HasSubstr("its binary cannot be opened")));
  EXPECT_THAT(started({{"modelDescription.xml", xml},
                       {"binaries/linux64/motor.so", test::model_binary()},
                       {"resources/../../../outside.txt", "x"}}),
              AllOf(HasSubstr("HY219"), HasSubstr("leads out")));
  EXPECT_EQ(started({{"modelDescription.xml", xml},
                     {"binaries/linux64/motor.so", test::model_binary()},
                     {"resources/start.txt", "0.5"}}),
            "the motor prints\n");
  EXPECT_THAT(bench.read("out.csv"), HasSubstr("0.001,0.502,1,1\n"));  // its own files are there
}

TEST(FmuBlock, NoTargetAndNoServedTaskHasIt) {
  const MotorBench bench;
  for (const char* const target : {"cpp", "c", "st", "plcopen", "fmu"}) {
    const auto done = bench.shell(fmt::format("hysteron generate loop.st --target {} --out code", target));
    EXPECT_EQ(done.code, 2) << target;
    EXPECT_THAT(done.err, AllOf(HasSubstr("HY754"), HasSubstr("PLANT is the FMU"))) << target;
  }
  bench.write("loop.run.toml", "");
  EXPECT_THAT(bench.shell("hysteron serve loop.st --config loop.run.toml --engine interpreter").err,
              HasSubstr("HY754"));
  EXPECT_FALSE(bench.has("code"));
}

TEST(FmuBlock, OneOfItsOwnStepIsAskedForAMultiple) {
  const Workbench bench;
  bench.write("plant.st", test::plant);
  ASSERT_EQ(bench.shell("hysteron generate plant.st --target fmu --out .").code, 0);
  bench.write("loop.st", R"(FUNCTION_BLOCK LOOP  (* @ts 1500us *)
  VAR_INPUT X : LREAL; (* @unit V *) END_VAR
  VAR_OUTPUT Y : LREAL; (* @unit V*s *) END_VAR
  VAR PLANT : HY_FMU;  (* @file plant.fmu *) END_VAR
  Y := PLANT.Y;
  PLANT(X := X, RESET := FALSE);
END_FUNCTION_BLOCK
)");
  bench.write("log.csv", "t,X\n0.0000,1.0\n0.0015,1.0\n0.0030,1.0\n");
  const auto done = bench.shell("hysteron run loop.st --in log.csv --out out.csv");
  EXPECT_EQ(done.code, 2);
  EXPECT_THAT(done.err, AllOf(HasSubstr("HY750"), HasSubstr("no multiple of the 0.001 s")));
}

/// The rows of a record, each with what a run of it gave as its first output.
std::vector<std::pair<std::string, std::string>> rows_with_output(const std::string& record, const std::string& run) {
  std::istringstream inputs(record);
  std::istringstream outputs(run);
  std::string in;
  std::string out;
  std::getline(inputs, in);
  std::getline(outputs, out);
  std::vector<std::pair<std::string, std::string>> rows;
  while (std::getline(inputs, in) && std::getline(outputs, out)) {
    const auto first = out.find(',') + 1;
    rows.emplace_back(in, out.substr(first, out.find(',', first) - first));
  }
  return rows;
}

TEST(FmuBlock, TuneFindsItsParametersAndSaysWhatItCost) {
  const MotorBench bench;
  bench.write("p.toml", "[parameters]\nGAIN = 2.5\n");
  std::string rows = "t,u\n";
  for (int k = 0; k < 200; ++k) {
    rows += fmt::format("{:.3f},{:.6f}\n", 0.001 * k, std::sin(0.03 * k));
  }
  bench.write("log.csv", rows);
  ASSERT_EQ(bench.shell("hysteron run loop.st --in log.csv --out out.csv --params p.toml").code, 0);
  std::string measured = "t,u,y\n";
  for (const auto& [in, out] : rows_with_output(rows, bench.read("out.csv"))) {
    measured += in + "," + out + "\n";
  }
  bench.write("measured.csv", measured);
  // Mode 8 refuses every gain above 3: a point without a value, from which the fit has to come back.
  bench.write("fit.toml",
              "[parameters]\nGAIN = 0.3\n\n[parameters.PLANT]\nMODE = 8\n\n[fit]\nGAIN = {min = 0.1, max = "
              "50.0}\n\n[tune]\noutputs = [\"Y\"]\n");
  const auto tuned = bench.shell("hysteron tune loop.st --log measured.csv --params fit.toml --out tuned.toml");
  ASSERT_EQ(tuned.code, 0) << tuned.err << tuned.out;
  const std::string file = bench.read("tuned.toml");
  EXPECT_NEAR(std::stod(file.substr(file.find("GAIN = ") + 7)), 2.5, 1e-9);
  EXPECT_THAT(tuned.out, AllOf(HasSubstr("differences between instances"), HasSubstr("steps")));
}

/// A machine whose model is an FMU, with a play behind it that the model does not have.
TEST(FmuBlock, ADiagnosisNamesTheEffectAtItsOutput) {
  const Workbench bench;
  bench.write("plant.st", test::plant);
  ASSERT_EQ(bench.shell("hysteron generate plant.st --target fmu --out models").code, 0);
  const std::string head =
      "FUNCTION_BLOCK MACHINE  (* @ts 1ms *)\n  VAR_INPUT U : LREAL; (* @unit V *) GAIN : LREAL := 1.0; (* @param *) "
      "END_VAR\n  VAR_OUTPUT Y : LREAL; END_VAR\n  VAR PLANT : HY_FMU;  (* @file models/plant.fmu *)";
  bench.write("model.st",
              head + " END_VAR\n  Y := GAIN * PLANT.Y;\n  PLANT(X := U, RESET := FALSE);\nEND_FUNCTION_BLOCK\n");
  bench.write("truth.st", head +
                              " B : HY_BACKLASH := (WIDTH := 0.02); END_VAR\n  B(XIN := GAIN * PLANT.Y);\n  Y := "
                              "B.XOUT;\n  PLANT(X := U, RESET := FALSE);\nEND_FUNCTION_BLOCK\n");
  std::string rows = "t,U\n";
  for (int k = 0; k < 1500; ++k) {
    rows += fmt::format("{:.3f},{:.6f}\n", 0.001 * k, std::sin(0.02 * k) + 0.5 * std::sin(0.0071 * k));
  }
  bench.write("in.csv", rows);
  ASSERT_EQ(bench.shell("hysteron run truth.st --in in.csv --out out.csv").code, 0);
  std::string measured = "t,U,Y\n";
  std::uint32_t noise = 1;
  for (const auto& [in, out] : rows_with_output(rows, bench.read("out.csv"))) {
    noise = noise * 1664525U + 1013904223U;
    measured += fmt::format("{},{:.7f}\n", in, std::stod(out) + 2e-4 * (noise / 4294967296.0 - 0.5));
  }
  bench.write("log.csv", measured);
  bench.write("p.toml", "[parameters]\nGAIN = 1.0\n\n[fit]\nGAIN = {}\n");
  const auto found = bench.shell(
      "hysteron diagnose model.st --log log.csv --params p.toml --out diagnosis --effects backlash,creep,saturation "
      "--effort 0.2 --json");
  ASSERT_EQ(found.code, 0) << found.err;
  const auto verdict = nlohmann::json::parse(found.out);
  ASSERT_FALSE(verdict["effects"].empty()) << found.out;
  EXPECT_EQ(verdict["effects"][0]["id"], "backlash");
  EXPECT_THAT(bench.read("diagnosis/improved.st"), HasSubstr("(* @file ../models/plant.fmu *)"));
  const auto improved =
      bench.shell("cd diagnosis && hysteron run improved.st --in ../in.csv --params improved.toml --out again.csv");
  EXPECT_EQ(improved.code, 0) << improved.err;
}

}  // namespace
}  // namespace hysteron
