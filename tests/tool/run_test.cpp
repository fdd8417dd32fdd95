// hysteron run: a diagram over a record.
#include <gmock/gmock.h>

#include <string>

#include "records/read.hpp"
#include "tests/tool/workbench.hpp"

namespace hysteron {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

constexpr std::string_view go = "hysteron run plant.st --in log.csv --out out.csv";

class Run : public testing::Test {
 protected:
  Run() {
    bench.write("plant.st", test::plant);
    bench.write("log.csv", test::plant_log);
  }

  /// The message of a run that is refused, and that leaves nothing behind.
  std::string refusal(const std::string& line = std::string(go)) {
    const auto before = bench.names();
    const auto outcome = bench.shell(line);
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(bench.names(), before);
    return outcome.err;
  }

  test::Workbench bench;
};

TEST_F(Run, ComputesTheOutputs) {
  const auto outcome = bench.shell(std::string(go));
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.out + outcome.err, "");
  // Y(k) = Y(k−1) + 0.001·2·X, 0 at the reset.
  EXPECT_EQ(bench.read("out.csv"), "t,Y,BUSY\n0,0.002,1\n0.001,0.004,1\n0.002,0,0\n0.003,-0.001,1\n");
}

TEST_F(Run, TakesParametersFromAFile) {
  bench.write("p.toml", "[parameters.amp]\nk = 20\n");
  EXPECT_EQ(bench.shell(std::string(go) + " --params p.toml").code, 0);
  EXPECT_THAT(bench.read("out.csv"), HasSubstr("\n0,0.02,1\n"));
}

TEST_F(Run, Float32HasTheBitsOfAFloat) {
  EXPECT_EQ(bench.shell(std::string(go) + " --float32").code, 0);
  // 0.001f·2.0f, and the sum rounded to a float: printed with as few digits as a float needs.
  EXPECT_EQ(bench.read("out.csv"), "t,Y,BUSY\n0,0.002,1\n0.001,0.004,1\n0.002,0,0\n0.003,-0.001,1\n");
  bench.write("log.csv", "t,x\n0,0.1\n0.001,0.1\n");
  bench.write("plant.st",
              "FUNCTION_BLOCK P (* @ts 1ms *) VAR_INPUT X : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR\n"
              "Y := X * 3.0;\nEND_FUNCTION_BLOCK\n");
  EXPECT_EQ(bench.shell(std::string(go) + " --float32").code, 0);
  EXPECT_EQ(bench.read("out.csv"), "t,Y\n0,0.3\n0.001,0.3\n");  // 0.1f·3.0f rounds to the float nearest 0.3
  EXPECT_EQ(bench.shell(std::string(go)).code, 0);
  EXPECT_EQ(bench.read("out.csv"), "t,Y\n0,0.30000000000000004\n0.001,0.30000000000000004\n");
}

TEST_F(Run, Float32KeepsEveryDint) {
  bench.write("log.csv", "t,n\n0,16777217\n0.001,-2147483647\n");
  bench.write("plant.st",
              "FUNCTION_BLOCK P (* @ts 1ms *) VAR_INPUT N : DINT; END_VAR VAR_OUTPUT M : DINT; END_VAR\n"
              "M := N;\nEND_FUNCTION_BLOCK\n");
  EXPECT_EQ(bench.shell(std::string(go) + " --float32").code, 0);
  EXPECT_EQ(bench.read("out.csv"), "t,M\n0,16777217\n0.001,-2147483647\n");
}

TEST_F(Run, ReadsAndWritesStreams) {
  const auto outcome = bench.shell("hysteron run plant.st --in - --out - < log.csv");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.out, StartsWith("t,Y,BUSY\n0,0.002,1\n"));
  const auto cut = bench.shell("(hysteron run plant.st --in - --out - < log.csv; echo $? >&2) | true");
  EXPECT_EQ(cut.err, "0\n");
}

TEST_F(Run, TracesEachElementOfAVector) {
  bench.write("log.csv", "t,U\n0,2\n0.001,3\n");
  bench.write("plant.st",
              "FUNCTION_BLOCK P (* @ts 1ms *) VAR_INPUT U : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR\n"
              "VAR V : ARRAY[0..1] OF LREAL; M : HY_MATRIX_GAIN := (K := [1.0, 2.0, 3.0, 4.0], ROWS := 2); END_VAR\n"
              "V := [U, U * 10.0];\nM(XIN := V);\nY := SUM(M.XOUT);\nEND_FUNCTION_BLOCK\n");
  EXPECT_EQ(bench.shell(std::string(go) + " --trace v,M.XOUT,M.XOUT[1]").code, 0);
  EXPECT_EQ(bench.read("out.csv"),
            "t,Y,V[0],V[1],M.XOUT[0],M.XOUT[1],M.XOUT[1]\n0,128,2,20,42,86,86\n0.001,192,3,30,63,129,129\n");
}

/// A block's input that has a value of its own needs no column, in a sequential body as in a diagram.
TEST_F(Run, AnInputOfASequentialBodyKeepsItsDefault) {
  bench.write("log.csv", "t,U\n0,2\n0.001,3\n");
  const auto body = [&](const std::string& rate) {
    bench.write("plant.st", "FUNCTION_BLOCK P (* @ts 1ms *) VAR_INPUT U : LREAL; RATE : " + rate +
                                "; END_VAR VAR_OUTPUT Y : LREAL; END_VAR\n"
                                "IF U > 2.5 THEN Y := RATE; ELSE Y := 0.0; END_IF;\nEND_FUNCTION_BLOCK\n");
    return bench.shell(std::string(go));
  };
  EXPECT_THAT(body("LREAL := 0.5").err, HasSubstr("input RATE has no column, and keeps its default 0.5"));
  EXPECT_EQ(bench.read("out.csv"), "t,Y\n0,0\n0.001,0.5\n");
  EXPECT_THAT(body("LREAL").err, HasSubstr("HY502"));
}

TEST_F(Run, TracesSignalsInside) {
  EXPECT_EQ(bench.shell(std::string(go) + " --trace amp.xout --trace SUM.Q").code, 0);
  EXPECT_EQ(bench.read("out.csv"),
            "t,Y,BUSY,AMP.XOUT,SUM.Q\n0,0.002,1,2,1\n0.001,0.004,1,2,1\n0.002,0,0,2,0\n0.003,-0.001,1,-1,1\n");
  EXPECT_THAT(refusal(std::string(go) + " --trace AMP.OUT"),
              AllOf(HasSubstr("HY708"), HasSubstr("PLANT has no signal AMP.OUT."), HasSubstr("AMP.XOUT?")));
}

TEST_F(Run, TracesVariablesAndWhatIsInsideNestedBlocks) {
  bench.write("plant.st",
              "FUNCTION_BLOCK STAGE VAR_INPUT U : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR\n"
              "VAR AMP : HY_GAIN := (K := 2.0); HALF : LREAL; END_VAR\n"
              "AMP(XIN := U);\nHALF := AMP.XOUT / 4.0;\nY := AMP.XOUT + HALF;\nEND_FUNCTION_BLOCK\n"
              "FUNCTION_BLOCK P (* @ts 1ms *) VAR_INPUT X : LREAL; END_VAR VAR_OUTPUT Z : LREAL; END_VAR\n"
              "VAR PLANT : STAGE; T : LREAL; FIXED : LREAL := 7.5; END_VAR\n"
              "T := X + 1.0;\nPLANT(U := T);\nZ := PLANT.Y + FIXED;\nEND_FUNCTION_BLOCK\n");
  bench.write("log.csv", "t,x\n0,0\n0.001,3\n");
  EXPECT_EQ(bench.shell(std::string(go) + " --trace plant.half,PLANT.Y,T,X,PLANT.AMP.XOUT,PLANT.U,FIXED").code, 0);
  EXPECT_EQ(bench.read("out.csv"),
            "t,Z,PLANT.HALF,PLANT.Y,P.T,X,PLANT.AMP.XOUT,PLANT.U,FIXED\n"
            "0,10,0.5,2.5,1,0,2,1,7.5\n"
            "0.001,17.5,2,10,4,3,8,4,7.5\n");
  EXPECT_THAT(refusal(std::string(go) + " --trace PLANT.HALB"), HasSubstr("PLANT.HALF?"));
}

TEST_F(Run, SummaryComparesWithRecordedOutputs) {
  bench.write("log.csv", "t,x,y,temperature\n0,1.0,0.002,20\n0.001,1.0,0.003,20\n");
  const auto outcome = bench.shell(std::string(go) + " --summary");
  EXPECT_EQ(outcome.code, 0);
  // The second row is 0.001 off, so that the root of the mean square is 0.001/√2.
  EXPECT_EQ(
      outcome.out,
      "PLANT: 2 steps of 0.001 s\n"
      "inputs\n"
      "  X                1 to 1 V\n"
      "  RESET            0, its default\n"
      "outputs\n"
      "  Y                0.002 to 0.004 V*s; RMSE against the record's column 0.0007071 V*s, 70.7 % of its range\n"
      "  BUSY             1 to 1\n"
      "columns not used: temperature\n");
}

TEST_F(Run, AMissingColumnIsNamedWithThoseThereAre) {
  bench.write("log.csv", "t,x_ref,u\n0,1,2\n0.001,1,2\n");
  EXPECT_EQ(refusal(),
            "HY502 error: log.csv:1:1: There is no column X; the columns are t, x_ref, u.\n"
            "    1 | t,x_ref,u\n"
            "      | ^^^^^^^^^\n"
            "mend: if x_ref is meant, say so: --column X=x_ref.\n"
            "note: plant.st:3:5: the input; X := … would give it a default\n"
            "    3 |     X     : LREAL;          (* @unit V @min -10 @max 10 *)\n"
            "      |     ^\n\n1 error\n");
}

TEST_F(Run, DamagedRecordsAreRefused) {
  struct Case {
    std::string csv;
    std::string said;
  };
  for (const auto& [csv, said] : {
           Case{"t,x\n0,1\n0.001,nan\n", "HY506 error: log.csv:3:7: "},
           Case{"t,x\n0,1\n0.001,one\n", "HY505 error: log.csv:3:7: "},
           Case{"t,x\n0,1\n0.001,1\n0.002,1\n0.003,1\n0.0055,1\n", "HY507 error: log.csv:6:1: "},
           Case{"t,x\n0,1\n0.002,1\n0.001,1\n", "HY508 error: log.csv:4:1: "},
           Case{"t,x\n0,1\n", "HY501 error: log.csv:1:1: "},
           Case{"", "HY501 error: log.csv: "},
           Case{"0,1\n0.001,1\n", "HY509 error: log.csv:1:1: "},
           Case{"t,x,x\n0,1,1\n0.001,1,1\n", "HY503 error: log.csv:1:3: "},
           Case{"t,x\n0,1\n0.002,1\n0.004,1\n",
                "HY704 error: log.csv:3:1: The record has a sample time of 0.002 s, PLANT one of 0.001 s.\n"
                "    3 | 0.002,1\n"
                "      | ^^^^^\n"
                "mend: state @ts 2ms in the diagram, or bring the record to 0.001 s: --resample linear, or hold for "
                "encoders and commands.\n"
                "note: plant.st:1:26: the sample time of the diagram\n"},
           Case{"t,x,reset\n0,1,0\n0.001,1,2\n",
                "HY707 error: log.csv:3:9: The column RESET is 2 at t = 0.001 s, but the input takes 0 or 1.\n"
                "    3 | 0.001,1,2\n"
                "      |         ^\n"},
       }) {
    bench.write("log.csv", csv);
    EXPECT_THAT(refusal(), HasSubstr(said)) << csv;
  }
}

TEST_F(Run, RecordsOfOtherShapesAreRead) {
  ASSERT_EQ(bench.shell(std::string(go)).code, 0);
  const auto expected = bench.read("out.csv");
  for (const std::string csv : {
           "t,x,reset\r\n0.000,1.0,0\r\n0.001,1.0,0\r\n0.002,1.0,1\r\n0.003,-0.5,0\r\n",
           "\xEF\xBB\xBFt,x,reset\n0.000,1.0,0\n0.001,1.0,0\n0.002,1.0,1\n0.003,-0.5,0\n",
           "t;x;reset\n0,000;1,0;0\n0,001;1,0;0\n0,002;1,0;1\n0,003;-0,5;0\n",
           "reset\tT [s]\tX [V]\n0\t0.000\t1.0\n0\t0.001\t1.0\n1\t0.002\t1.0\n0\t0.003\t-0.5",
       }) {
    bench.write("log.csv", csv);
    EXPECT_EQ(bench.shell(std::string(go)).code, 0) << csv;
    EXPECT_EQ(bench.read("out.csv"), expected) << csv;
  }
}

TEST_F(Run, RoundedTimesFitTheirDiagram) {
  // 6400 rows a second printed with seven decimals; 156250 ns is not what any two rows are apart.
  std::string text(test::plant);
  text.replace(text.find("1ms"), 3, "156250ns");
  bench.write("plant.st", text);
  bench.write("log.csv", "t,x\n0.0000000,1\n0.0001563,1\n0.0003125,1\n0.0004688,1\n");
  const auto outcome = bench.shell(std::string(go));
  EXPECT_EQ(outcome.code, 0) << outcome.err;
}

TEST_F(Run, WithoutASampleTimeTheRecordsIsTaken) {
  std::string text(test::plant);
  text.replace(text.find("(* @ts 1ms *)"), 13, "");
  bench.write("plant.st", text);
  bench.write("log.csv", "t,x\n0,1\n0.5,1\n");
  EXPECT_EQ(bench.shell(std::string(go)).code, 0);
  EXPECT_EQ(bench.read("out.csv"), "t,Y,BUSY\n0,1,1\n0.5,2,1\n");
}

TEST_F(Run, ValuesOutsideTheRangeAreAWarning) {
  bench.write("log.csv", "t,x\n0,1\n0.001,11\n0.002,-12.5\n");
  const auto outcome = bench.shell(std::string(go));
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.err,
            "HY705 warning: log.csv:3:7: The column X leaves the range of the input, -10 to 10: 2 values, the first at "
            "t = 0.001 s, the farthest -12.5.\n"
            "    3 | 0.001,11\n"
            "      |       ^^\n"
            "mend: check the unit and the scale of the column, or widen @min and @max in the diagram.\n\n1 warning\n"
            "note: log.csv: input RESET has no column, and keeps its default 0\n");
  EXPECT_TRUE(bench.has("out.csv"));
}

/// What a run writes of a DINT, a run reads; the least of them has no positive partner.
TEST_F(Run, ReadsEveryWholeNumberOf32Bits) {
  bench.write("count.st",
              "FUNCTION_BLOCK COUNT (* @ts 1ms *)\n  VAR_INPUT N : DINT; END_VAR\n  VAR_OUTPUT M : DINT; END_VAR\n"
              "  M := N;\nEND_FUNCTION_BLOCK\n");
  bench.write("count.csv", "t,N\n0,-2147483648\n0.001,2147483647\n0.002,0\n");
  const auto outcome = bench.shell("hysteron run count.st --in count.csv --out -");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "t,M\n0,-2147483648\n0.001,2147483647\n0.002,0\n");
  for (const std::string beyond : {"-2147483649", "2147483648", "0.5"}) {
    bench.write("count.csv", "t,N\n0," + beyond + "\n0.001,0\n0.002,0\n");
    EXPECT_THAT(bench.shell("hysteron run count.st --in count.csv --out -").err, HasSubstr("HY707")) << beyond;
  }
}

/// An input of a body takes what its type takes: 70000 as an INT had been 4464.
TEST_F(Run, AnInputTakesTheWholeNumbersOfItsDeclaredType) {
  bench.write("body.st",
              "FUNCTION_BLOCK B (* @ts 1ms @body *)\n  VAR_INPUT I : INT; K : BYTE; S : USINT; U : UDINT; END_VAR\n"
              "  VAR_OUTPUT M : INT; V : UDINT; BIG : BOOL; END_VAR\n"
              "  IF K > 0 OR S > 0 THEN M := I; END_IF; V := U; BIG := U > 3999999999;\nEND_FUNCTION_BLOCK\n");
  bench.write("body.csv", "t,I,K,S,U\n0,-32768,255,0,4000000000\n0.001,32767,0,255,-294967296\n0.002,0,0,0,0\n");
  const auto outcome = bench.shell("hysteron run body.st --in body.csv --out -");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "t,M,V,BIG\n0,-32768,-294967296,1\n0.001,32767,-294967296,1\n0.002,32767,0,0\n");
  for (const std::string beyond : {"70000,0,0,0", "0,300,0,0", "0,0,-5,0", "0,0,0,4294967296"}) {
    bench.write("body.csv", "t,I,K,S,U\n0," + beyond + "\n0.001,0,0,0,0\n0.002,0,0,0,0\n");
    EXPECT_THAT(bench.shell("hysteron run body.st --in body.csv --out -").err,
                AllOf(HasSubstr("HY707"), HasSubstr("takes whole numbers from ")))
        << beyond;
  }
}

TEST_F(Run, NamesPlacesInTheStandardInput) {
  const auto outcome = bench.shell("printf 't,x\\n0,1\\n0.001,11\\n' | hysteron run plant.st --in - --out out.csv");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.err, AllOf(StartsWith("HY705 warning: -:3:7: "), HasSubstr("    3 | 0.001,11\n")));
}

TEST_F(Run, NotANumberIsNeverSilent) {
  bench.write("plant.st",
              "FUNCTION_BLOCK P (* @ts 1ms *) VAR_INPUT X : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR\n"
              "Y := 1.0 / X;\nEND_FUNCTION_BLOCK\n");
  bench.write("log.csv", "t,x\n0,1\n0.001,0\n0.002,0\n0.003,2\n");
  const auto outcome = bench.shell(std::string(go));
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err,
              AllOf(StartsWith("HY706 error: plant.st:1:72: Y is infinite at step 1 (t = 0.001 s), and in 2 steps in "
                               "all.\n    1 | FUNCTION_BLOCK P "),
                    HasSubstr("\nmend: look for a division by 0")));
  EXPECT_EQ(bench.read("out.csv"), "t,Y\n0,1\n0.001,inf\n0.002,inf\n0.003,0.5\n");
}

TEST_F(Run, NeverOverwritesItsInputs) {
  EXPECT_THAT(refusal("hysteron run plant.st --in log.csv --out ./log.csv"), HasSubstr("HY709"));
  EXPECT_THAT(refusal("hysteron run plant.st --in log.csv --out plant.st"), HasSubstr("HY709"));
  ASSERT_EQ(bench.shell("ln -s log.csv other.csv").code, 0);
  EXPECT_THAT(refusal("hysteron run plant.st --in log.csv --out other.csv"), HasSubstr("HY709"));
  EXPECT_EQ(bench.read("log.csv"), test::plant_log);
}

TEST_F(Run, NoFolderIsMadeForTheOutput) {
  EXPECT_THAT(refusal("hysteron run plant.st --in log.csv --out none/out.csv"),
              AllOf(HasSubstr("HY700"), HasSubstr("mkdir -p none")));
  EXPECT_FALSE(bench.has("none"));
}

TEST_F(Run, MillisecondsInTheColumnOfTheTimeAreNamed) {
  bench.write("log.csv", "t,x\n0,1\n1,1\n2,1\n");
  EXPECT_THAT(refusal(),
              AllOf(HasSubstr("HY704"), HasSubstr("if its times are in milliseconds, read it with --time t[ms]"),
                    HasSubstr("@ts 1s ")));
}

TEST_F(Run, AnOldOutputSurvivesAFailingRun) {
  bench.write("out.csv", "precious\n");
  bench.write("log.csv", "t,x\n0,1\n0.001,one\n");
  EXPECT_THAT(refusal(), HasSubstr("HY505"));
  EXPECT_EQ(bench.read("out.csv"), "precious\n");
}

TEST_F(Run, ParametersThatDoNotFitAreRefused) {
  const auto with = [&](const std::string& toml) {
    bench.write("p.toml", toml);
    return refusal(std::string(go) + " --params p.toml");
  };
  EXPECT_EQ(with("[parameters.AMP]\nG = 1.0\nK = 2.0\n"),
            "HY603 error: p.toml:2:1: PLANT has no parameter AMP.G.\n"
            "    2 | G = 1.0\n"
            "      | ^\n"
            "mend: did you mean AMP.K?\n\n1 error\n");
  EXPECT_THAT(with("[parameters.AMP]\nK = true\n"), AllOf(HasSubstr("HY604 error: p.toml:2:5: "), HasSubstr("K = ")));
  EXPECT_THAT(with("[parameters.AMP]\nK = 1\nk = 2\n"), HasSubstr("HY602 error: p.toml:3:1: "));
  EXPECT_THAT(with("[parameters.AMP]\nK = nan\n"), HasSubstr("HY605 error: p.toml:2:5: "));
  EXPECT_THAT(with("[parameters.AMP\n"), HasSubstr("HY601 error: p.toml:1:"));
  EXPECT_THAT(with("[fit.AMP]\nC9 = {}\n"), AllOf(HasSubstr("HY603 error: p.toml:2:1: "), HasSubstr("AMP.C9")));
}

TEST_F(Run, ASampleTimeIsToldAsItIsWritten) {
  bench.write("plant.st",
              "FUNCTION_BLOCK P (* @ts 300us *) VAR_INPUT X : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR\n"
              "Y := X + 1.0;\nEND_FUNCTION_BLOCK\n");
  bench.write("log.csv", "t,x\n0,1\n0.0005,1\n0.001,1\n");
  EXPECT_THAT(refusal(), HasSubstr("The record has a sample time of 0.0005 s, P one of 0.0003 s."));
}

TEST_F(Run, TheTopBlockCanBeChosen) {
  bench.write("plant.st",
              "FUNCTION_BLOCK A (* @ts 1ms *) VAR_INPUT X : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR\n"
              "Y := X + 1.0;\nEND_FUNCTION_BLOCK\n"
              "FUNCTION_BLOCK B (* @ts 1ms *) VAR_INPUT X : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR\n"
              "Y := X + 2.0;\nEND_FUNCTION_BLOCK\n");
  EXPECT_THAT(refusal(), AllOf(HasSubstr("HY215"), HasSubstr("--top")));
  EXPECT_EQ(bench.shell(std::string(go) + " --top b").code, 0);
  EXPECT_THAT(bench.read("out.csv"), StartsWith("t,Y\n0,3\n"));
}

TEST_F(Run, AnyOrderTurnsHiddenDelaysIntoWarnings) {
  bench.write("plant.st",
              "FUNCTION_BLOCK P (* @ts 1ms *) VAR_INPUT X : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR\n"
              "VAR A : HY_GAIN := (K := 2.0); B : HY_GAIN := (K := 3.0); END_VAR\n"
              "B(XIN := A.XOUT);\nA(XIN := X);\nY := B.XOUT;\nEND_FUNCTION_BLOCK\n");
  EXPECT_THAT(refusal(), HasSubstr("HY402 error"));
  const auto outcome = bench.shell(std::string(go) + " --any-order");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("HY402 warning"), Not(HasSubstr("error:"))));
  EXPECT_THAT(bench.read("out.csv"), StartsWith("t,Y\n0,6\n"));
}

TEST_F(Run, OutputIsARecord) {
  ASSERT_EQ(bench.shell(std::string(go)).code, 0);
  const auto record = records::read_record((bench.path() / "out.csv").string());
  EXPECT_EQ(record.names(), (std::vector<std::string>{"Y", "BUSY"}));
  EXPECT_EQ(record.column("Y").values, (std::vector<double>{0.002, 0.004, 0.0, -0.001}));
}

}  // namespace
}  // namespace hysteron
