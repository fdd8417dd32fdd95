// hysteron tune with [goal], and hysteron relay, as a user runs them.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/tool/workbench.hpp"

namespace hysteron {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

constexpr std::string_view loop_to_tune = R"(FUNCTION_BLOCK LOOP  (* @ts 10ms *)
  VAR_INPUT
    SP : LREAL;  (* @unit mm *)
  END_VAR
  VAR_OUTPUT
    Y : LREAL;  (* @unit mm *)
  END_VAR
  VAR
    P : HY_GAIN := (K := 1.0);
    BODY : HY_GAIN := (K := 1.0);
    PLANT : HY_INTEGRAL_FORWARD;
  END_VAR

  P(XIN := SP - PLANT.XOUT);
  BODY(XIN := P.XOUT);
  Y := PLANT.XOUT;
  PLANT(XIN := BODY.XOUT);
END_FUNCTION_BLOCK
)";

constexpr std::string_view goal_of_loop =
    "# the controller of the axis\n[fit.P]\nK = {min = 0.0}\n\n[goal]\norder = 1.0\nsettling_time = 0.5\nloop = "
    "\"P.XOUT\"\n";

struct LoopBench : test::Workbench {
  explicit LoopBench(std::string_view settings) {
    write("loop.st", loop_to_tune);
    write("p.toml", settings);
  }
};

constexpr const char* tune_loop = "hysteron tune loop.st --params p.toml --out tuned.toml";

TEST(TuneGoal, NeedsNoRecordAndWritesTheTunedFile) {
  const LoopBench bench(std::string(goal_of_loop) + "\n[goal.limits]\neffort = 5.0\n");
  const auto done = bench.shell(std::string(tune_loop) + " --report report");
  EXPECT_EQ(done.code, 0) << done.err;
  EXPECT_EQ(done.err, "");
  EXPECT_THAT(done.out, AllOf(HasSubstr("P.K"), HasSubstr("at its limit"), HasSubstr("phase margin"),
                              HasSubstr("The loop is tuned, and all limits are kept.")));
  const std::string tuned = bench.read("tuned.toml");
  EXPECT_THAT(tuned, AllOf(HasSubstr("# Tuned by hysteron tune for Y with one plant."),
                           HasSubstr("# the controller of the axis"), HasSubstr("[goal.limits]\neffort = 5.0"),
                           HasSubstr("K = 4.99")));
  EXPECT_THAT(bench.read("report/report.html"),
              AllOf(HasSubstr("Nyquist"), HasSubstr("Limits"), Not(HasSubstr("http://"))));
  EXPECT_THAT(bench.read("report/response.csv"), HasSubstr("Y_WISHED"));
  EXPECT_EQ(nlohmann::json::parse(bench.read("report/report.json"))["status"], "tuned");
  // Tuned again it stays where it is, with one heading.
  const auto again = bench.shell("hysteron tune loop.st --params tuned.toml --out twice.toml");
  EXPECT_EQ(again.code, 0) << again.err;
  const std::string twice = bench.read("twice.toml");
  EXPECT_EQ(twice.find("# Tuned by"), twice.rfind("# Tuned by")) << twice;
}

TEST(TuneGoal, SaysWhichLimitsAreBrokenAndWritesTheLeastBroken) {
  const LoopBench bench(
      "[parameters.P]\nK = 8.0\n[fit.P]\nK = {min = 4.0, max = 20.0}\n[goal]\nsettling_time = 0.5\nloop = \"P.XOUT\"\n"
      "[goal.limits]\neffort = 2.0\n");
  const auto done = bench.shell(tune_loop);
  EXPECT_EQ(done.code, 1);
  EXPECT_THAT(done.err, AllOf(HasSubstr("HY533 error: p.toml:9:10"), HasSubstr("effort = 2"),
                              HasSubstr("P.K is on its lower bound")));
  EXPECT_THAT(bench.read("tuned.toml"), HasSubstr("# BROKEN: effort = 2, is 4"));
}

TEST(TuneGoal, TakesPlantsBesideItsFile) {
  const LoopBench bench("");
  bench.write("axis/p.toml", std::string(goal_of_loop) + "plants = [\"light.toml\", \"heavy.toml\"]\n");
  bench.write("axis/light.toml", "[parameters.BODY]\nK = 2.0\n");
  bench.write("axis/heavy.toml", "[parameters.BODY]\nK = 0.5\n");
  const auto done = bench.shell("hysteron tune loop.st --params axis/p.toml --out tuned.toml --json");
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_EQ(nlohmann::json::parse(done.out)["plants"].size(), 2U);
  bench.write("axis/heavy.toml", "[parameters.BODI]\nK = 0.5\n");
  EXPECT_THAT(bench.shell("hysteron tune loop.st --params axis/p.toml --out tuned.toml").err,
              AllOf(HasSubstr("HY603 error: axis/heavy.toml:2"), HasSubstr("BODY")));
  bench.write("axis/p.toml", std::string(goal_of_loop) + "plants = [\"none.toml\"]\n");
  EXPECT_THAT(bench.shell("hysteron tune loop.st --params axis/p.toml --out tuned.toml").err,
              AllOf(HasSubstr("HY100 error: axis/none.toml"), HasSubstr("named as a plant here")));
}

TEST(TuneGoal, FollowsARecord) {
  const LoopBench bench(
      "[fit.P]\nK = {min = 0.0}\n[goal]\nsignal = \"record\"\nwished = \"WISH\"\nloop = \"P.XOUT\"\n");
  // What the loop does with K = 7, column by column.
  bench.write("k7.toml", "[parameters.P]\nK = 7.0\n");
  ASSERT_EQ(bench
                .shell("awk 'BEGIN { print \"t,SP\"; for (k = 0; k < 300; ++k) printf \"%.2f,%.6f\\n\", 0.01 * k, "
                       "sin(0.05 * k) }' > sp.csv && hysteron run loop.st --in sp.csv --out y.csv --params k7.toml && "
                       "cut -d, -f2 y.csv | sed 's/Y/WISH/' | paste -d, sp.csv - > log.csv")
                .code,
            0);
  const auto done = bench.shell(std::string(tune_loop) + " --log log.csv --json");
  ASSERT_EQ(done.code, 0) << done.err;
  const auto json = nlohmann::json::parse(done.out.substr(done.out.find('{')));
  EXPECT_NEAR(json["parameters"][0]["value"].get<double>(), 7.0, 1e-3);
  EXPECT_THAT(done.err, Not(HasSubstr("not used")));
  EXPECT_THAT(bench.shell(tune_loop).err, HasSubstr("HY530 error: p.toml:3"));
  // The wish has a unit as all columns have: in thousandths it is the same one.
  ASSERT_EQ(
      bench
          .shell("awk -F, 'NR == 1 { print \"t,SP,WISH [um]\"; next } { print $1 \",\" $2 \",\" 1000 * $3 }' log.csv "
                 "> um.csv")
          .code,
      0);
  const auto in_um = bench.shell("hysteron tune loop.st --params p.toml --out um.toml --log um.csv --json");
  ASSERT_EQ(in_um.code, 0) << in_um.err;
  EXPECT_THAT(in_um.err, HasSubstr("note: um.csv: column WISH is in um, and was converted to mm: times 0.001\n"));
  const auto again = nlohmann::json::parse(in_um.out.substr(in_um.out.find('{')));
  EXPECT_NEAR(again["parameters"][0]["value"].get<double>(), 7.0, 1e-3);
}

TEST(TuneGoal, RefusesWhatTheDiagramDoesNotHave) {
  const auto said = [](const std::string& settings) { return LoopBench(settings).shell(tune_loop).err; };
  const std::string fit = "[fit.P]\nK = {}\n[goal]\nsettling_time = 0.5\n";
  EXPECT_THAT(said(fit + "output = \"YY\"\n"), AllOf(HasSubstr("HY603"), HasSubstr("Y")));
  EXPECT_THAT(said(fit + "input = \"SQ\"\n"), AllOf(HasSubstr("HY603"), HasSubstr("the inputs are SP.")));
  EXPECT_THAT(said(fit + "loop = \"P.XOUR\"\n"), AllOf(HasSubstr("HY708 error: p.toml:5"), HasSubstr("did you mean")));
  EXPECT_THAT(said(fit + "loop = \"SP\"\n"), HasSubstr("HY531"));
  EXPECT_THAT(said("[goal]\nsettling_time = 0.5\n"), HasSubstr("HY716"));
  EXPECT_THAT(said(fit + "duration = 0.01\n"), HasSubstr("HY606"));
  EXPECT_THAT(said(fit + "duration = 0.2\n"), HasSubstr("before the wished response has settled"));
  EXPECT_THAT(said("[fit.record.P]\nK = {}\n[goal]\nsettling_time = 0.5\n"), HasSubstr("HY606"));
  EXPECT_THAT(said("[fit.P]\nK = {}\n"), AllOf(HasSubstr("HY730"), HasSubstr("no record is given")));
}

TEST(TuneGoal, SaysWhatToWriteInstead) {
  const auto said = [](const std::string& settings) { return LoopBench(settings).shell(tune_loop).err; };
  const std::string fit = "[fit.P]\nK = {}\n[goal]\nsettling_time = 0.5\n";
  EXPECT_THAT(said(fit + "order = 0\n"), HasSubstr("write 1 or 2."));
  EXPECT_THAT(said(fit + "loop = \"P.XOUT\"\n[goal.limits]\nsensitivity = 0.0\n"),
              HasSubstr("write a number above 1."));
  EXPECT_THAT(said(fit + "loop = \"P.XOUT\"\n[goal.limits]\nphase_margin_deg = 180.0\n"),
              HasSubstr("write a number above 0 and below 180."));
  EXPECT_THAT(said(fit + "plants = []\n"), HasSubstr("plants must be a list of names, but is an empty list."));
  EXPECT_THAT(said(fit + "plants = [3]\n"), HasSubstr("Each element of plants must be a name, but here is a whole"));
  EXPECT_THAT(said(fit + "plants = [\"\"]\n"), HasSubstr("plants names an empty text, which is no name."));
  EXPECT_THAT(said(fit + "loop = \"a b\"\n"), HasSubstr("loop names \"a b\", which is no name."));
  EXPECT_THAT(said("[parameters.P]\nK = []\n" + fit), HasSubstr("but is an empty list."));
  EXPECT_THAT(said("[fit.P]\n[goal]\nsettling_time = 0.5\n"),
              AllOf(HasSubstr("HY716 error: p.toml:1"), HasSubstr("[fit.P] is empty"), HasSubstr("K = {}")));
  EXPECT_THAT(said("[parameters]\nP = 2.0\n" + fit),
              AllOf(HasSubstr("HY603 error: p.toml:2"), HasSubstr("P is a HY_GAIN, not a parameter."),
                    HasSubstr("such as P.K")));
  EXPECT_THAT(said("[fit.P]\nK = {}\n[tune]\ntrain = [1.0]\n[goal]\nsettling_time = 0.5\n"),
              HasSubstr("but here is a list of one value."));
}

TEST(TuneGoal, ARecordHasToGoOnBehindTheDeadTime) {
  const LoopBench bench(
      "[fit.P]\nK = {}\n[goal]\nsignal = \"record\"\nsettling_time = 0.5\ndead_time = 2.0\nloop = \"P.XOUT\"\n");
  ASSERT_EQ(bench
                .shell("awk 'BEGIN { print \"t,SP\"; for (k = 0; k < 150; ++k) printf \"%.2f,%d\\n\", 0.01 * k, "
                       "(k >= 50) }' > log.csv")
                .code,
            0);
  EXPECT_THAT(bench.shell(std::string(tune_loop) + " --log log.csv").err,
              AllOf(HasSubstr("HY530 error: p.toml:6"), HasSubstr("ends 1 s after SP moves"),
                    HasSubstr("within the dead time of the wished response, 2 s"), HasSubstr("for 7.5 s behind")));
}

TEST(Relay, WritesWhereAPidMayBegin) {
  const test::Workbench bench;
  std::string text = "t,U [V],Y [mm]\n";
  std::vector<double> applied;
  double y = 0.0;
  double u = 1.2;
  for (int k = 0; k < 1500; ++k) {
    u = y < -0.05 ? 1.2 : y > 0.05 ? -0.3 : u;
    applied.push_back(k < 50 ? 0.0 : u);
    text += fmt::format("{:.2f},{},{:.8f}\n", 0.01 * k, applied.back(), y);
    y += (1.0 - std::exp(-0.01 / 0.6)) * (2.0 * (k < 8 ? 0.0 : applied[static_cast<std::size_t>(k - 8)]) - y);
  }
  bench.write("relay.csv", text);
  const auto done = bench.shell("hysteron relay relay.csv --u U --y Y --out start.toml --json");
  ASSERT_EQ(done.code, 0) << done.err;
  const auto json = nlohmann::json::parse(done.out);
  EXPECT_NEAR(json["model"]["K"].get<double>(), 2.0, 0.06);
  EXPECT_NEAR(json["model"]["T"].get<double>(), 0.6, 0.03);
  EXPECT_NEAR(json["model"]["dead_time"].get<double>(), 0.085, 0.01);
  EXPECT_THAT(bench.read("start.toml"), AllOf(HasSubstr("[parameters.PID]\nKP = "), HasSubstr("  # V/mm\n"),
                                              HasSubstr("[fit.PID]\nKP = {min = ")));
  EXPECT_THAT(bench.shell("hysteron relay relay.csv --u U --y Y").out,
              AllOf(HasSubstr("-0.3 to 1.2 V"), HasSubstr(" V/mm, period Tu"), HasSubstr("start       PI ")));
  EXPECT_THAT(bench.shell("hysteron relay relay.csv --u U --y Y --resample linear").err,
              HasSubstr("note: relay.csv: resampled (linear)"));
  EXPECT_EQ(bench.shell("hysteron relay relay.csv --u U --y Z").code, 2);
  const auto bad = bench.shell("hysteron relay relay.csv --u Y --y U --out none.toml");
  EXPECT_THAT(bad.err, HasSubstr("HY535 error: relay.csv"));
  EXPECT_FALSE(bench.has("none.toml"));
}

}  // namespace
}  // namespace hysteron
