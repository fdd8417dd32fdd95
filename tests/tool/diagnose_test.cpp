// hysteron diagnose, as a user runs it.
#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "records/csv.hpp"
#include "records/read.hpp"
#include "tests/diagnosis/simulated_machine.hpp"
#include "tests/tool/workbench.hpp"

namespace hysteron {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsSupersetOf;
using testing::Not;

constexpr double noise = 0.001;

const std::string command =
    "hysteron diagnose plant.st --log log.csv --params p.toml --out found --effects load,drift,lag";

/// An axis with a load that the diagram does not know.
class Diagnose : public testing::Test {
 protected:
  void SetUp() override {
    bench.write("plant.st", test::axis());
    bench.write("p.toml", test::axis_parameters);
    bench.write("log.csv", records::csv_text(record()));
  }

  static records::Record record(double load = 0.3) {
    const std::string machine = test::axis({fmt::format("HY_LOAD := (SIZE := {:.1f}, T_ON := 2.0)", load), "FORCE"});
    return test::measured(test::program_of(machine), test::record_of("FORCE", test::rich_force(1200)), noise);
  }

  static std::string without_time(std::string text) {
    json verdict = json::parse(text);
    verdict["seconds"] = 0.0;
    return verdict.dump();
  }

  [[nodiscard]] test::Outcome with_log(const records::Record& log) const {
    bench.write("bad.csv", records::csv_text(log));
    return bench.shell("hysteron diagnose plant.st --log bad.csv --params p.toml --out bad --effects load");
  }

  test::Workbench bench;
};

TEST_F(Diagnose, NamesTheEffectAndWritesWhatItFound) {
  const auto outcome = bench.shell(command);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("load at "), HasSubstr("Verdict: "), HasSubstr("SIZE"), HasSubstr("T_ON"),
                                 HasSubstr("m/s"), HasSubstr("closed"), HasSubstr("candidates")));
  EXPECT_THAT(bench.names(), IsSupersetOf({"found/verdict.json", "found/improved.st", "found/improved.toml",
                                           "found/report.html", "found/traces.csv"}));
  const json verdict = json::parse(bench.read("found/verdict.json"));
  EXPECT_EQ(verdict["schema"], "hysteron-verdict/1");
  EXPECT_EQ(verdict["effects"][0]["id"], "load");
  EXPECT_EQ(verdict["refused"], false);
  const json& size = verdict["effects"][0]["parameters"]["SIZE"];
  EXPECT_NEAR(size["value"].get<double>(), 0.3, 0.02);
  EXPECT_LT(size["low"], size["high"]);
  EXPECT_NEAR(verdict["gap"]["improved_rms"].get<double>(), noise, 0.1 * noise);
}

TEST_F(Diagnose, TheImprovedDiagramChecksRunsAndGenerates) {
  ASSERT_EQ(bench.shell(command).code, 0);
  const auto check = bench.shell("hysteron check found/improved.st && hysteron fmt --check found/improved.st");
  EXPECT_EQ(check.code, 0) << check.out << check.err;
  const auto run =
      bench.shell("hysteron run found/improved.st --in log.csv --out out.csv --params found/improved.toml");
  ASSERT_EQ(run.code, 0) << run.err;
  const auto model = records::parse_record("out.csv", bench.read("out.csv")).column("V").values;
  const auto measured = record().column("V").values;
  ASSERT_EQ(model.size(), measured.size());
  double squares = 0.0;
  for (std::size_t k = 0; k < model.size(); ++k) {
    squares += (model[k] - measured[k]) * (model[k] - measured[k]);
  }
  const double improved = json::parse(bench.read("found/verdict.json"))["gap"]["improved_rms"];
  EXPECT_NEAR(std::sqrt(squares / static_cast<double>(model.size())), improved, 1e-9 * improved);
  const auto generated =
      bench.shell("hysteron generate found/improved.st --target cpp --out code --params found/improved.toml");
  EXPECT_EQ(generated.code, 0) << generated.err;
}

TEST_F(Diagnose, TheImprovedDiagramHasNoGapLeft) {
  ASSERT_EQ(bench.shell(command).code, 0);
  const auto again = bench.shell(
      "hysteron diagnose found/improved.st --log log.csv --params found/improved.toml --out again "
      "--effects creep,drift,lag --json");
  ASSERT_EQ(again.code, 0) << again.err;
  EXPECT_EQ(json::parse(again.out)["verdict"], "none") << again.out;
}

TEST_F(Diagnose, TracesAreThoseOfTheRecord) {
  ASSERT_EQ(bench.shell(command).code, 0);
  const auto traces = records::parse_record("traces.csv", bench.read("found/traces.csv"));
  EXPECT_THAT(traces.names(), testing::ElementsAre("V_measured", "V_nominal", "V_calibrated", "V_improved"));
  EXPECT_EQ(traces.column("V_measured").values, record().column("V").values);
  const auto nominal = simulate(test::program_of(test::axis()), record())[0];
  double difference = 0.0;
  for (std::size_t k = 0; k < nominal.size(); ++k) {
    difference = std::max(difference, std::abs(nominal[k] - traces.column("V_nominal").values[k]));
  }
  EXPECT_LT(difference, 1e-12);
}

/// The natural second step: what was found is diagnosed, into the folder where it lies. Each file that a diagnosis
/// writes is tried as each input; nothing is lost, and nothing is computed first.
TEST_F(Diagnose, OverwritesNoneOfItsInputs) {
  ASSERT_EQ(bench.shell(command).code, 0);
  std::vector<std::string> written;
  for (const std::string& name : bench.names()) {
    if (name.starts_with("found/") && !std::filesystem::is_directory(bench.path() / name)) {
      written.push_back(name);
    }
  }
  ASSERT_GE(written.size(), 5U);
  const auto refused = [&](const std::string& line, const std::string& input, const std::string& named) {
    const std::string before = bench.read(input);
    const auto outcome = bench.shell("hysteron diagnose " + line);
    EXPECT_EQ(outcome.code, 2) << line;
    EXPECT_THAT(outcome.err,
                AllOf(testing::StartsWith("HY709 error: "), HasSubstr("would overwrite the input " + input),
                      HasSubstr(named), HasSubstr("mend: give another folder for --out.")))
        << line;
    EXPECT_EQ(outcome.out, "") << line;
    EXPECT_EQ(bench.read(input), before) << line;
  };
  const std::string to = " --out found --effects load";
  for (const std::string& file : written) {
    refused(file + " --log log.csv --params p.toml" + to, file, "");
    refused("plant.st --log " + file + " --params p.toml" + to, file, "which --log names");
    refused("plant.st --log log.csv --params " + file + to, file, "which --params names");
    const std::string rest = "plant.st --log log.csv --params p.toml" + to;
    refused(rest + " --trace " + file + " --controller c.st", file, "which --trace names");
    refused(rest + " --trace run.trace --controller " + file, file, "which --controller names");
    refused(rest + " --trace run.trace --controller c.st --controller-params " + file, file, "--controller-params");
  }
  ASSERT_EQ(bench.shell("ln -s found/traces.csv linked.csv && ln -s found link").code, 0);
  refused("plant.st --log linked.csv --params p.toml --out link --effects load", "linked.csv", "--log");
  bench.write("kept/traces2.csv", bench.read("log.csv"));
  refused("plant.st --log log.csv --log kept/traces2.csv --params p.toml --out kept", "kept/traces2.csv", "--log");
}

TEST_F(Diagnose, CountsEachRecordOnce) {
  const auto refused =
      bench.shell("hysteron diagnose plant.st --log log.csv --log ./log.csv --params p.toml --out twice");
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.err, testing::StartsWith("HY730 error: ./log.csv: --log names one record as log.csv and as "));
  EXPECT_FALSE(bench.has("twice"));
}

TEST_F(Diagnose, PrintsTheVerdictAsJson) {
  const auto outcome = bench.shell(command + " --json");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.out, bench.read("found/verdict.json"));
}

TEST_F(Diagnose, IsTheSameEachTimeForASeed) {
  ASSERT_EQ(bench.shell(command + " --seed 7").code, 0);
  std::vector<std::string> first;
  const std::vector<std::string> files{"improved.st", "improved.toml", "traces.csv"};
  for (const std::string& file : files) {
    first.push_back(bench.read("found/" + file));
  }
  const std::string verdict = without_time(bench.read("found/verdict.json"));
  ASSERT_EQ(bench.shell(command + " --seed 7").code, 0);  // into the same folder
  EXPECT_EQ(without_time(bench.read("found/verdict.json")), verdict);
  for (std::size_t i = 0; i < files.size(); ++i) {
    EXPECT_EQ(bench.read("found/" + files[i]), first[i]) << files[i];
  }
}

TEST_F(Diagnose, TouchesNothingOutsideItsFolder) {
  bench.write("found/notes.txt", "mine");
  bench.write("verdict.json", "mine too");
  const std::string plant = bench.read("plant.st");
  const std::string parameters = bench.read("p.toml");
  auto before = bench.names();
  ASSERT_EQ(bench.shell(command).code, 0);
  EXPECT_EQ(bench.read("plant.st"), plant);
  EXPECT_EQ(bench.read("p.toml"), parameters);
  EXPECT_EQ(bench.read("found/notes.txt"), "mine");
  EXPECT_EQ(bench.read("verdict.json"), "mine too");
  for (const std::string& name : bench.names()) {
    EXPECT_TRUE(before.contains(name) || name.starts_with("found/")) << name;
  }
}

/// A heater with two inputs, of which one rests, and a drag of its flow that closes a loop.
constexpr const char* cooled = R"(FUNCTION_BLOCK COOLED  (* @ts 5ms *)
  VAR_INPUT
    FORCE : LREAL;  (* @unit N *)
    WIND  : LREAL;  (* @unit m/s *)
  END_VAR
  VAR_OUTPUT
    V : LREAL;  (* @unit m/s *)
  END_VAR
  VAR
    MASS  : HY_GAIN := (K := 0.5);
    SPEED : HY_LAG  := (T1 := 0.5);
  END_VAR

  MASS(XIN := FORCE);
  SPEED(XIN := MASS.XOUT);
  V := SPEED.XOUT + WIND;
END_FUNCTION_BLOCK
)";

TEST_F(Diagnose, WhatClosesALoopIsTakenByEveryCommandAndItsExperimentIsReadyToBePlayed) {
  std::string machine = cooled;
  machine.replace(machine.find("XIN := FORCE"), 12, "XIN := DRAG.XOUT");
  machine.replace(machine.find("  END_VAR\n\n"), 0,
                  "    DRAG : HY_VISCOUS_FRICTION := (QUADRATIC := 0.8);\n    LATE : HY_DELAY;\n");
  machine.replace(machine.find("END_FUNCTION_BLOCK"), 0,
                  "  DRAG(XIN := FORCE, V := LATE.XOUT);\n  LATE(XIN := SPEED.XOUT);\n");
  records::Record drive = test::record_of("FORCE", test::rich_force(1200));
  drive.add({.name = "WIND", .values = std::vector<double>(1200, 0.25)});
  bench.write("plant.st", cooled);
  bench.write("p.toml", "[parameters.MASS]\nK = 0.5\n[fit.MASS]\nK = {}\n");
  bench.write("log.csv", records::csv_text(test::measured(test::program_of(machine), std::move(drive), noise)));
  const auto outcome = bench.shell(
      "hysteron diagnose plant.st --log log.csv --params p.toml --out found --effects viscous_friction,drift");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  ASSERT_THAT(outcome.out, HasSubstr("viscous_friction at "));
  EXPECT_THAT(outcome.out, Not(HasSubstr("would differ"))) << "nothing is compared where there is no rival";
  for (const char* line :
       {"hysteron check found/improved.st",
        "hysteron run found/improved.st --in log.csv --out out.csv --params found/improved.toml",
        "hysteron tune found/improved.st --log log.csv --params found/improved.toml --out tuned.toml",
        "hysteron run found/improved.st --in found/next_experiment.csv --out played.csv --params "
        "found/improved.toml"}) {
    const auto again = bench.shell(line);
    EXPECT_LT(again.code, 2) << line << "\n" << again.err;  // 1: tuned, and not to the last digit
  }
  const auto next = records::parse_record("next.csv", bench.read("found/next_experiment.csv"));
  EXPECT_EQ(next.column("WIND").values, std::vector<double>(next.size(), 0.25)) << "where it stood";
}

TEST_F(Diagnose, LeavesNoFileOfAnEarlierVerdict) {
  ASSERT_EQ(bench.shell(command).code, 0);
  bench.write("found/traces_of_mine.csv", "mine");
  bench.write("found/traces7.csv", "of three records");
  bench.write("short.csv", records::csv_text(record().slice({0, 60})));
  ASSERT_EQ(bench.shell("hysteron diagnose plant.st --log short.csv --params p.toml --out found").code, 1);
  std::vector<std::string> left;
  for (const std::string& name : bench.names()) {
    if (name.starts_with("found/")) {
      left.push_back(name);
    }
  }
  EXPECT_THAT(left,
              testing::UnorderedElementsAre("found/report.html", "found/traces_of_mine.csv", "found/verdict.json"));
}

TEST_F(Diagnose, ALimitIsHeldAgainstTheDiagram) {
  const struct {
    const char* limits;
    const char* cause;
    const char* mend;
  } cases[] = {{"--limit FORSE=1", "the diagram has no real input FORSE", "did you mean FORCE?"},
               {"--limit V=1", "the diagram has no real input V", "its inputs are FORCE"},
               {"--limit FORCE=-1", "leaves the input no room", "a size above 0"},
               {"--limit FORCE.rate=0", "leaves the input no room", "a size above 0"},
               {"--limit FORCE.most=1", "limits no part of an input", "U.low, U.high or U.rate"},
               {"--limit FORCE=1 --limit force=2", "names force twice", "give each limit once"},
               {"--limit FORCE.low=2 --limit FORCE.high=1", "its upper end 1", "low below high"}};
  for (const auto& one : cases) {
    const auto outcome =
        bench.shell(std::string("hysteron diagnose plant.st --log log.csv --params p.toml --out bad ") + one.limits);
    EXPECT_EQ(outcome.code, 2) << one.limits;
    EXPECT_THAT(outcome.err, AllOf(testing::StartsWith("HY730 error: "), HasSubstr(one.cause), HasSubstr(one.mend)));
    EXPECT_FALSE(bench.has("bad"));
  }
}

TEST_F(Diagnose, AColumnThatIsIgnoredIsNoCause) {
  bench.write("log.csv", records::csv_text(test::warm_sensor()));
  const std::string line =
      "hysteron diagnose plant.st --log log.csv --params p.toml --out found --effects cross_coupling,drift --most 1 ";
  ASSERT_EQ(bench.shell(line).code, 0);
  EXPECT_EQ(json::parse(bench.read("found/verdict.json"))["effects"][0]["id"], "cross_coupling");
  const auto ignored = bench.shell(line + "--ignore temp");
  ASSERT_EQ(ignored.code, 0) << ignored.err;
  EXPECT_THAT(bench.read("found/verdict.json"), Not(HasSubstr("cross_coupling")));
  EXPECT_THAT(bench.read("found/improved.toml"), HasSubstr("ignore = [\"temp\"]"));

  bench.write("q.toml", std::string(test::axis_parameters) + "[diagnose]\nignore = [\"TEMP\"]\n");
  const auto listed = bench.shell(
      "hysteron diagnose plant.st --log log.csv --params q.toml --out other --effects cross_coupling --most 1");
  ASSERT_EQ(listed.code, 0) << listed.err;
  EXPECT_THAT(bench.read("other/verdict.json"), Not(HasSubstr("cross_coupling")));

  const auto slip = bench.shell(line + "--ignore tmep");
  EXPECT_EQ(slip.code, 2);
  EXPECT_THAT(slip.err, AllOf(HasSubstr("HY502 error: "), HasSubstr("did you mean temp?")));
}

TEST_F(Diagnose, AParameterThatWasTunedIntoItsBoundIsRemarkedOn) {
  bench.write("p.toml", "[parameters.MASS]\nK = 0.5\n[fit.MASS]\nK = {max = 0.5}\n");
  const auto outcome = bench.shell(command);
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("note: MASS.K = 0.5 lies on the upper bound of its fit"));
}

TEST_F(Diagnose, WhatCutTheSearchIsTold) {
  // Without the load among the effects there is always something left that a second one might close.
  const std::string without =
      "hysteron diagnose plant.st --log log.csv --params p.toml --out found --effects drift,lag,gain_drift,offset";
  const auto ended = bench.shell(without + " --effort 0.000001");
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_THAT(ended.out, AllOf(HasSubstr("note: The search ended after "), HasSubstr("--effort 2e-06 goes on")));
  const auto cut = bench.shell(without + " --time-limit 0.000001");
  ASSERT_EQ(cut.code, 0) << cut.err;
  EXPECT_THAT(cut.out, AllOf(HasSubstr("note: The time limit of 1e-06 s cut the search after "),
                             HasSubstr("without --time-limit it gives the same")));
  EXPECT_THAT(bench.shell(without).out, AllOf(Not(HasSubstr("cut the search")), Not(HasSubstr("The search ended"))));
}

TEST_F(Diagnose, AFolderThatTakesNoFilesIsRefusedFirst) {
  // Root may write into /proc by its permissions, and cannot. A log that is not there shows that nothing was read.
  const auto outcome = bench.shell("hysteron diagnose plant.st --log none.csv --params p.toml --out /proc/foo");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, AllOf(testing::StartsWith("HY700 error: /proc/foo: Nothing can be written into /proc"),
                                 HasSubstr("choose a folder")));
  ASSERT_EQ(bench.shell("mkdir kept").code, 0);
  const auto before = bench.names();
  EXPECT_EQ(bench.shell("hysteron diagnose plant.st --log none.csv --params p.toml --out kept").code, 2);
  EXPECT_EQ(bench.names(), before) << "the trial leaves nothing";
}

TEST_F(Diagnose, RefusesARecordThatCannotBeDiagnosed) {
  const auto flip = [](std::vector<double>& v) {
    for (double& one : v) {
      one = -one;
    }
  };
  const auto kilo = [](std::vector<double>& v) {
    for (double& one : v) {
      one *= 1000.0;
    }
  };
  const auto stand = [](std::vector<double>& v) { std::ranges::fill(v, 1.0); };
  const struct {
    records::Record log;
    const char* reason = nullptr;
  } cases[] = {{record().slice({0, 60}), "60 samples"},
               {test::changed(record(), "FORCE", stand), "No input moves"},
               {test::changed(record(), "V", stand), "never changes"},
               {test::changed(record(), "V", flip), "mirrored"},
               {test::changed(record(0.0), "V", kilo), "units"}};
  for (const auto& one : cases) {
    SCOPED_TRACE(one.reason);
    const auto outcome = with_log(one.log);
    EXPECT_EQ(outcome.code, 1) << outcome.err;
    EXPECT_THAT(outcome.out, AllOf(HasSubstr("No diagnosis"), HasSubstr(one.reason), Not(HasSubstr("confidence"))));
    EXPECT_EQ(outcome.out.find(one.reason), outcome.out.rfind(one.reason)) << "said once";
    const json verdict = json::parse(bench.read("bad/verdict.json"));
    EXPECT_EQ(verdict["refused"], true);
    EXPECT_EQ(verdict["verdict"], "unknown");
    EXPECT_TRUE(verdict["effects"].empty());
    EXPECT_TRUE(verdict["rivals"].empty());
    EXPECT_EQ(verdict["confidence"], 0.0);
    EXPECT_THAT(verdict["refusals"].dump(), HasSubstr(one.reason));
    EXPECT_FALSE(bench.has("bad/improved.st"));
  }
}

TEST_F(Diagnose, ARecordThatCannotBeReadIsAnError) {
  const struct {
    const char* name;
    std::string text;
    const char* number;
  } cases[] = {{"one sample", "t,force,v\n0.0,1.0,0.5\n", "HY501"},
               {"no sample", "t,force,v\n", "HY501"},
               {"NaN", "t,force,v\n0.000,1,0\n0.005,nan,0\n0.010,1,0\n", "HY506"},
               {"infinite", "t,force,v\n0.000,1,0\n0.005,1,inf\n0.010,1,0\n", "HY506"},
               {"gap in the times", "t,force,v\n0.000,1,0\n0.005,1,0\n0.010,1,0\n0.500,1,0\n", "HY507"},
               {"gap in a row", "t,force,v\n0.000,1,0\n0.005,,0\n0.010,1,0\n", "HY505"},
               {"no input", "t,v\n0.000,1\n0.005,1\n0.010,1\n", "HY502"},
               {"no output", "t,force\n0.000,1\n0.005,1\n0.010,1\n", "HY717"},
               {"another sample time", "t,force,v\n0.0,1,0\n0.1,1,0\n0.2,1,0\n", "HY704"}};
  for (const auto& one : cases) {
    SCOPED_TRACE(one.name);
    bench.write("bad.csv", one.text);
    const auto outcome = bench.shell("hysteron diagnose plant.st --log bad.csv --params p.toml --out bad");
    EXPECT_EQ(outcome.code, 2) << outcome.out;
    EXPECT_THAT(outcome.err, HasSubstr(one.number));
    EXPECT_EQ(outcome.out, "");
    EXPECT_FALSE(bench.has("bad"));
  }
}

TEST_F(Diagnose, ErrorsElsewhereWriteNothing) {
  bench.write("wrong.toml", "[parameters.MASS]\nKK = 1.0\n");
  bench.write("broken.st", "FUNCTION_BLOCK P");
  for (const char* line :
       {"hysteron diagnose plant.st --log none.csv --params p.toml --out bad",
        "hysteron diagnose plant.st --log log.csv --params none.toml --out bad",
        "hysteron diagnose plant.st --log log.csv --params wrong.toml --out bad",
        "hysteron diagnose broken.st --log log.csv --params p.toml --out bad",
        "hysteron diagnose plant.st --log log.csv --params p.toml --out bad --limit FORCE",
        "hysteron diagnose plant.st --log log.csv --params p.toml --out bad --limit FORCE=much",
        "hysteron diagnose plant.st --log log.csv --params p.toml --out bad --effects crepe",
        "hysteron diagnose plant.st --log log.csv --params p.toml --out bad --most 9",
        "hysteron diagnose plant.st --log log.csv --params p.toml --out bad --material -1",
        "hysteron diagnose plant.st --log log.csv --params p.toml", "hysteron diagnose plant.st --out bad"}) {
    const auto outcome = bench.shell(line);
    EXPECT_EQ(outcome.code, 2) << line;
    EXPECT_THAT(outcome.err, HasSubstr("HY")) << line;
    EXPECT_FALSE(bench.has("bad")) << line;
  }
}

TEST_F(Diagnose, SeveralRecordsAreOneDiagnosis) {
  bench.write("other.csv", records::csv_text(record().slice({0, 700})));
  const auto outcome = bench.shell(command + " --log other.csv --json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(json::parse(outcome.out)["effects"][0]["id"], "load");
  EXPECT_THAT(bench.names(), IsSupersetOf({"found/traces1.csv", "found/traces2.csv"}));
}

/// A controller that `hysteron serve` has run, and its trace.
constexpr const char* controller = R"(FUNCTION_BLOCK CONTROLLER  (* @ts 5ms *)
  VAR_OUTPUT
    FORCE : LREAL;  (* @unit N *)
  END_VAR
  VAR
    WAVE : HY_SINE := (AMPLITUDE := 3.0, FREQUENCY := 0.7);
  END_VAR

  WAVE();
  FORCE := 2.0 * WAVE.XOUT;
END_FUNCTION_BLOCK
)";

TEST_F(Diagnose, ATraceTellsTheControllersOwnPart) {
  bench.write("controller.st", controller);
  bench.write("RUN.toml", "[outputs.FORCE]\nsafe = 0.0\nhigh = 5.0\n[trace]\nfile = \"run.trace\"\n");
  const auto served = bench.shell("hysteron serve controller.st --config RUN.toml --virtual --cycles 600");
  ASSERT_EQ(served.code, 0) << served.err;
  const auto same = bench.shell(command + " --trace run.trace --controller controller.st --json");
  ASSERT_EQ(same.code, 0) << same.err;
  const json split = json::parse(same.out)["split"];
  EXPECT_EQ(split["controller"]["same_bits"], true);
  EXPECT_EQ(split["controller"]["steps"], 600);
  EXPECT_EQ(split["controller"]["outputs"]["FORCE"]["difference_rms"], 0.0);
  EXPECT_GT(split["controller"]["outputs"]["FORCE"]["limited_rms"], 0.1) << "the run file holds it to 5 N";
  EXPECT_GT(split["plant"].get<double>(), 0.9) << "a load is the plant's";
  // What ran was not what the diagram says: the sign of one computed force in the trace. A record of a step is 5 + 20
  // bytes and two outputs, the end of the trace 5 + 16.
  std::string bytes = bench.read("run.trace");
  const std::size_t record = 5 + 20 + 2 * 8;
  bytes[bytes.size() - (5 + 16) - 100 * record + 5 + 20 + 7] ^= static_cast<char>(0x80);
  bench.write("other.trace", bytes);
  const auto differs = bench.shell(command + " --trace other.trace --controller controller.st");
  ASSERT_EQ(differs.code, 0) << differs.err;
  EXPECT_THAT(differs.out, HasSubstr("1 of 600 steps give other bits than its diagram, the first is step 500"));
  EXPECT_THAT(differs.out, HasSubstr("FORCE: recorded and replayed differ by "));
  EXPECT_THAT(bench.read("found/report.html"), HasSubstr("give other bits than its diagram"));
}

TEST_F(Diagnose, ATraceAndItsControllerBelongTogether) {
  const auto alone = bench.shell(command + " --trace run.trace");
  EXPECT_EQ(alone.code, 2);
  EXPECT_THAT(alone.err, HasSubstr("belong together"));
  bench.write("controller.st", controller);
  bench.write("no.trace", "no trace");
  const auto broken = bench.shell(command + " --trace no.trace --controller controller.st");
  EXPECT_EQ(broken.code, 2);
  EXPECT_THAT(broken.err, HasSubstr("cannot be replayed"));
  EXPECT_FALSE(bench.has("found"));
}

TEST_F(Diagnose, HelpSaysWhatItDoesAndWhatItReturns) {
  const auto help = bench.shell("hysteron diagnose --help");
  EXPECT_EQ(help.code, 0);
  EXPECT_THAT(help.out,
              AllOf(HasSubstr("--log"), HasSubstr("--params"), HasSubstr("--out"), HasSubstr("--effects"),
                    HasSubstr("--material"), HasSubstr("--limit"), HasSubstr("--seed"), HasSubstr("Exit codes"),
                    HasSubstr("verdict.json"), HasSubstr("hysteron diagnose plant.st")));
}

}  // namespace
}  // namespace hysteron
