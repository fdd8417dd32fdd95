// What `hysteron record` says of a file, and what run and tune say of what they take from one.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/tool/workbench.hpp"

namespace hysteron {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr std::string_view plant =
    "FUNCTION_BLOCK P  (* @ts 1ms *)\n  VAR_INPUT U : LREAL := 0.5; (* @unit V *) END_VAR\n"
    "  VAR_OUTPUT Y : LREAL; (* @unit um *) END_VAR\n  VAR A : HY_GAIN := (K := 2.0); END_VAR\n"
    "  A(XIN := U);\n  Y := A.XOUT;\nEND_FUNCTION_BLOCK\n";
constexpr std::string_view parameters = "[parameters.A]\nK = 1.0\n[fit.A]\nK = {}\n";

TEST(RecordCommand, SaysWhatWasUnderstood) {
  const test::Workbench bench;
  bench.write("log.csv", "time [ms];u [mV];state\n0;0;a\n1;250;b\n2;250;c\n3;750;d\n");
  const auto text = bench.shell("hysteron record log.csv");
  EXPECT_EQ(text.code, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("4 rows every 0.001 s (1000 a second), from 0 s to 0.003 s"));
  EXPECT_THAT(text.out, HasSubstr("the time is column time, in ms"));
  EXPECT_THAT(text.out, HasSubstr("HY505: Column state holds no numbers: it begins with \"a\"."));
  const auto json = bench.shell("hysteron record log.csv --json");
  const auto found = nlohmann::json::parse(json.out);
  EXPECT_EQ(found.at("rows"), 4);
  EXPECT_EQ(found.at("columns").at(0).at("unit"), "mV");
  EXPECT_EQ(found.at("columns").at(0).at("resolution"), 250.0);
  EXPECT_NEAR(found.at("columns").at(0).at("repeats").get<double>(), 1.0 / 3.0, 1e-12);
  EXPECT_DOUBLE_EQ(found.at("columns").at(0).at("rest"), 0.001);
}

/// Lines between the readings of an encoder have steps of any size.
TEST(RecordCommand, ResamplingKeepsTheStepOfASensor) {
  const test::Workbench bench;
  std::string log = "t,y,on\n";
  for (int k = 0; k < 200; ++k) {
    log += fmt::format("{:.3f},{:.2f},{}\n", 0.005 * k + 0.002 * (k % 3 % 2), 0.05 * (k / 7), k / 50 % 2);
  }
  bench.write("log.csv", log);
  const auto outcome = bench.shell("hysteron record log.csv --resample linear --json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto columns = nlohmann::json::parse(outcome.out).at("columns");
  EXPECT_NEAR(columns.at(0).at("resolution").get<double>(), 0.05, 1e-9);
  EXPECT_GE(columns.at(0).at("noise").get<double>(), 0.9999 * 0.05 / std::sqrt(12.0));
  EXPECT_EQ(columns.at(1).at("resolution"), 1.0);
  EXPECT_LT(columns.at(1).at("noise").get<double>(), 0.02);
}

TEST(RecordCommand, DrawsItsColumns) {
  const test::Workbench bench;
  bench.write("log.csv", "t,u,y\n0,0,1\n1,1,2\n2,0,3\n");
  EXPECT_EQ(bench.shell("hysteron record log.csv --picture log.svg").code, 0);
  EXPECT_EQ(bench.shell("rsvg-convert log.svg -o log.png").code, 0);
  EXPECT_EQ(bench.shell("hysteron record log.csv --picture log.csv").code, 2);
  EXPECT_THAT(bench.read("log.csv"), HasSubstr("t,u,y"));
}

/// All that is uneven is shown, each kind once, and the record is refused all the same.
TEST(RecordCommand, UnevenTimesAreShownBeforeTheyAreRefused) {
  const test::Workbench bench;
  std::string log = "t,u,state\n";
  for (int k = 0; k < 60; ++k) {
    if (k != 20 && k != 21 && k != 40) {
      log += fmt::format("{:.3f},{},idle\n", 0.001 * k, k % 7);
    }
  }
  bench.write("log.csv", log);
  const auto shown = bench.shell("hysteron record log.csv");
  EXPECT_EQ(shown.code, 2);
  EXPECT_THAT(shown.out, HasSubstr("57 rows every 0.001 s"));
  EXPECT_THAT(
      shown.out,
      HasSubstr("2 gaps, in which some 3 rows are missing; the first is behind row 20, the longest lasts 0.003 s"));
  EXPECT_THAT(shown.out, HasSubstr("HY505: Column state holds no numbers"));
  EXPECT_THAT(shown.err, HasSubstr("HY507"));
  const auto json = nlohmann::json::parse(bench.shell("hysteron record log.csv --json").out);
  EXPECT_EQ(json.at("gaps"), 2);
  EXPECT_EQ(json.at("missing_rows"), 3);
  EXPECT_EQ(json.at("backward_rows"), 0);
  const auto whole = nlohmann::json::parse(bench.shell("hysteron record log.csv --resample hold --json").out);
  EXPECT_EQ(whole.at("gaps"), 0);
}

/// A stamp that came late or early leaves a long step and a short one, and no row is missing.
TEST(RecordCommand, AStrayStampIsNoGap) {
  const test::Workbench bench;
  std::string log = "t,u\n";
  for (int k = 0; k < 60; ++k) {
    const double off = k == 20 ? -0.0006 : k == 40 ? 0.0006 : k == 58 ? -0.0006 : 0.0;
    if (k != 30) {
      log += fmt::format("{:.4f},{}\n", 0.001 * k + off, k % 7);
    }
  }
  bench.write("log.csv", log);
  const auto json = nlohmann::json::parse(bench.shell("hysteron record log.csv --json").out);
  EXPECT_EQ(json.at("gaps"), 1) << "that of row 30";
  EXPECT_EQ(json.at("missing_rows"), 1);
  EXPECT_THAT(bench.shell("hysteron record log.csv").out, HasSubstr("the first is behind row 30"));
}

TEST(RecordCommand, SaysWhetherARecordExcitesWhatIsToBeFitted) {
  const test::Workbench bench;
  bench.write("p.st", plant);
  bench.write("p.toml", parameters);
  bench.write("log.csv", "t,u [mV],y\n0.000,0,0.01\n0.001,1000,3\n0.002,500,1.5\n0.003,-200,-0.6\n0.004,300,0.91\n");
  const auto shown = bench.shell("hysteron record log.csv --for p.st --params p.toml");
  EXPECT_EQ(shown.code, 0) << shown.err;
  EXPECT_THAT(shown.out, testing::ContainsRegex("A\\.K  .*1 um/V .* (well|weakly|no)\n"));
  EXPECT_THAT(shown.err, HasSubstr("was converted to V"));
  const auto json = nlohmann::json::parse(bench.shell("hysteron record log.csv --for p.st --params p.toml --json").out);
  EXPECT_EQ(json.at("excitation").at(0).at("name"), "A.K");
  EXPECT_EQ(json.at("columns").at(0).at("unit"), "mV") << "as the file has it";
  bench.write("odd.csv", "t,v\n0.000,0\n0.001,1\n0.002,0\n");
  const auto missing = bench.shell("hysteron record odd.csv --for p.st --params p.toml");
  EXPECT_EQ(missing.code, 2);
  EXPECT_THAT(missing.out, HasSubstr("3 rows every 0.001 s"));
  EXPECT_THAT(missing.err, HasSubstr("HY717"));
  EXPECT_THAT(bench.shell("hysteron record log.csv --for p.st").err, HasSubstr("--params p.toml"));
}

TEST(RecordCommand, UnitsOfARecordAreConverted) {
  const test::Workbench bench;
  bench.write("p.st", plant);
  bench.write("p.toml", parameters);
  bench.write("log.csv", "t,u [mV],y [nm]\n0.000,0,0\n0.001,1000,3000\n0.002,500,1500\n0.003,-200,-600\n");
  const auto outcome = bench.shell("hysteron tune p.st --log log.csv --params p.toml --out tuned.toml");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("note: log.csv: column u is in mV, and was converted to V: times 0.001\n"));
  EXPECT_THAT(bench.read("tuned.toml"), testing::ContainsRegex("K = (3\\.0|2\\.99999|3\\.00000)"));
  bench.write("odd.csv", "t,u [furlong],y\n0.000,0,0\n0.001,1,3\n0.002,0.5,1.5\n");
  EXPECT_THAT(bench.shell("hysteron run p.st --in odd.csv --out out.csv").err,
              HasSubstr("HY729 warning: odd.csv:2:7: The unit furlong of column u is not known"));
}

/// A misspelt input keeps its default, and nobody would see it.
TEST(RecordCommand, InputsWithoutAColumnAndColumnsWithoutAPortAreTold) {
  const test::Workbench bench;
  bench.write("p.st", plant);
  bench.write("p.toml", parameters);
  bench.write("log.csv", "t,Uu,y\n0.000,0,1\n0.001,1,1\n0.002,0.5,1\n");
  for (const std::string command : {"hysteron run p.st --in log.csv --out out.csv",
                                    "hysteron tune p.st --log log.csv --params p.toml --out tuned.toml"}) {
    const auto said = bench.shell(command).err;
    EXPECT_THAT(said, HasSubstr("note: log.csv: input U has no column, and keeps its default 0.5\n")) << command;
    EXPECT_THAT(said, HasSubstr("note: log.csv: columns not used: Uu\n")) << command;
  }
}

TEST(RecordCommand, WhatHoldsForAllRecordsStandsInTheParameterFile) {
  const test::Workbench bench;
  bench.write("p.st", plant);
  bench.write("p.toml",
              std::string(parameters) + "[record]\ntime = \"x[ms]\"\n[record.columns]\nU = \"MAIN.u\"\nY = 3\n");
  bench.write("log.csv", "x,MAIN.u,MAIN.y,z\n0,0,0,1\n1,1,3,1\n2,0.5,1.5,1\n3,-0.2,-0.6,1\n");
  EXPECT_EQ(bench.shell("hysteron tune p.st --log log.csv --params p.toml --out tuned.toml").code, 0);
  EXPECT_THAT(bench.read("tuned.toml"), HasSubstr("U = \"MAIN.u\""));
  const auto run = bench.shell("hysteron run p.st --in log.csv --params tuned.toml --out out.csv --summary");
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("RMSE against"));
  // A record of the inputs alone has no column for Y, and one of the simulator the names of the diagram.
  bench.write("drive.csv", "x,MAIN.u\n0,0\n1,1\n2,0.5\n");
  const auto driven = bench.shell("hysteron run p.st --in drive.csv --params tuned.toml --out out.csv");
  EXPECT_EQ(driven.code, 0) << driven.err;
  EXPECT_THAT(driven.err, HasSubstr("there is no column 3, which the parameter file names for Y"));
  bench.write("simulated.csv", "x,U\n0,0\n1,1\n2,0.5\n");
  EXPECT_EQ(bench.shell("hysteron run p.st --in simulated.csv --params tuned.toml --out out.csv").code, 0);
  EXPECT_EQ(bench.shell("hysteron run p.st --in drive.csv --params tuned.toml --column Y=3 --out out.csv").code, 2);
  const auto shown = bench.shell("hysteron record log.csv --params p.toml --column U=z");
  EXPECT_EQ(shown.code, 0) << shown.err;
  EXPECT_THAT(shown.out, HasSubstr("\nU "));
  bench.write("bad.toml", "[record]\ntmie = \"x\"\n[record.columns]\n\"a b\" = \"x\"\nU = true\n");
  const auto refused = bench.shell("hysteron record log.csv --params bad.toml").err;
  EXPECT_THAT(refused, HasSubstr("did you mean time?"));
  EXPECT_THAT(refused, HasSubstr("no name of a signal"));
  EXPECT_THAT(refused, HasSubstr("U must be a text"));
}

TEST(RecordCommand, OptionsThatSayNothingAreRefused) {
  const test::Workbench bench;
  bench.write("log.csv", "t,u\n0,0\n1,1\n2,0\n");
  for (const std::string option :
       {"--rate 0", "--rate fast", "--rate -1kHz", "--range 2", "--range 8s..2s", "--rows 0..5", "--rows 5..2",
        "--rows ..", "--column U", "--column =u", "--decimal dot", "--resample spline", "--range 1kg.."}) {
    const auto outcome = bench.shell("hysteron record log.csv '" + option.substr(0, option.find(' ')) + "' '" +
                                     option.substr(option.find(' ') + 1) + "'");
    EXPECT_EQ(outcome.code, 2) << option;
    EXPECT_THAT(outcome.err, HasSubstr("HY730")) << option;
  }
}

/// Whoever resamples from seconds that are milliseconds would make a thousand rows up for each.
TEST(RecordCommand, ResamplingDoesNotHideAWrongUnitOfTime) {
  const test::Workbench bench;
  bench.write("p.st", plant);
  bench.write("log.csv", "t,u\n0,0\n1,1\n2,0\n3,1\n");
  const auto outcome = bench.shell("hysteron run p.st --in log.csv --out out.csv --resample linear");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("if its times are in ms, say so: --time t[ms]"));
  EXPECT_EQ(bench.shell("hysteron run p.st --in log.csv --out out.csv --time 't[ms]'").code, 0);
}

/// An encoder is held, an analog signal lies on lines: said once in the parameter file, or by options.
TEST(RecordCommand, SignalsOfOneRecordAreResampledEachInItsWay) {
  const test::Workbench bench;
  bench.write("p.st", R"(FUNCTION_BLOCK PLANT  (* @ts 1ms *)
  VAR_INPUT
    U : LREAL;
    Q : LREAL;
    N : DINT;
  END_VAR
  VAR_OUTPUT
    Y : LREAL;
  END_VAR
  VAR
    AMP : HY_GAIN := (K := 2.0);
  END_VAR
  AMP(XIN := U + 0.0 * Q + DINT_TO_LREAL(0 * N));
  Y := AMP.XOUT;
END_FUNCTION_BLOCK
)");
  std::string log = "t,U,Q,N,Y\n";
  for (int k = 0; k < 300; ++k) {
    log += fmt::format("{:.6f},{:.4f},{},{},{:.4f}\n", 1e-3 * k + (k % 3 == 1 ? 2e-4 : 0.0), std::sin(0.05 * k), k / 4,
                       k / 9, 2.2 * std::sin(0.05 * k));
  }
  bench.write("log.csv", log);
  const std::string ways = "[record]\nresample = {Q = \"hold\", U = \"linear\", \"*\" = \"average\"}\n";
  bench.write("p.toml", "[fit.AMP]\nK = {}\n\n" + ways);
  bench.write("plain.toml", "[fit.AMP]\nK = {}\n");
  for (const auto& [files, options] : {std::pair<std::string, std::string>{"p.toml", ""},
                                       {"plain.toml", " --resample average --resample Q=hold --resample U=linear"}}) {
    for (const std::string command :
         {"run p.st --in log.csv --out out.csv --params ", "tune p.st --log log.csv --out tuned.toml --params ",
          "record log.csv --for p.st --params ", "plot log.csv --out log.svg --params ",
          "compare log.csv log.csv --params ", "diagnose p.st --log log.csv --out d --params "}) {
      const auto outcome = bench.shell("hysteron " + command + files + options);
      const std::string said = outcome.out + outcome.err;
      EXPECT_EQ(outcome.code, 0) << command << said;
      EXPECT_THAT(said, HasSubstr("U: linear; 0 rows made up in gaps; a row lies up to ")) << command;
      EXPECT_THAT(said, HasSubstr("Q: hold; 0 rows made up in gaps; a row lies up to ")) << command;
    }
  }
  EXPECT_THAT(bench.read("tuned.toml"), Not(HasSubstr("record")));
  // N is DINT: for the diagram it is held, and a line is refused.
  EXPECT_THAT(bench.shell("hysteron run p.st --in log.csv --params p.toml --out out.csv").err,
              HasSubstr("N: hold, as nothing lies between two values"));
  const auto line = bench.shell("hysteron run p.st --in log.csv --resample linear --resample N=linear --out out.csv");
  EXPECT_EQ(line.code, 2);
  EXPECT_THAT(line.err, HasSubstr("mend: hold the last one: --resample N=hold."));
  // An option goes before the file; what was slipped in the file is told at its place.
  EXPECT_THAT(bench.shell("hysteron record log.csv --params p.toml --resample Q=linear").out,
              HasSubstr("U, Q: linear"));
  bench.write("bad.toml", "[record]\nresample = {Q = \"hodl\"}\n");
  EXPECT_THAT(bench.shell("hysteron record log.csv --params bad.toml").err,
              HasSubstr("bad.toml:2:17: resample = \"Q=hodl\" in [record] cannot be read."));
}

}  // namespace
}  // namespace hysteron
