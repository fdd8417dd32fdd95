// hysteron run over many sets of parameters.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "tests/tool/workbench.hpp"

namespace hysteron {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr std::string_view batch_loop = R"(FUNCTION_BLOCK LOOP (* @ts 1ms *)
  VAR_INPUT
    R : LREAL;
    KP : LREAL := 2.0; (* @param @min 0 *)
    LIVE : BOOL := TRUE; (* @param *)
    N : DINT := 3; (* @param *)
  END_VAR
  VAR_OUTPUT
    Y : LREAL;
    BIG : BOOL;
  END_VAR
  VAR
    LAG : HY_LAG := (T1 := 0.05);
    CURVE : HY_TABLE := (COUNT := 3, X := [-1.0, 0.0, 2.0], Y := [-2.0, 0.0, 1.0]);
  END_VAR
  LAG(XIN := SEL(LIVE, 0.0, KP * R));
  CURVE(XIN := LAG.XOUT);
  Y := ABS(CURVE.XOUT) ** 0.7 + DINT_TO_LREAL(N);
  BIG := Y > 3.5;
END_FUNCTION_BLOCK
)";
constexpr std::string_view batch_run = "hysteron run loop.st --in log.csv --out sets.csv";

class RunBatch : public testing::Test {
 protected:
  RunBatch() {
    bench.write("loop.st", batch_loop);
    std::string log = "t,R,Y\n";
    for (int k = 0; k < 400; ++k) {
      log += fmt::format("{},{},{}\n", k * 1e-3, k / 50 % 2 == 0 ? 1.0 : -0.5, 3.0 + 0.4 * std::sin(0.01 * k));
    }
    bench.write("log.csv", log);
  }

  std::string table(const std::string& options) {
    const auto outcome = bench.shell(std::string(batch_run) + " " + options);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    said = outcome.out;
    return bench.read("sets.csv");
  }

  std::string refusal(const std::string& options) {
    const auto before = bench.names();
    const auto outcome = bench.shell(std::string(batch_run) + " " + options);
    EXPECT_EQ(outcome.code, 2) << outcome.out << outcome.err;
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(bench.names(), before);
    return outcome.err;
  }

  test::Workbench bench;
  std::string said;
};

TEST_F(RunBatch, HasTheSameBytesByBothEngines) {
  const std::string sets = "--sweep KP=0.5..3/7 --sweep LIVE=0..1/2 --sweep N=1..3/3";
  const std::string interpreted = table(sets + " --engine interpreter --threads 3");
  EXPECT_THAT(said, HasSubstr("42 sets of KP, LIVE, N, 400 steps each, interpreted"));
  EXPECT_EQ(table(sets + " --engine compiled --threads 1"), interpreted);
  EXPECT_THAT(said, HasSubstr("eight at a time"));
}

TEST_F(RunBatch, SaysOfASetWhatARunOfItSays) {
  bench.write("sets_of.csv", "KP;LAG.T1\n1.5;0.02\n# a remark\n\n2.5;0.1\n");
  const std::string rows = table("--batch sets_of.csv");
  EXPECT_THAT(rows,
              HasSubstr("set,KP,LAG.T1,Y.MIN,Y.MAX,Y.LAST,Y.RMS,Y.RMSE,BIG.MIN,BIG.MAX,BIG.LAST,BIG.RMS\n1,1.5,0.02,"));
  bench.write("p.toml", "[parameters]\nKP = 2.5\n[parameters.LAG]\nT1 = 0.1\n");
  EXPECT_EQ(bench.shell("hysteron run loop.st --in log.csv --out alone.csv --params p.toml").code, 0);
  std::istringstream alone(bench.read("alone.csv"));
  std::string line;
  std::getline(alone, line);
  double least = 1e9;
  double most = -1e9;
  double last = 0.0;
  while (std::getline(alone, line)) {
    last = std::stod(line.substr(line.find(',') + 1));
    least = std::min(least, last);
    most = std::max(most, last);
  }
  std::istringstream second(rows.substr(rows.find("\n2,") + 1));
  std::vector<double> cells;
  while (std::getline(second, line, ',') && cells.size() < 6) {
    cells.push_back(std::stod(line));
  }
  EXPECT_EQ(cells, (std::vector{2.0, 2.5, 0.1, least, most, last}));
}

TEST_F(RunBatch, DrawsTheSameSetsForTheSameSeed) {
  const std::string first = table("--draw 'KP=normal(2,0.1)' --draw 'LAG.T1=uniform(0.01,0.02)' --sets 500 --seed 7");
  EXPECT_EQ(table("--draw 'KP=normal(2,0.1)' --draw 'LAG.T1=uniform(0.01,0.02)' --sets 500 --seed 7"), first);
  EXPECT_NE(table("--draw 'KP=normal(2,0.1)' --draw 'LAG.T1=uniform(0.01,0.02)' --sets 500 --seed 8"), first);
  std::istringstream rows(first);
  std::string line;
  std::getline(rows, line);
  double sum = 0.0;
  double squares = 0.0;
  while (std::getline(rows, line)) {
    const std::size_t comma = line.find(',') + 1;
    const double kp = std::stod(line.substr(comma));
    const double t1 = std::stod(line.substr(line.find(',', comma) + 1));
    sum += kp;
    squares += (kp - 2.0) * (kp - 2.0);
    EXPECT_TRUE(t1 >= 0.01 && t1 <= 0.02) << t1;
  }
  EXPECT_NEAR(sum / 500.0, 2.0, 4.0 * 0.1 / std::sqrt(500.0));
  EXPECT_NEAR(std::sqrt(squares / 500.0), 0.1, 4.0 * 0.1 / std::sqrt(1000.0));
}

TEST_F(RunBatch, IsNearlyTheSameInVectors) {
  std::istringstream same(table("--sweep KP=0.5..3/9 --engine compiled"));
  std::istringstream fast(table("--sweep KP=0.5..3/9 --fast"));
  EXPECT_THAT(said, HasSubstr("in vectors"));
  double a = 0.0;
  double b = 0.0;
  std::string of_same;
  std::string of_fast;
  std::getline(same, of_same);
  std::getline(fast, of_fast);
  while (std::getline(same, of_same, ',') && std::getline(fast, of_fast, ',')) {
    a = std::stod(of_same);
    b = std::stod(of_fast);
    EXPECT_NEAR(a, b, 1e-12 * (1.0 + std::fabs(a)));
  }
}

TEST_F(RunBatch, RefusesWhatIsNoSet) {
  bench.write("s.csv", "KP,N\n1,3\n2,2.5\n");
  EXPECT_THAT(refusal("--batch s.csv"), AllOf(HasSubstr("HY604"), HasSubstr("s.csv:3:1"),
                                              HasSubstr("N takes whole numbers, and a column gives it 2.5")));
  bench.write("s.csv", "KP\n1\n-1\n");
  EXPECT_THAT(refusal("--batch s.csv"), AllOf(HasSubstr("HY214"), HasSubstr("s.csv:3:1")));
  bench.write("s.csv", "KP,Q\n1,1\n");
  EXPECT_THAT(refusal("--batch s.csv"), AllOf(HasSubstr("HY603"), HasSubstr("no parameter Q")));
  bench.write("s.csv", "KP,kp\n1,1\n");
  EXPECT_THAT(refusal("--batch s.csv"), HasSubstr("HY503"));
  bench.write("s.csv", "KP,N\n1\n");
  EXPECT_THAT(refusal("--batch s.csv"), HasSubstr("HY504"));
  bench.write("s.csv", "KP\nx\n");
  EXPECT_THAT(refusal("--batch s.csv"), HasSubstr("HY505"));
  bench.write("s.csv", "KP\n1e400\n");
  EXPECT_THAT(refusal("--batch s.csv"), HasSubstr("HY506"));
  bench.write("s.csv", "KP\n");
  EXPECT_THAT(refusal("--batch s.csv"), HasSubstr("HY501"));
  bench.write("s.csv", "");
  EXPECT_THAT(refusal("--batch s.csv"), HasSubstr("HY501"));
  EXPECT_THAT(refusal("--batch none.csv"), HasSubstr("HY100"));
}

TEST_F(RunBatch, RefusesWhatCouldBeReadInTwoWays) {
  for (const char* const options :
       {"--sweep KP=3", "--sweep KP=1...3/3", "--sweep KP=1..2/1", "--sweep KP=1..2/2.5", "--sweep KP",
        "--sweep KP=1..2/3 --sweep kp=1..2/3", "--sweep KP=1..2/3 --draw 'N=uniform(1,2)' --sets 3", "--sets 5",
        "--fast", "--draw KP=3 --sets 3", "--draw 'KP=normal(1,-1)' --sets 3", "--draw 'KP=uniform(2,1)' --sets 3",
        "--draw 'KP=uniform(1,2)'", "--sweep KP=1..2/3 --trace LAG.XOUT", "--sweep KP=1..2/3 --plot a.svg",
        "--sweep KP=1..2/3 --sets 4", "--sweep KP=1..2/3 --fast --engine interpreter",
        "--sweep KP=1..2/3 --float32 --engine compiled", "--sweep KP=1..2/10000 --sweep N=1..2000/2000"}) {
    EXPECT_THAT(refusal(options), HasSubstr("HY730")) << options;
  }
}

TEST_F(RunBatch, SaysWhichValuesAParameterTakes) {
  EXPECT_THAT(refusal("--sweep N=1..2/4"), AllOf(HasSubstr("HY604"), HasSubstr("N takes whole numbers, and --sweep"),
                                                 HasSubstr("--sweep N=1..5/5")));
  EXPECT_THAT(refusal("--sweep LIVE=0..2/3"),
              AllOf(HasSubstr("HY604"), HasSubstr("TRUE or FALSE"), HasSubstr("0..1/2")));
  EXPECT_THAT(refusal("--sweep CURVE.X=0..1/3"), AllOf(HasSubstr("HY604"), HasSubstr("is a list of numbers")));
  bench.write("s.csv", "N\n1\n1.5\n");
  EXPECT_THAT(refusal("--batch s.csv"), AllOf(HasSubstr("HY604 error: s.csv:3"), HasSubstr("a column gives it 1.5")));
  bench.write("loop.st",
              "FUNCTION_BLOCK P (* @ts 1ms *) VAR_INPUT R : LREAL; K : ARRAY[0..2] OF LREAL; (* @param *) END_VAR\n"
              "VAR_OUTPUT Y : LREAL; END_VAR\nVAR T : HY_TABLE := (COUNT := 2, Y := [0.0, 1.0]); END_VAR\n"
              "T(XIN := R * K[0]);\nY := T.XOUT;\nEND_FUNCTION_BLOCK\n");
  EXPECT_THAT(refusal("--sweep K=0..1/3"),
              AllOf(HasSubstr("HY604"), HasSubstr("K is a vector"), HasSubstr("--sweep 'K[0]=0.1..0.3/21'")));
  EXPECT_THAT(refusal("--sweep T.X=0..1/3"), AllOf(HasSubstr("HY604"), HasSubstr("T.X is a list of numbers")));
}

TEST_F(RunBatch, TakesNoMoreThreadsThanItHasWorkFor) {
  const std::string few = table("--sweep KP=1..3/3 --engine compiled --threads 1");
  EXPECT_EQ(table("--sweep KP=1..3/3 --engine compiled --threads 999999"), few);
  EXPECT_EQ(table("--sweep KP=1..3/3 --engine interpreter --threads 999999"), few);
}

TEST_F(RunBatch, SaysWhereSetsDoNotDiffer) {
  bench.write("loop.st",
              "FUNCTION_BLOCK P (* @ts 1ms *) VAR_INPUT R : LREAL; K : LREAL := 1.0; (* @param *) END_VAR\n"
              "VAR_OUTPUT Y : LREAL; END_VAR\nY := R + 0.0 * K;\nEND_FUNCTION_BLOCK\n");
  (void)table("--sweep K=1..2/3");
  EXPECT_THAT(said, HasSubstr("Y is the same in all sets"));
}

TEST_F(RunBatch, SaysThatAnOutputIsNotFinite) {
  bench.write("loop.st",
              "FUNCTION_BLOCK P (* @ts 1ms *) VAR_INPUT R : LREAL; K : LREAL := 1.0; (* @param *) END_VAR\n"
              "VAR_OUTPUT Y : LREAL; END_VAR\nY := R / K;\nEND_FUNCTION_BLOCK\n");
  const auto outcome = bench.shell(std::string(batch_run) + " --sweep K=0..1/3");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("An output of 1 of 3 sets is not a finite number"));
}

}  // namespace
}  // namespace hysteron
