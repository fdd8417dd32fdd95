// hysteron tune, as a user runs it.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "support/numbers.hpp"
#include "tests/tool/workbench.hpp"

namespace hysteron {
namespace {

using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

constexpr std::string_view lagged = R"(FUNCTION_BLOCK LAGGED  (* @ts 10ms *)
  VAR_INPUT
    U : LREAL;  (* @unit V *)
  END_VAR
  VAR_OUTPUT
    Y : LREAL;  (* @unit mm *)
  END_VAR
  VAR
    AMP : HY_GAIN;
    BODY : HY_LAG := (T1 := 0.2);
  END_VAR

  AMP(XIN := U);
  BODY(XIN := AMP.XOUT);
  Y := BODY.XOUT;
END_FUNCTION_BLOCK
)";

constexpr std::string_view settings = R"([parameters.AMP]
K = 1.0

[parameters.BODY]
SETTLED = true
T1 = 0.2

[fit.AMP]
K = {min = 0.0}

[fit.BODY]
T1 = {max = 10.0}

[tune]
train = [0.0, 3.0]
test = [3.0, 4.0]
)";

/// A square wave, and what a lag of first order (1/(1 + s·T1), T1 = 0.5 s) with a gain of 3 gives for it, by hand:
/// exact where the input stands.
void write_log(const test::Workbench& bench, const std::string& name = "log.csv") {
  std::string text = "t,u\n";
  for (int k = 0; k < 400; ++k) {
    text += number_text(0.01 * k) + "," + (k / 50 % 2 == 0 ? "0" : "2") + "\n";
  }
  bench.write("inputs.csv", text);
  bench.write("truth.toml", "[parameters.AMP]\nK = 3.0\n[parameters.BODY]\nT1 = 0.5\n");
  ASSERT_EQ(bench.shell("hysteron run plant.st --in inputs.csv --out outputs.csv --params truth.toml").code, 0);
  // t,u from the one and y from the other, with a disturbance that no parameter explains
  ASSERT_EQ(bench
                .shell("paste -d, inputs.csv outputs.csv | awk -F, 'NR == 1 { print \"t,u,y\"; next } "
                       "{ printf \"%s,%s,%.12g\\n\", $1, $2, $4 + 0.01 * sin(12.9898 * NR * NR) }' > " +
                       name)
                .code,
            0);
}

constexpr std::string_view gain_alone =
    "FUNCTION_BLOCK P  (* @ts 1ms *)\n  VAR_INPUT U : LREAL; (* @unit V *) END_VAR\n"
    "  VAR_OUTPUT Y : LREAL; (* @unit um *) END_VAR\n  VAR AMP : HY_GAIN; END_VAR\n"
    "  AMP(XIN := U);\n  Y := AMP.XOUT;\nEND_FUNCTION_BLOCK\n";
constexpr std::string_view with_offset =
    "FUNCTION_BLOCK P  (* @ts 1ms *)\n  VAR_INPUT U : LREAL; END_VAR\n  VAR_OUTPUT Y : LREAL; END_VAR\n"
    "  VAR AMP : HY_GAIN; SHIFT : HY_OFFSET; END_VAR\n"
    "  AMP(XIN := U);\n  SHIFT(XIN := AMP.XOUT);\n  Y := SHIFT.XOUT;\nEND_FUNCTION_BLOCK\n";

class Tune : public testing::Test {
 protected:
  void SetUp() override {
    bench.write("plant.st", lagged);
    bench.write("p.toml", settings);
    write_log(bench);
  }
  test::Workbench bench;
};

/// What is shown where --params is missing is such a file, for this very diagram: it works as it stands.
TEST_F(Tune, ShowsTheFirstLinesOfAParameterFileWhereItIsMissing) {
  for (const char* const command : {"tune", "diagnose"}) {
    const auto refused = bench.shell(fmt::format("hysteron {} plant.st --log log.csv --out made", command));
    EXPECT_EQ(refused.code, 2);
    EXPECT_THAT(refused.err, HasSubstr("--params is missing, the file that names the parameters to be fitted"));
    std::istringstream said(refused.err);
    std::string lines;
    for (std::string line; std::getline(said, line);) {
      lines += line.starts_with("note: ") ? line.substr(6) + "\n" : "";
    }
    EXPECT_EQ(lines, "[fit.AMP]\nK = {}\n");
    bench.write("p.toml", lines);
  }
  const auto tuned = bench.shell("hysteron tune plant.st --log log.csv --params p.toml --out tuned.toml");
  EXPECT_EQ(tuned.code, 0) << tuned.err;
  EXPECT_THAT(bench.read("tuned.toml"), HasSubstr("[fit.AMP]"));
  // A diagram with nothing to fit is told so.
  bench.write("none.st",
              "FUNCTION_BLOCK N (* @ts 1ms *) VAR_INPUT U : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR Y := 2.0 * U; "
              "END_FUNCTION_BLOCK");
  EXPECT_THAT(bench.shell("hysteron tune none.st --log log.csv --out t.toml").err,
              HasSubstr("a parameter that a fit can move"));
}

TEST_F(Tune, PrintsAndWritesWhatItFound) {
  const auto outcome =
      bench.shell("hysteron tune plant.st --log log.csv --params p.toml --out tuned.toml --report report");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("AMP.K"), HasSubstr("mm/V"), HasSubstr("standard error"),
                                 HasSubstr("RMSE in train"), HasSubstr("RMSE in test"), HasSubstr("% of the range"),
                                 HasSubstr("The fit converged"), HasSubstr("iterations")));
  EXPECT_EQ(outcome.err, "");  // no progress line where there is no terminal
  const auto json = nlohmann::json::parse(bench.read("report/report.json"));
  for (const auto& parameter : json["parameters"]) {
    const double truth = parameter["name"] == "AMP.K" ? 3.0 : 0.5;
    const double error = parameter["standard_error"];
    EXPECT_NEAR(parameter["value"].get<double>(), truth, 5.0 * error);
    EXPECT_LT(error, 0.01 * truth);
  }
  EXPECT_NEAR(json["outputs"][0]["rmse_test"].get<double>(), 0.00707, 0.001);  // of the disturbance
  EXPECT_THAT(bench.read("tuned.toml"), AllOf(HasSubstr("SETTLED = true"), HasSubstr("train = [0.0, 3.0]"),
                                              HasSubstr("K = {min = 0.0}"), HasSubstr("standard error")));
}

TEST_F(Tune, ReportStandsAlone) {
  ASSERT_EQ(bench.shell("hysteron tune plant.st --log log.csv --params p.toml --out tuned.toml --report report").code,
            0);
  const auto page = bench.read("report/report.html");
  EXPECT_THAT(page,
              AllOf(HasSubstr("Residual of Y"), HasSubstr("AMP.K"), HasSubstr("Y [mm]"), HasSubstr("Train and test"),
                    HasSubstr("\"name\":\"train\""), HasSubstr("\"name\":\"test\"")));
  EXPECT_THAT(page, AllOf(Not(HasSubstr("://")), Not(HasSubstr("src=")), Not(HasSubstr("nan"))));
  EXPECT_THAT(bench.read("report/residuals.csv"), HasSubstr("t,Y [mm],Y_MODEL [mm],Y_RESIDUAL [mm]\n"));
}

/// What the fit leaves is more than noise, and the way on is named; the command runs as it stands.
TEST_F(Tune, WhatIsNotInTheModelLeadsToDiagnose) {
  bench.write("p.st", gain_alone);
  bench.write("p.toml", "[parameters.AMP]\nK = 1.0\n[fit.AMP]\nK = {}\n");
  std::string log = "t,U,Y\n";
  double play = 0.0;
  for (int k = 0; k < 2000; ++k) {
    const double u = 3.0 * std::sin(0.01 * k) + std::sin(0.037 * k);
    play = std::min(std::max(play, u - 0.5), u + 0.5);
    log += fmt::format("{},{},{}\n", 0.001 * k, u, 2.0 * play);
  }
  bench.write("a log.csv", log);
  const auto outcome =
      bench.shell("hysteron tune p.st --log 'a log.csv' --column U=2 --params p.toml --out tuned.toml --report report");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const std::string command =
      "hysteron diagnose p.st --log 'a log.csv' --params tuned.toml --out diagnosis --column U=2";
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("Y keeps an RMSE of "), HasSubstr("  " + command + "\n")));
  EXPECT_THAT(bench.read("report/report.html"),
              AllOf(HasSubstr("Something is not in the model"), HasSubstr("Y over U")));
  EXPECT_EQ(bench.shell(command).code, 0);
  // Of the improved diagram likewise: its own folder would be overwritten.
  ASSERT_EQ(bench.shell("cp p.st diagnosis/improved.st && cp p.toml diagnosis/improved.toml").code, 0);
  const auto again = bench.shell(
      "hysteron tune diagnosis/improved.st --log 'a log.csv' --column U=2 --params diagnosis/improved.toml --out "
      "final.toml");
  EXPECT_EQ(again.code, 0) << again.err;
  const std::string next =
      "hysteron diagnose diagnosis/improved.st --log 'a log.csv' --params final.toml --out diagnosis2 --column U=2";
  EXPECT_THAT(again.out, HasSubstr("  " + next + "\n"));
  EXPECT_EQ(bench.shell(next).code, 0);
}

/// At the start of one parameter, the RMSE of the page is that of a fit without it, where the model is linear in it.
TEST_F(Tune, TheCostOfAParameterIsThatOfAFitWithoutIt) {
  bench.write("p.st", with_offset);
  std::string log = "t,U,Y\n";
  for (int k = 0; k < 400; ++k) {
    const double u = std::sin(0.05 * k);
    log += fmt::format("{},{},{}\n", 0.001 * k, u, 2.0 * u + 0.3 + 0.2 * ((k * 7919) % 101 - 50) / 50.0);
  }
  bench.write("log.csv", log);
  const std::string gain = "[parameters.AMP]\nK = 1.0\n[parameters.SHIFT]\nBIAS = 0.0\n[fit.AMP]\nK = {}\n";
  bench.write("both.toml", gain + "[fit.SHIFT]\nBIAS = {}\n");
  bench.write("one.toml", gain);
  const auto rmse = [&](const std::string& file) {
    const auto outcome =
        bench.shell("hysteron tune p.st --log log.csv --params " + file + " --out t.toml --report r --json");
    return nlohmann::json::parse(outcome.out)["outputs"][0]["rmse_train"].get<double>();
  };
  const double without = rmse("one.toml");
  const double with = rmse("both.toml");
  EXPECT_THAT(bench.read("r/report.html"), HasSubstr(fmt::format("× {:.3g}<", without / with)));
}

TEST_F(Tune, FittedValuesRunAndTuneAgain) {
  ASSERT_EQ(bench.shell("hysteron tune plant.st --log log.csv --params p.toml --out tuned.toml --report report").code,
            0);
  const auto run = bench.shell(
      "hysteron run plant.st --in log.csv --out out.csv --params tuned.toml && "
      "tail -n +2 out.csv | cut -d, -f2 > a && "
      "tail -n +2 report/residuals.csv | cut -d, -f3 > b && cmp a b");
  EXPECT_EQ(run.code, 0) << run.out << run.err;  // the same bits in text
  EXPECT_EQ(bench.shell("hysteron generate plant.st --target cpp --out generated --params tuned.toml").code, 0);
  EXPECT_EQ(bench.shell("hysteron tune plant.st --log log.csv --params tuned.toml --out again.toml").code, 0);
  const auto first = nlohmann::json::parse(bench.read("report/report.json"));
  const auto again = nlohmann::json::parse(
      bench.shell("hysteron tune plant.st --log log.csv --params tuned.toml --out again.toml --json").out);
  for (std::size_t i = 0; i < 2; ++i) {
    const double value = first["parameters"][i]["value"];
    EXPECT_NEAR(again["parameters"][i]["value"].get<double>() / value, 1.0, 1e-8);
  }
}

constexpr std::string_view tank = R"(FUNCTION_BLOCK TANK  (* @ts 10ms *)
  VAR_INPUT
    Q : LREAL;  (* @unit l/s *)
  END_VAR
  VAR_OUTPUT
    LEVEL : LREAL;  (* @unit mm *)
  END_VAR
  VAR
    AREA : HY_GAIN;
    SUM  : HY_INTEGRAL;
  END_VAR

  AREA(XIN := Q);
  SUM(XIN := AREA.XOUT);
  LEVEL := SUM.XOUT;
END_FUNCTION_BLOCK
)";

/// A tank that is not empty when the record begins: LEVEL = start + 2.5·∫Q dt.
std::string tank_log(double start) {
  std::string text = "t,q,level\n";
  double sum = 0.0;
  for (int k = 0; k < 100; ++k) {
    const double q = 1.0 + k % 7;
    sum += 0.01 * 2.5 * q;
    text += number_text(0.01 * k) + "," + number_text(q) + "," + number_text(start + sum + (k % 2) * 1e-6) + "\n";
  }
  return text;
}

TEST_F(Tune, InitialStatesOfOneRecordAreStored) {
  bench.write("tank.st", tank);
  bench.write("log.csv", tank_log(3.0));
  bench.write("p.toml",
              "# the tank in the yard\n\n[fit.AREA]\nK = {}  # per area\n\n"
              "[tune]\ninitial_states = [\"SUM.SUM\"]\n");
  ASSERT_EQ(bench.shell("hysteron tune tank.st --log log.csv --params p.toml --out tuned.toml --report report").code,
            0);
  const auto text = bench.read("tuned.toml");
  EXPECT_THAT(text, AllOf(ContainsRegex("\n\\[initial.SUM\\]\nSUM = [^\n]*# mm, "), HasSubstr("K = {}  # per area\n"),
                          HasSubstr("\n# the tank in the yard\n")));
  // The run meets the record that the fit was made to, from its first sample on.
  const auto run = bench.shell(
      "hysteron run tank.st --in log.csv --out out.csv --params tuned.toml && "
      "tail -n +2 out.csv | cut -d, -f2 > a && tail -n +2 report/residuals.csv | cut -d, -f3 > b && cmp a b && "
      "head -n 1 a");
  ASSERT_EQ(run.code, 0) << run.out << run.err;
  EXPECT_NEAR(parse_number(run.out.substr(0, run.out.find('\n'))).value, 3.025, 1e-4);
  // What is tuned again begins there, and keeps one heading and one remark.
  ASSERT_EQ(bench.shell("hysteron tune tank.st --log log.csv --params tuned.toml --out again.toml").code, 0);
  const auto again = bench.read("again.toml");
  const auto count = [&](const std::string& part) {
    int found = 0;
    for (auto at = again.find(part); at != std::string::npos; at = again.find(part, at + 1)) {
      ++found;
    }
    return found;
  };
  EXPECT_EQ(count("Fitted by hysteron tune"), 1);
  EXPECT_EQ(count("standard error"), 2);
  EXPECT_EQ(count("# the tank in the yard"), 1);
}

TEST_F(Tune, InitialStatesOfSeveralRecordsStandInTheHeading) {
  bench.write("tank.st", tank);
  bench.write("a.csv", tank_log(3.0));
  bench.write("b.csv", tank_log(-7.0));
  bench.write("p.toml", "[fit.AREA]\nK = {}\n\n[tune]\ninitial_states = [\"SUM.SUM\"]\n");
  ASSERT_EQ(bench.shell("hysteron tune tank.st --log a.csv --log b.csv --params p.toml --out tuned.toml").code, 0);
  EXPECT_THAT(bench.read("tuned.toml"),
              AllOf(HasSubstr("# SUM.SUM at the start of record 1: 3.0"),
                    HasSubstr("# SUM.SUM at the start of record 2: -"), Not(HasSubstr("[initial"))));
}

TEST_F(Tune, InterruptLeavesTheBestSoFar) {
  // Thousands of starts take minutes. The signal goes once the tool, and no longer the shell that becomes it, catches
  // it: bit 1 of SigCgt is SIGINT.
  const auto outcome = bench.shell(
      "hysteron tune plant.st --log log.csv --params p.toml --out tuned.toml --start 100000 & pid=$!; "
      "while kill -0 $pid && ! { grep -q hysteron /proc/$pid/comm && "
      "awk '/SigCgt/ { exit !(substr($2, 16, 1) ~ /[2367abef]/) }' /proc/$pid/status; }; "
      "do sleep 0.02; done; kill -INT $pid; wait $pid");
  EXPECT_EQ(outcome.code, 130) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("The fit was cancelled; the best point so far is kept."));
  EXPECT_EQ(bench.shell("hysteron run plant.st --in log.csv --out out.csv --params tuned.toml").code, 0);
}

TEST_F(Tune, BadInputIsRefusedAndNothingIsWritten) {
  const auto refuse = [&](const std::string& arguments) {
    const auto outcome = bench.shell("hysteron tune " + arguments);
    EXPECT_EQ(outcome.code, 2) << outcome.out;
    EXPECT_FALSE(bench.has("tuned.toml"));
    return outcome.err;
  };
  bench.write("none.toml", "[parameters.AMP]\nK = 1.0\n");
  bench.write("wrong.toml", "[fit.AMP]\nG = {}\n");
  bench.write("late.toml", "[fit.AMP]\nK = {}\n[tune]\ntrain = [100.0, 200.0]\n");
  const std::string rest = " --log log.csv --out tuned.toml";
  EXPECT_THAT(refuse("plant.st --params none.toml" + rest), HasSubstr("HY716"));
  EXPECT_THAT(refuse("plant.st --params wrong.toml" + rest), AllOf(HasSubstr("HY603"), HasSubstr("wrong.toml:2")));
  EXPECT_THAT(refuse("plant.st --params late.toml" + rest), HasSubstr("HY718"));
  EXPECT_THAT(refuse("plant.st --params p.toml --log inputs.csv --out tuned.toml"), HasSubstr("HY717"));
  EXPECT_THAT(refuse("plant.st --params p.toml --log none.csv --out tuned.toml"), HasSubstr("HY100"));
  EXPECT_THAT(refuse("plant.st --params p.toml --log log.csv --out p.toml"), HasSubstr("HY709"));
  EXPECT_THAT(refuse("plant.st --params p.toml --log log.csv --out tuned.toml --start 0"), HasSubstr("HY730"));
}

/// A start from which the model overflows is shown where it is written.
TEST_F(Tune, AStartWithoutAValueHasAPlace) {
  bench.write("far.toml", "[parameters.AMP]\nK = 1.0\n[fit.AMP]\nK = {start = 1e308}\n");
  const auto outcome = bench.shell("hysteron tune plant.st --log log.csv --params far.toml --out tuned.toml");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, AllOf(testing::StartsWith("HY711 error: far.toml:4:"), HasSubstr("AMP.K = 1e308")));
  bench.write("far.toml",
              "[parameters.AMP]\nK = 1.0\n[fit.AMP]\nK = {start = 1e308}\n[fit.BODY]\nT1 = {start = 0.5}\n");
  EXPECT_THAT(bench.shell("hysteron tune plant.st --log log.csv --params far.toml --out tuned.toml").err,
              AllOf(testing::StartsWith("HY711 error: far.toml: "), HasSubstr("far.toml:4:1: AMP.K starts at 1e308"),
                    HasSubstr("far.toml:6:1: BODY.T1 starts at 0.5")));
}

/// What the end of the fit would fail on is said before it; a refused fit leaves nothing behind.
TEST_F(Tune, OutputsAreProvedBeforeTheFit) {
  bench.write("file", "");
  const auto refuse = [&](const std::string& outputs, const std::string& number) {
    const auto before = bench.names();
    const auto outcome = bench.shell("hysteron tune plant.st --log log.csv --params p.toml " + outputs);
    EXPECT_EQ(outcome.code, 2) << outputs;
    EXPECT_THAT(outcome.err, HasSubstr(number)) << outputs;
    EXPECT_EQ(bench.names(), before) << outputs;
    return outcome.err;
  };
  EXPECT_THAT(refuse("--out none/tuned.toml", "HY700"), HasSubstr("mkdir -p none"));
  refuse("--out tuned.toml --report file", "HY700");
  refuse("--out file/tuned.toml", "HY700");
  refuse("--out .", "HY700");
  bench.write("report.json", "[parameters.AMP]\nK = 1.0\n[fit.AMP]\nK = {}\n");
  const auto outcome =
      bench.shell("hysteron tune plant.st --log log.csv --params report.json --out tuned.toml --report .");
  EXPECT_THAT(outcome.err, HasSubstr("HY709"));
  ASSERT_EQ(bench.shell("mkdir old").code, 0);
  for (const char* const clash : {"--out t.toml --report t.toml", "--out t.toml --report ./t.toml/sub",
                                  "--out old/report.html --report old", "--out ./report.html --report ."}) {
    EXPECT_THAT(refuse(clash, "HY709"), HasSubstr("give another name for --out"));
  }
}

/// A record that is given twice would shrink the standard errors as if it had been measured twice.
TEST_F(Tune, CountsEachRecordOnce) {
  const auto before = bench.names();
  const std::string rest = " --params p.toml --out tuned.toml";
  const auto twice = bench.shell("hysteron tune plant.st --log log.csv --log log.csv" + rest);
  EXPECT_EQ(twice.code, 2);
  EXPECT_THAT(twice.err, AllOf(testing::StartsWith("HY730 error: log.csv: --log names the record log.csv twice."),
                               HasSubstr("mend: give each record once")));
  EXPECT_EQ(bench.names(), before);
  EXPECT_EQ(bench.shell("ln -s log.csv same.csv").code, 0);
  EXPECT_EQ(bench.shell("hysteron tune plant.st --log log.csv --log same.csv" + rest).code, 2);
  EXPECT_EQ(bench.shell("cp log.csv other.csv").code, 0);
  EXPECT_EQ(bench.shell("hysteron tune plant.st --log log.csv --log other.csv" + rest).code, 0);
}

TEST_F(Tune, IntervalsOfTrainAndTestAreHeldAgainstEachOtherAndTheRecord) {
  const auto with = [&](const std::string& intervals) {
    bench.write("i.toml", "[parameters.AMP]\nK = 1.0\n[fit.AMP]\nK = {}\n[tune]\n" + intervals);
    return bench.shell("hysteron tune plant.st --log log.csv --params i.toml --out tuned.toml");
  };
  EXPECT_THAT(with("test = [700.0, 800.0]\n").err, AllOf(HasSubstr("HY606 error: i.toml:6:"), HasSubstr("700 to 800")));
  EXPECT_THAT(with("train = [0.0, 3.0]\ntest = [2.0, 4.0]\n").err, AllOf(HasSubstr("HY606"), HasSubstr("overlap")));
  EXPECT_FALSE(bench.has("tuned.toml"));
  const auto rest = with("test = [3.0, 4.0]\n");
  EXPECT_EQ(rest.code, 0) << rest.err;
  EXPECT_THAT(rest.out, Not(HasSubstr("no test intervals"))) << "train is then what test leaves";
  EXPECT_THAT(rest.out, Not(HasSubstr("neither in train nor in test")));
  // The intervals of a template beside a longer record.
  const auto part = with("train = [0.0, 1.0]\ntest = [1.0, 2.0]\n");
  EXPECT_EQ(part.code, 0) << part.err;
  EXPECT_THAT(part.out,
              HasSubstr("samples of log.csv are neither in train nor in test of [tune]: the record goes from 0 s to"));
}

TEST_F(Tune, ABoundThatAParameterRanIntoIsNamed) {
  bench.write(
      "b.toml",
      "[parameters.AMP]\nK = 1.0\n[parameters.BODY]\nT1 = 0.2\n[fit.AMP]\nK = {max = 2.0}\n[fit.BODY]\nT1 = {}\n");
  const auto outcome = bench.shell("hysteron tune plant.st --log log.csv --params b.toml --out tuned.toml");
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("AMP.K ran into its upper bound, 2:"), HasSubstr("on its upper bound")));
}

TEST_F(Tune, WhatEachStartLeftIsTold) {
  const auto outcome = bench.shell("hysteron tune plant.st --log log.csv --params p.toml --out tuned.toml --start 3");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, ContainsRegex("The best of 3 starts was number [123]. What each left, in % of the range: "
                                         "1 [^;]+; 2 [^;]+; 3 .+. Number 1 is the file's own."));
}

TEST_F(Tune, HelpHasExamples) {
  const auto outcome = bench.shell("hysteron tune --help");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("Examples:"), HasSubstr("--report"), HasSubstr("130")));
}

}  // namespace
}  // namespace hysteron
