// A port called T, as the time is in a record: it goes through all commands as any other.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/tool/workbench.hpp"

namespace hysteron {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

/// An oven, whose temperature is an output T. The machine has a lag more than the model.
constexpr std::string_view oven = R"(FUNCTION_BLOCK OVEN  (* @ts 100ms *)
  VAR_INPUT
    HEAT : LREAL;  (* @unit V *)
  END_VAR
  VAR_OUTPUT
    T : LREAL;  (* @unit mm *)
  END_VAR
  VAR
    AMP  : HY_GAIN := (K := 2.5);
    WALL : HY_LAG := (T1 := 0.7);
  END_VAR

  AMP(XIN := HEAT);
  WALL(XIN := AMP.XOUT);
  T := WALL.XOUT;
END_FUNCTION_BLOCK
)";
/// A filter of OSCAT: its time constant is an input T. One of them may be written small, as names may.
constexpr std::string_view filter = R"(FUNCTION_BLOCK FILTER (* @ts 100ms @body *)
  VAR_INPUT
    IN : LREAL;
    t : LREAL;
  END_VAR
  VAR_OUTPUT
    OUT : LREAL;
  END_VAR
  VAR
    HELD : LREAL;
  END_VAR
  IF t > 0.0 THEN
    HELD := HELD + (IN - HELD) * 0.1 / t;
  ELSE
    HELD := IN;
  END_IF;
  OUT := HELD;
END_FUNCTION_BLOCK
)";
constexpr const char* drive =
    "awk 'BEGIN { print \"time,HEAT\"; for (k = 0; k < 600; ++k) "
    "printf \"%.1f,%.6f\\n\", 0.1 * k, (int(k / 40) * 7) % 5 + 0.5 * sin(0.3 * k) }' > drive.csv";

class SignalT : public testing::Test {
 protected:
  SignalT() {
    bench.write("oven.st", oven);
    bench.write("filter.st", filter);
    bench.write("p.toml", "[fit.AMP]\nK = {start = 1.0}\n\n[fit.WALL]\nT1 = {start = 0.2}\n");
    EXPECT_EQ(bench.shell(drive).code, 0);
  }

  /// What a command prints; it has to end well.
  std::string done(const std::string& line) const {
    const auto outcome = bench.shell(line);
    EXPECT_EQ(outcome.code, 0) << line << '\n' << outcome.out << outcome.err;
    return outcome.out;
  }

  /// log.csv: the drive, and the T of a machine.
  void measure(const std::string& heading = "time") const {
    done(
        "hysteron run oven.st --in drive.csv --out out.csv && cut -d, -f2 out.csv > y.csv && paste -d, drive.csv y.csv "
        "| sed '1s/^time/" +
        heading + "/' > log.csv");
  }

  [[nodiscard]] std::string first_line(const std::string& file) const {
    const std::string text = bench.read(file);
    return text.substr(0, text.find('\n'));
  }

  test::Workbench bench;
};

TEST_F(SignalT, IsNoMatterOfACheck) {
  EXPECT_EQ(done("hysteron check oven.st"), "oven.st: no errors\n");
  EXPECT_EQ(done("hysteron check filter.st"), "filter.st: no errors\n");
}

TEST_F(SignalT, GoesFromTheRunToTheFitAndTheDiagnosis) {
  measure();
  EXPECT_EQ(first_line("out.csv"), "time,T");
  EXPECT_EQ(first_line("log.csv"), "time,HEAT,T");
  EXPECT_THAT(done("hysteron record log.csv --for oven.st --params p.toml"), HasSubstr("\nT "));
  done("hysteron tune oven.st --log log.csv --params p.toml --out tuned.toml --report report");
  EXPECT_EQ(first_line("report/residuals.csv"), "time,T [mm],T_MODEL [mm],T_RESIDUAL [mm]");
  const auto fit = nlohmann::json::parse(bench.read("report/report.json"));
  EXPECT_NEAR(fit["parameters"][0]["value"].get<double>(), 2.5, 1e-4);
  EXPECT_NEAR(fit["parameters"][1]["value"].get<double>(), 0.7, 1e-4);
  done("hysteron run oven.st --in log.csv --out again.csv --params tuned.toml");
  done("hysteron compare out.csv again.csv --abs 0.001");
  EXPECT_EQ(bench.shell("hysteron compare out.csv log.csv").code, 1);  // which has HEAT, too
  done("hysteron plot out.csv again.csv --signal T --out T.svg && hysteron plot report/residuals.csv --out r.svg");
  EXPECT_THAT(bench.read("T.svg"), HasSubstr(">T<"));

  done("hysteron diagnose oven.st --log log.csv --params tuned.toml --out found --effects lag,load");
  EXPECT_EQ(first_line("found/traces.csv").substr(0, 5), "time,");
  done("hysteron run found/improved.st --in log.csv --out improved.csv --params found/improved.toml");
  done(
      "hysteron diagnose oven.st --log log.csv --params tuned.toml --out found2 --effects lag && hysteron compare "
      "found/traces.csv found2/traces.csv --abs 10");
}

/// All bytes but the name of the time are as those of a diagram with another name in its place.
TEST_F(SignalT, IsWrittenAsAnyOtherSignal) {
  measure();
  done("sed 's/\\bT\\b/TEMP/g' oven.st > temp.st && hysteron run temp.st --in drive.csv --out temp.csv");
  EXPECT_EQ(first_line("temp.csv"), "t,TEMP");
  EXPECT_EQ(done("tail -n +2 temp.csv"), done("tail -n +2 out.csv"));
}

TEST_F(SignalT, StandsBesideAnyTimeThatSaysSo) {
  measure("t");  // t,HEAT,T: t rises evenly
  const std::string as_time = done("hysteron run oven.st --in log.csv --out -");
  EXPECT_EQ(as_time, bench.read("out.csv"));
  EXPECT_THAT(done("hysteron run oven.st --in log.csv --out o.csv --summary"),
              HasSubstr("T                -0.499975 to 10.495 mm; RMSE against the record's column 0 mm"));
  measure("timestamp");
  EXPECT_EQ(done("hysteron run oven.st --in log.csv --out -"), as_time);
  measure("tick");
  EXPECT_EQ(done("hysteron run oven.st --in log.csv --time tick --out -"), as_time);
  bench.write("r.toml", "[record]\ntime = \"tick\"\n\n[record.columns]\nT = \"T\"\n");
  EXPECT_EQ(done("hysteron run oven.st --in log.csv --params r.toml --out -"), as_time);
  EXPECT_EQ(done("cut -d, -f2- log.csv > bare.csv && hysteron run oven.st --in bare.csv --rate 10Hz --out -"), as_time);
}

TEST_F(SignalT, IsRefusedWhereItCouldBeTheTime) {
  bench.write("sum.st",
              "FUNCTION_BLOCK SUMMED (* @ts 100ms *)\nVAR_INPUT IN : LREAL; T : LREAL := 0.5; END_VAR\n"
              "VAR_OUTPUT OUT : LREAL; END_VAR\nOUT := IN + T;\nEND_FUNCTION_BLOCK\n");
  for (const char* const name : {"t", "T"}) {
    done(std::string("sed '1s/time,HEAT/") + name + ",in/' drive.csv > bare.csv");
    const auto refused = bench.shell("hysteron run sum.st --in bare.csv --out out.csv");
    EXPECT_EQ(refused.code, 2);
    EXPECT_THAT(refused.err, AllOf(StartsWith("HY514 error: bare.csv:1:1: Column "), HasSubstr("--rate 0.1s"),
                                   HasSubstr(std::string("--time ") + name + ";")));
    // Each of the mends, as it is written.
    done(std::string("hysteron run sum.st --in bare.csv --out out.csv --time ") + name);
    done("sed '1s/^./time/' bare.csv > mended.csv && hysteron run sum.st --in mended.csv --out out2.csv");
    EXPECT_EQ(bench.read("out.csv"), bench.read("out2.csv"));
    done("hysteron run sum.st --in bare.csv --out out.csv --rate 0.1s --summary");
    // What drives a diagram whose output is called T has but one reading.
    done("sed '1s/in/HEAT/' bare.csv > heat.csv && hysteron run oven.st --in heat.csv --out out.csv");
    done("hysteron run oven.st --in drive.csv --out out2.csv");
    EXPECT_EQ(bench.read("out.csv"), bench.read("out2.csv"));
  }
  // A diagram without a port T takes it as ever.
  bench.write("bare.csv", "t,X\n0,1\n0.001,1\n0.002,1\n");
  bench.write("plant.st", test::plant);
  EXPECT_EQ(done("hysteron run plant.st --in bare.csv --out -"), "t,Y,BUSY\n0,0.002,1\n0.001,0.004,1\n0.002,0.006,1\n");
}

/// An input T, written small in the diagram.
TEST_F(SignalT, AsAnInputDrivesTheDiagram) {
  bench.write("in.csv", "time,in,T\n0,1,0\n0.1,1,1\n0.2,0,0.5\n0.3,0,0.5\n");
  EXPECT_EQ(done("hysteron run filter.st --in in.csv --out -"), "time,OUT\n0,1\n0.1,1\n0.2,0.8\n0.3,0.64\n");
  bench.write("in.csv", "T,in,t\n0,1,0\n1,1,0.1\n0.5,0,0.2\n0.5,0,0.3\n");
  EXPECT_EQ(done("hysteron run filter.st --in in.csv --out -"), "time,OUT\n0,1\n0.1,1\n0.2,0.8\n0.3,0.64\n");
}

TEST_F(SignalT, IsTestedAndHasAGoldenRecord) {
  bench.write("in.csv", "t,IN,T\n0,1,0\n0.1,1,1\n0.2,0,0.5\n");
  bench.write(
      "filter.test.toml",
      "[[case]]\nname = \"held\"\ncsv = \"in.csv\"\nexpect = {OUT = [1.0, 1.0, 0.8]}\ngolden = \"golden.csv\"\n\n"
      "[[case]]\nname = \"said\"\ninputs = {IN = 1.0, T = 0.2}\nsteps = 2\nexpect = {OUT = [0.5, 0.75]}\n");
  done("hysteron test filter.st --no-generated --update");
  EXPECT_EQ(first_line("golden.csv"), "time,OUT");
  EXPECT_THAT(done("hysteron test filter.st"), HasSubstr("2 passed, 0 failed"));
  // Golden records of before, whose time is called t; and an output T, whose inputs alone are in the record of a case.
  done("sed -i 's/^time/t/' golden.csv && hysteron test filter.st --no-generated");
  bench.write("heat.csv", "t,HEAT\n0,1\n0.1,1\n");
  bench.write("oven.test.toml", "[[case]]\nname = \"heat\"\ncsv = \"heat.csv\"\ngolden = \"oven.csv\"\n");
  done("hysteron test oven.st --no-generated --update");
  EXPECT_EQ(first_line("oven.csv"), "time,T");
  done("hysteron test oven.st");
}

TEST_F(SignalT, GoesThroughTheGeneratedHost) {
  measure();
  done(
      "hysteron generate oven.st --target cpp --out g && cmake -S g -B b > built.txt 2>&1 && cmake --build b >> "
      "built.txt 2>&1 && b/oven_run < log.csv > host.csv");
  EXPECT_EQ(bench.read("host.csv"), bench.read("out.csv"));
  EXPECT_EQ(bench.shell("sed '1s/time/clock/' log.csv | b/oven_run").err, "line 1: there is no column time\n");
  bench.write("in.csv", "time,in,T\n0,1,0\n0.1,1,1\n0.2,0,0.5\n0.3,0,0.5\n");
  done(
      "hysteron generate filter.st --target cpp --out f && cmake -S f -B c > built.txt 2>&1 && cmake --build c >> "
      "built.txt 2>&1 && c/filter_run < in.csv > host.csv && hysteron run filter.st --in in.csv --out out.csv");
  EXPECT_EQ(bench.read("host.csv"), bench.read("out.csv"));
}

TEST_F(SignalT, IsInTheHistoryAndTheTraceOfATask) {
  bench.write("hall.st", R"(FUNCTION_BLOCK HALL  (* @ts 10ms *)
  VAR_INPUT T : LREAL := 1.0;  (* @unit mm *) END_VAR
  VAR_OUTPUT Y : LREAL;  (* @unit mm *) END_VAR
  VAR WAVE : HY_SINE := (AMPLITUDE := 3.0, FREQUENCY := 0.7); END_VAR
  WAVE();
  Y := T * WAVE.XOUT;
END_FUNCTION_BLOCK
)");
  bench.write("RUN.toml",
              "[outputs.Y]\nsafe = 0.0\n[history]\nfile = \"history.sqlite\"\nevery = \"10ms\"\n[trace]\nfile = "
              "\"run.trace\"\n");
  done("hysteron serve hall.st --config RUN.toml --virtual --engine interpreter --cycles 300");
  done(
      "hysteron history history.sqlite --out history.csv && hysteron replay hall.st --trace run.trace --engine "
      "interpreter --out replayed.csv");
  EXPECT_THAT(first_line("history.csv"), StartsWith("time,"));
  EXPECT_EQ(first_line("replayed.csv"), "time,T [mm],Y [mm]");
  done("hysteron run hall.st --in history.csv --out h.csv && hysteron run hall.st --in replayed.csv --out r.csv");
  EXPECT_EQ(first_line("r.csv"), "time,Y");
  // Without T among its points, a t alone would have two readings.
  done("hysteron history history.sqlite --points Y --out y.csv && hysteron record y.csv");
  EXPECT_EQ(first_line("y.csv"), "time,Y [mm]");
}

}  // namespace
}  // namespace hysteron
