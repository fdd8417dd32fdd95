// Sequential bodies: what they compute, against a second reading; what is refused; when a block is one.
#include "codegen/graph/body/body.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "codegen/compile.hpp"
#include "codegen/interpreter/machine.hpp"
#include "codegen/language/time_literal.hpp"
#include "support/errors.hpp"
#include "tests/codegen/backends/recorded_run.hpp"
#include "tests/codegen/random_body.hpp"
#include "tests/codegen/refusal.hpp"
#include "tests/codegen/sequential_body.hpp"

namespace hysteron::testing {
namespace {

std::vector<std::string> faults_of(const std::string& text) {
  Diagnostics found;
  const auto source = std::make_shared<const language::SourceFile>(language::parse("t", text, found));
  if (!found.has_errors()) {
    check(source, found);
  }
  std::vector<std::string> list;
  for (const Diagnostic& one : found.all()) {
    list.push_back(fmt::format("{}:{}", one.number, one.place.line));
  }
  return list;
}
using Faults = std::vector<std::string>;

/// The outputs of one step after another, for inputs by row.
std::vector<double> run_body(const std::string& text, const std::vector<std::vector<double>>& rows) {
  const Program program = compile_text(text);
  Machine<double> machine(program, 0.01);
  std::vector<double> results;
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      machine.set_input(i, row[i]);
    }
    machine.step();
    for (std::size_t i = 0; i < program.graph.outputs.size(); ++i) {
      results.push_back(machine.output(i));
    }
  }
  return results;
}

TEST(Bodies, APlainNumberAsATimeIsAskedForItsUnit) {
  for (const auto& [number, mend] : {std::pair{"2", "Write it with its unit: T#2s, or T#2ms."},
                                     {"0.5", "Write it with its unit: T#0.5s, or T#0.5ms."},
                                     {"DINT#2", "Convert it: DINT_TO_TIME( … )."}}) {
    const auto told = testing::refusals(
        fmt::format("FUNCTION_BLOCK B (* @ts 10ms @body *)\n  VAR_OUTPUT Y : LREAL; END_VAR\n  VAR D : TIME; END_VAR\n"
                    "  D := {};\n  Y := 1.0;\nEND_FUNCTION_BLOCK\n",
                    number));
    ASSERT_FALSE(told.empty()) << number;
    EXPECT_EQ(told.front().mend, mend) << number;
  }
}

TEST(Bodies, RandomOnesComputeWhatTheirStatementsSay) {
  constexpr std::size_t bodies = 150;
  constexpr std::size_t steps = 60;
  static const std::vector<std::string> inputs{"X1", "X2", "X3", "B1", "B2", "N1"};
  static const std::vector<std::string> outputs{"Y0", "Y1", "Y2", "Y3", "Q", "N"};
  for (std::size_t i = 0; i < bodies; ++i) {
    const RandomBody body(i + 4242, "P", i % 3 == 0 ? 4 : 14);
    const Program program = body.program();
    Diagnostics none;
    const auto source = language::parse("t", body.text(), none);
    SequentialBody reading(*source.bodies, "P");
    Machine<double> machine(program);
    const auto rows = random_rows(steps, i);
    for (std::size_t k = 0; k < steps; ++k) {
      for (std::size_t pin = 0; pin < inputs.size(); ++pin) {
        machine.set_input(pin, rows[k * inputs.size() + pin]);
        reading.set(inputs[pin], rows[k * inputs.size() + pin]);
      }
      machine.step();
      reading.step();
      for (std::size_t pin = 0; pin < outputs.size(); ++pin) {
        ASSERT_TRUE(same_bits(machine.output(pin), reading.get(outputs[pin])))
            << "body " << i << ", step " << k << ", " << outputs[pin] << ": " << machine.output(pin) << " for "
            << reading.get(outputs[pin]) << "\n"
            << body.text();
      }
    }
  }
}

TEST(Bodies, AVariableThatIsReadFirstIsMemory) {
  const std::string text =
      "FUNCTION_BLOCK F VAR_INPUT UP : BOOL; END_VAR VAR_OUTPUT N : INT := 32766; END_VAR\n"
      "IF UP THEN N := N + 1; END_IF; END_FUNCTION_BLOCK";
  EXPECT_EQ(run_body(text, {{1}, {0}, {1}, {1}}), (std::vector<double>{32767, 32767, -32768, -32767}));
}

TEST(Bodies, AnInstanceThatIsNotCalledKeepsWhatItHas) {
  const std::string text =
      "FUNCTION_BLOCK F VAR_INPUT ON : BOOL; CLK : BOOL; END_VAR VAR_OUTPUT N : INT; END_VAR\n"
      "VAR C : CTU; END_VAR IF ON THEN C(CU := CLK, R := FALSE, PV := 9); END_IF; N := C.CV; END_FUNCTION_BLOCK";
  EXPECT_EQ(run_body(text, {{1, 1}, {1, 0}, {0, 1}, {0, 0}, {1, 1}}), (std::vector<double>{1, 1, 1, 1, 2}));
}

TEST(Bodies, ATimerTakesTimesOfTheText) {
  const std::string text =
      "FUNCTION_BLOCK F (* @ts 10ms *) VAR_INPUT ON : BOOL; END_VAR VAR_OUTPUT Q : BOOL; END_VAR\n"
      "VAR T : TON; WAIT : TIME := T#20ms; END_VAR T(IN := ON, PT := WAIT); Q := T.Q; END_FUNCTION_BLOCK";
  EXPECT_EQ(run_body(text, {{1}, {1}, {1}, {0}, {1}}), (std::vector<double>{0, 0, 1, 0, 0}));
}

/// [1, 2, 3, 4] of two dimensions: the last one runs fastest, as in IEC 61131-3; rows in brackets say the same.
TEST(Bodies, InitialValuesOfArraysAreThoseWritten) {
  const auto first_values = [](const std::string& declaration) {
    return run_body(
        "FUNCTION_BLOCK P\nVAR_INPUT N : INT; END_VAR\nVAR_OUTPUT A : INT; B : INT; C : INT; D : INT; END_VAR\nVAR AR "
        ": " +
            declaration + "; END_VAR\nA := AR[1,1]; B := AR[1,2]; C := AR[2,1]; D := AR[2,2];\nEND_FUNCTION_BLOCK\n",
        {{0.0}});
  };
  EXPECT_EQ(first_values("ARRAY[1..2, 1..2] OF INT := [1, 2, 3, 4]"), (std::vector<double>{1, 2, 3, 4}));
  EXPECT_EQ(first_values("ARRAY[1..2, 1..2] OF INT := [[1, 2], [3, 4]]"), (std::vector<double>{1, 2, 3, 4}));
  EXPECT_EQ(first_values("ARRAY[1..2, 1..2] OF INT := [4(7)]"), (std::vector<double>{7, 7, 7, 7}));
  EXPECT_EQ(
      faults_of("FUNCTION_BLOCK P\nVAR AR : ARRAY[0..1] OF INT := [1, 2, 3]; END_VAR\nVAR_OUTPUT A : INT; END_VAR\n"
                "A := AR[0];\nEND_FUNCTION_BLOCK\n")
          .size(),
      1U);
}

TEST(Bodies, WhatCountsALoopIsNotAssignedInIt) {
  const auto loop = [](const std::string& statements) {
    return faults_of(
        "FUNCTION_BLOCK P\nVAR_INPUT N : INT; END_VAR\nVAR_OUTPUT S : INT; END_VAR\nVAR I : INT; END_VAR\n"
        "FOR I := 0 TO 3 DO " +
        statements + " S := S + 1; END_FOR;\nEND_FUNCTION_BLOCK\n");
  };
  EXPECT_EQ(loop("IF N = I THEN S := 5; END_IF;"), Faults());
  EXPECT_EQ(loop("IF N = I THEN I := 99; END_IF;"), Faults{fmt::format("{}:5", error::refused_in_body)});
  EXPECT_EQ(loop("I := I + 1;"), Faults{fmt::format("{}:5", error::refused_in_body)});
}

TEST(Bodies, ACounterGoesOnAboveItsPreset) {
  EXPECT_EQ(
      run_body("FUNCTION_BLOCK P\nVAR_INPUT X : BOOL; END_VAR\nVAR_OUTPUT N : INT; END_VAR\nVAR C : CTU; END_VAR\n"
               "IF TRUE THEN C(CU := X, PV := 2); END_IF;\nN := C.CV;\nEND_FUNCTION_BLOCK\n",
               {{1}, {0}, {1}, {0}, {1}}),
      (std::vector<double>{1, 1, 2, 2, 3}));
}

TEST(Bodies, AVarInOutAtTheBorderIsAnInputAndAnOutput) {
  const Program program =
      compile_text("FUNCTION_BLOCK F VAR_IN_OUT X : LREAL; END_VAR X := X * 2.0; END_FUNCTION_BLOCK");
  ASSERT_NE(find_port(program.graph.inputs, "X"), nullptr);
  EXPECT_NE(find_port(program.graph.outputs, "X_OUT"), nullptr);
}

TEST(Bodies, ADiagramWiresABodyLikeAnyBlock) {
  const std::string text =
      "FUNCTION_BLOCK HOLD VAR_INPUT X : LREAL; TAKE : BOOL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR\n"
      "IF TAKE THEN Y := X; END_IF; END_FUNCTION_BLOCK\n"
      "FUNCTION_BLOCK TOP VAR_INPUT X : LREAL; B : BOOL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR VAR H : HOLD; END_VAR\n"
      "H(X := X + 1.0, TAKE := B); Y := H.Y; END_FUNCTION_BLOCK";
  const Program program = compile_text(text, {.top = "TOP"});
  Machine<double> machine(program, 0.01);
  std::vector<double> results;
  for (const auto& [x, take] : {std::pair{1.0, 1.0}, {5.0, 0.0}, {7.0, 1.0}}) {
    machine.set_input(0, x);
    machine.set_input(1, take);
    machine.step();
    results.push_back(machine.output(0));
  }
  EXPECT_EQ(results, (std::vector<double>{2, 2, 8}));
}

TEST(Bodies, AnUnmarkedTextThatADiagramCanSayStaysOne) {
  const std::string twice =
      "VAR_INPUT X : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR Y := X; Y := Y + 1.0; END_FUNCTION_BLOCK";
  EXPECT_EQ(faults_of("FUNCTION_BLOCK F " + twice), (Faults{fmt::format("{}:1", error::double_drive)}));
  EXPECT_EQ(faults_of("FUNCTION_BLOCK F (* @body *) " + twice), Faults{});
  EXPECT_EQ(run_body("FUNCTION_BLOCK F (* @body *) " + twice, {{1}, {2}}), (std::vector<double>{2, 3}));
}

TEST(Bodies, EveryLineThatStandsInTheWayIsToldOnce) {
  EXPECT_EQ(faults_of("FUNCTION_BLOCK F\nVAR_INPUT X : INT; END_VAR\nVAR P : POINTER TO INT; S : STRING; END_VAR\n"
                      "WHILE X > 1 DO\n  X := X - 1;\nEND_WHILE;\nP^ := 3;\nEND_FUNCTION_BLOCK"),
            (Faults{"129:3", "129:3", "129:7"}));
  EXPECT_EQ(faults_of("FUNCTION_BLOCK F\nVAR_INPUT X : INT; END_VAR VAR_OUTPUT Y : INT; B : BOOL; END_VAR\n"
                      "IF X THEN Y := 1; END_IF;\nY := NOWHERE;\nB := X;\nY := X + B;\nEND_FUNCTION_BLOCK"),
            (Faults{"207:3", "203:4", "207:5", "207:6"}));
}

TEST(Bodies, LoopsAndCallsHaveBounds) {
  const auto loop = [](const std::string& to) {
    return "FUNCTION_BLOCK F VAR_INPUT X : INT; END_VAR VAR_OUTPUT Y : INT; END_VAR VAR I : INT; END_VAR\nFOR I := 1 "
           "TO " +
           to + " DO Y := Y + I; END_FOR; END_FUNCTION_BLOCK";
  };
  EXPECT_EQ(faults_of(loop("10")), Faults{});
  EXPECT_EQ(faults_of(loop("X")), Faults{"129:2"});
  EXPECT_EQ(faults_of(loop("MIN(X, 20)")), Faults{});
  EXPECT_EQ(faults_of(loop("LIMIT(0, X, 20) - 1 BY X")), Faults{"129:2"});
  EXPECT_EQ(faults_of(loop("20 BY 0")), Faults{"129:2"});
  EXPECT_EQ(faults_of(loop("30000")), Faults{"129:2"});
  EXPECT_FALSE(faults_of("FUNCTION A : INT VAR_INPUT X : INT; END_VAR A := A(X); END_FUNCTION\n"
                         "FUNCTION_BLOCK F VAR_OUTPUT Y : INT; END_VAR Y := A(1); END_FUNCTION_BLOCK")
                   .empty());
  EXPECT_FALSE(faults_of("FUNCTION_BLOCK F VAR X : F; N : INT; END_VAR X(); END_FUNCTION_BLOCK").empty());
}

TEST(Bodies, AForGoesFromAndToWhatItIsGiven) {
  const auto loop = [](const std::string& head) {
    return "FUNCTION_BLOCK F VAR_INPUT A : INT; B : INT; END_VAR VAR_OUTPUT S : DINT; LEFT : INT; END_VAR VAR I : INT; "
           "END_VAR\nS := 0;\nIF A > 6 THEN A := 6; ELSIF A < -6 THEN A := -6; END_IF;\nIF NOT (B <= 5 AND B >= 0) "
           "THEN B "
           ":= 5; END_IF;\n" +
           head + " DO S := S * 10 + I; IF S > 7000 THEN EXIT; END_IF; END_FOR; LEFT := I; END_FUNCTION_BLOCK";
  };
  EXPECT_EQ(run_body(loop("FOR I := 1 TO B"), {{0, 3}, {0, 0}, {0, 5}, {0, 99}}),
            (std::vector<double>{123, 4, 0, 1, 12345, 5, 12345, 5}));
  EXPECT_EQ(run_body(loop("FOR I := A TO B"), {{2, 3}, {4, 3}, {2, 2}, {9, 5}}),
            (std::vector<double>{23, 4, 0, 4, 2, 3, 0, 6}));
  EXPECT_EQ(run_body(loop("FOR I := A TO B BY -1"), {{3, 1}, {1, 3}, {3, 3}}),
            (std::vector<double>{321, 0, 0, 1, 3, 2}));
  EXPECT_EQ(run_body(loop("FOR I := 0 TO B BY 2"), {{0, 5}, {0, 0}}), (std::vector<double>{24, 6, 0, 2}));
  EXPECT_EQ(faults_of(loop("FOR I := A TO B BY 2")), Faults{"129:5"});
}

TEST(Bodies, ABoundOfAForIsAWholeNumber) {
  const auto loop = [](const std::string& head) {
    return "FUNCTION_BLOCK F VAR_OUTPUT S : DINT; END_VAR VAR I : INT; END_VAR\nS := 0;\n" + head +
           " DO S := S + I; END_FOR; END_FUNCTION_BLOCK";
  };
  const Faults mismatch{fmt::format("{}:3", error::type_mismatch)};
  for (const char* const head : {"FOR I := 1 TO 3.7", "FOR I := 1 TO 3.0", "FOR I := 1 TO T#3s", "FOR I := 0 TO TRUE",
                                 "FOR I := 1.5 TO 3", "FOR I := 1 TO 3 BY 0.5", "FOR I := 1 TO 3 BY 1.0"}) {
    EXPECT_EQ(faults_of(loop(head)), mismatch) << head;
  }
  EXPECT_EQ(faults_of(loop("FOR I := 1 TO 3 BY 2")), Faults{});
}

TEST(Bodies, TheCounterOfAForHoldsItsBounds) {
  const auto loop = [](const std::string& type, const std::string& head) {
    return "FUNCTION_BLOCK F VAR_INPUT N : DINT; END_VAR VAR_OUTPUT S : DINT; END_VAR VAR I : " + type +
           "; END_VAR\nS := 0;\nFOR I := " + head + " DO S := S + I; END_FOR; END_FUNCTION_BLOCK";
  };
  const Faults mismatch{fmt::format("{}:3", error::type_mismatch)};
  EXPECT_EQ(faults_of(loop("INT", "32766 TO LIMIT(32766, N, 40000)")), mismatch);
  EXPECT_EQ(faults_of(loop("INT", "1 TO 40000 BY 20000")), mismatch);
  EXPECT_EQ(faults_of(loop("INT", "-32767 TO -40000 BY -1")), mismatch);
  EXPECT_EQ(faults_of(loop("BYTE", "LIMIT(-1, N, 3) TO 5")), mismatch);
  EXPECT_EQ(faults_of(loop("SINT", "120 TO 128")), mismatch);
  EXPECT_EQ(faults_of(loop("DINT", "32766 TO LIMIT(32766, N, 40000)")), Faults{});
  EXPECT_EQ(faults_of(loop("SINT", "120 TO 126")), Faults{});
  EXPECT_EQ(faults_of(loop("BYTE", "0 TO LIMIT(0, N, 9) - 1")), Faults{});
}

TEST(Bodies, RemaindersQuotientsAndShiftsHaveRanges) {
  const auto loop = [](const std::string& head) {
    return "FUNCTION_BLOCK F VAR_INPUT N : DINT; W : DWORD; K : INT; END_VAR VAR_OUTPUT S : DINT; END_VAR VAR I : "
           "DINT; "
           "END_VAR\nS := 0;\nFOR I := " +
           head + " DO S := S + I; END_FOR; END_FUNCTION_BLOCK";
  };
  EXPECT_EQ(run_body(loop("1 TO N MOD 7"), {{6, 0, 0}, {-1, 0, 0}, {10, 0, 0}}), (std::vector<double>{21, 0, 6}));
  EXPECT_EQ(run_body(loop("N MOD 4 TO 3"), {{-3, 0, 0}, {6, 0, 0}}), (std::vector<double>{0, 5}));
  EXPECT_EQ(run_body(loop("-3 TO N MOD -4"), {{-3, 0, 0}, {6, 0, 0}}), (std::vector<double>{-3, -3}));
  EXPECT_EQ(run_body(loop("1 TO ABS(N) MOD 7"), {{-6, 0, 0}, {5, 0, 0}}), (std::vector<double>{21, 15}));
  EXPECT_EQ(run_body(loop("0 TO ABS(LIMIT(-4, N, 2))"), {{-9, 0, 0}, {9, 0, 0}}), (std::vector<double>{10, 3}));
  EXPECT_EQ(run_body(loop("1 TO LIMIT(-20, N, 20) / 4"), {{-9, 0, 0}, {9, 0, 0}}), (std::vector<double>{0, 3}));
  EXPECT_EQ(run_body(loop("1 TO DWORD_TO_DINT(SHR(W, 28))"), {{0, -1, 0}, {0, 536870912, 0}}),
            (std::vector<double>{120, 3}));
  EXPECT_EQ(run_body(loop("1 TO SHL(LIMIT(0, N, 3), 2)"), {{2, 0, 0}, {9, 0, 0}}), (std::vector<double>{36, 78}));
  EXPECT_EQ(faults_of(loop("1 TO SHL(N, 2)")), Faults{"129:3"});
  EXPECT_EQ(faults_of(loop("1 TO N / 2")), Faults{"129:3"});
}

TEST(Bodies, AWhileThatItsNumbersEndIsUnrolled) {
  const auto body = [](const std::string& statements) {
    return "FUNCTION_BLOCK F VAR_INPUT X : INT; R : LREAL; END_VAR VAR_OUTPUT N : INT; END_VAR VAR_TEMP Y : INT; Z : "
           "LREAL; "
           "END_VAR\nN := 0; Y := X; Z := R;\n" +
           statements + " END_FUNCTION_BLOCK";
  };
  EXPECT_EQ(run_body(body("WHILE Y > 1 DO Y := Y / 2; N := N + 1; END_WHILE;"), {{1, 0}, {8, 0}, {-5, 0}, {32767, 0}}),
            (std::vector<double>{0, 3, 0, 14}));
  EXPECT_EQ(run_body(body("REPEAT N := N + 1; UNTIL N >= 7 OR N = X END_REPEAT;"), {{1, 0}, {5, 0}, {0, 0}}),
            (std::vector<double>{1, 5, 7}));
  EXPECT_EQ(run_body(body("WHILE N < 9 DO N := N + 1; IF N = X THEN EXIT; END_IF; END_WHILE;"), {{4, 0}, {0, 0}}),
            (std::vector<double>{4, 9}));
  EXPECT_EQ(faults_of(body("WHILE Z > 1.0 DO Z := Z / 2.0; END_WHILE;")), Faults{"129:3"});
  EXPECT_EQ(faults_of(body("WHILE Y <> 0 DO Y := Y - 3; END_WHILE;")), Faults{"129:3"});
  EXPECT_EQ(faults_of(body("REPEAT N := N + 1; UNTIL FALSE END_REPEAT;")), Faults{"129:3"});
}

/// A counter of other compilers goes on from the other end of its type, where its last round is at this one.
TEST(Bodies, ACounterThatCannotPassItsLastRoundIsRefused) {
  const auto faults = [](const std::string& type, const std::string& head) {
    Diagnostics found;
    check(std::make_shared<const language::SourceFile>(language::parse(
              "t",
              "FUNCTION_BLOCK F VAR_INPUT X : USINT; D : DINT; END_VAR VAR_OUTPUT N : DINT; END_VAR VAR C : " + type +
                  "; END_VAR\nFOR C := " + head + " DO N := N + 1; END_FOR; END_FUNCTION_BLOCK",
              found)),
          found);
    std::string text;
    for (const Diagnostic& one : found.all()) {
      text += fmt::format("HY{} {}. {}", one.number, one.cause, one.mend);
    }
    return text;
  };
  EXPECT_EQ(
      faults("USINT", "250 TO 255"),
      "HY207 'C' is USINT, and does not hold 256, which stands behind the last round: where a USINT ends at 255, a PLC "
      "goes on from the other end, and this FOR never ends. Count by a DINT, or end it at 254 at the latest.");
  EXPECT_EQ(
      faults("USINT", "3 TO 0 BY -1"),
      "HY207 'C' is USINT, and does not hold -1, which stands behind the last round: where a USINT ends at 0, a PLC "
      "goes on from the other end, and this FOR never ends. Count by a DINT, or end it at 1 at the lowest.");
  EXPECT_EQ(
      faults("DINT", "2147483640 TO 2147483647"),
      "HY207 'C' is DINT, and does not hold 2147483648, which stands behind the last round: where a DINT ends at "
      "2147483647, a PLC goes on from the other end, and this FOR never ends. End it at 2147483646 at the latest.");
  EXPECT_THAT(faults("INT", "32760 TO 32767 BY 5"), ::testing::StartsWith("HY207"));
  EXPECT_THAT(faults("USINT", "250 TO X"),
              ::testing::StartsWith("HY217 this FOR may count 'C' to 255: where a USINT ends at 255, a PLC goes on"));
  for (const char* const head : {"250 TO 254", "3 TO 1 BY -1", "0 TO 251 BY 4", "5 TO 3", "0 TO MIN(X, 254)"}) {
    EXPECT_EQ(faults("USINT", head), "") << head;
  }
  EXPECT_EQ(faults("INT", "0 TO X"), "");
}

TEST(Bodies, AChoiceOfLiteralsTakesTheTypeItIsAssignedTo) {
  const auto body = [](const std::string& type, const std::string& value) {
    return "FUNCTION_BLOCK F VAR_INPUT B : BOOL; X : INT; END_VAR VAR_OUTPUT Y : " + type + "; END_VAR\nY := " + value +
           "; END_FUNCTION_BLOCK";
  };
  EXPECT_EQ(run_body(body("BYTE", "SEL(B, 0, 255)"), {{0, 0}, {1, 0}}), (std::vector<double>{0, 255}));
  EXPECT_EQ(run_body(body("REAL", "SEL(B, 0.5, 0.1)"), {{0, 0}, {1, 0}}), (std::vector<double>{0.5, 0.1F}));
  EXPECT_EQ(faults_of(body("BYTE", "SEL(B, 0, 256)")), Faults{fmt::format("{}:2", error::type_mismatch)});
  EXPECT_EQ(faults_of(body("SINT", "SEL(B, 0, X)")), Faults{fmt::format("{}:2", error::type_mismatch)});
}

TEST(Bodies, WhatIsWrongIsSaidOfWhatWasWritten) {
  const auto first = [](const std::string& statement) {
    Diagnostics found;
    check(std::make_shared<const language::SourceFile>(
              language::parse("t",
                              "FUNCTION_BLOCK F (* @ts 1ms @body *) VAR_INPUT N : DINT; B : BOOL; END_VAR VAR_OUTPUT T "
                              ": TIME; Y : BYTE; END_VAR\n" +
                                  statement + " END_FUNCTION_BLOCK",
                              found)),
          found);
    for (const Diagnostic& one : found.all()) {
      if (one.place.line == 2) {
        return fmt::format("{}+{} {} {}", one.place.column, one.place.length, one.cause, one.mend);
      }
    }
    return std::string();
  };
  EXPECT_NE(
      first("T := TIME;").find("'TIME' is a type, no value Name a variable; the time since the first step is TIME()"),
      std::string::npos);
  EXPECT_NE(first("T := TIME(1);").find("TIME() takes no argument"), std::string::npos);
  EXPECT_EQ(first("WHILE N DO N := 0; END_WHILE;").substr(0, 4), "7+1 ");
  EXPECT_EQ(first("REPEAT N := 0; UNTIL N END_REPEAT;").substr(0, 5), "22+1 ");
  EXPECT_NE(first("Y := SEL(B, 0, 256);")
                .find("does not hold 256, which this may give Write numbers from 0 to 255, or limit it"),
            std::string::npos);
}

TEST(Bodies, TheTimeOfTheTaskIsReadInWholeMilliseconds) {
  const auto at = [](const std::string& ts) {
    return "FUNCTION_BLOCK F (* " + ts +
           " *) VAR_OUTPUT MS : DINT; END_VAR VAR N : INT; END_VAR\nN := N + 1; IF N < 3 THEN MS := "
           "TIME_TO_DINT(TIME()); ELSE MS := TIME_TO_DINT(TIME()); END_IF; END_FUNCTION_BLOCK";
  };
  const std::vector<std::vector<double>> six(6);
  EXPECT_EQ(run_body(at("@ts 10ms"), six), (std::vector<double>{0, 10, 20, 30, 40, 50}));
  EXPECT_EQ(run_body(at("@ts 400us"), six), (std::vector<double>{0, 0, 0, 1, 1, 2}));
  EXPECT_EQ(run_body(at("@ts 2500us"), six), (std::vector<double>{0, 2, 5, 7, 10, 12}));
  const Faults untimed{"217:2", fmt::format("{}:2", error::missing_sample_time), "217:2"};
  EXPECT_EQ(faults_of(at("")), untimed);
  // A block within another one has the sample time of the outermost.
  const std::string outer =
      "\nFUNCTION_BLOCK G (* {} @body *) VAR_OUTPUT MS : DINT; END_VAR VAR A : F; END_VAR A(); MS := A.MS; "
      "END_FUNCTION_BLOCK";
  EXPECT_EQ(run_body(at("") + fmt::format(fmt::runtime(outer), "@ts 10ms"), six),
            (std::vector<double>{0, 10, 20, 30, 40, 50}));
  EXPECT_EQ(faults_of(at("") + fmt::format(fmt::runtime(outer), "")), untimed);
  EXPECT_THROW((void)compile_text(at("") + fmt::format(fmt::runtime(outer), "@ts 10ms"), {.top = "F"}), InputError);
}

/// A timer that is called at two places, once in each step, is that of the library.
TEST(Bodies, ATimerUnderAConditionRunsByTheTimeOfTheTask) {
  const auto body = [](const std::string& ts, const std::string& type, const std::string& call) {
    return "FUNCTION_BLOCK F (* @ts " + ts +
           " @body *) VAR_INPUT X : BOOL; B : BOOL; P : INT; END_VAR VAR_OUTPUT Q : BOOL; ET : "
           "TIME; END_VAR VAR T : " +
           type + "; END_VAR\n" + call + " Q := T.Q; ET := T.ET; END_FUNCTION_BLOCK";
  };
  const std::string plain = "T(IN := X, PT := T#50us * P);";
  std::mt19937_64 engine(7);
  std::vector<std::vector<double>> rows;
  std::vector<double> row{0, 0, 3};
  for (int i = 0; i < 3000; ++i) {
    row = {engine() % 5 == 0 ? 1 - row[0] : row[0], static_cast<double>(engine() % 2),
           engine() % 40 == 0 ? static_cast<double>(engine() % 9) : row[2]};
    rows.push_back(row);
  }
  for (const std::string type : {"TON", "TOF", "TP"}) {
    for (const std::string ts : {"50us", "10ms", "70us"}) {
      const auto once = run_body(body(ts, type, plain), rows);
      const auto twice = run_body(body(ts, type, "IF B THEN " + plain + " ELSE " + plain + " END_IF;"), rows);
      for (std::size_t k = 0; k < rows.size(); ++k) {
        ASSERT_EQ(once[2 * k], twice[2 * k]) << type << " at " << ts << ", step " << k;
        ASSERT_NEAR(once[2 * k + 1], twice[2 * k + 1], 1e-12) << type << " at " << ts << ", step " << k;
      }
    }
  }
  // Called again after a pause, it has counted on.
  const std::string paused =
      "FUNCTION_BLOCK F (* @ts 10ms *) VAR_INPUT B : BOOL; END_VAR VAR_OUTPUT Q : BOOL; END_VAR VAR T : TON; END_VAR\n"
      "IF B THEN T(IN := TRUE, PT := T#40ms); END_IF; Q := T.Q; END_FUNCTION_BLOCK";
  EXPECT_EQ(run_body(paused, {{0}, {1}, {0}, {0}, {0}, {1}, {0}}), (std::vector<double>{0, 0, 0, 0, 0, 1, 1}));
  const std::string restarted =
      "FUNCTION_BLOCK F (* @ts 10ms *) VAR_INPUT B : BOOL; END_VAR VAR_OUTPUT Q : BOOL; END_VAR VAR T : TON; END_VAR\n"
      "IF B THEN T(IN := FALSE); END_IF; T(IN := TRUE, PT := T#20ms); Q := T.Q; END_FUNCTION_BLOCK";
  EXPECT_EQ(run_body(restarted, {{0}, {0}, {0}, {1}, {0}, {0}, {0}}), (std::vector<double>{0, 0, 1, 0, 0, 1, 1}));
}

TEST(Bodies, ABlockOfTheLibraryIsCalledOnceAndUnderNoCondition) {
  const auto with = [](const std::string& statements) {
    return "FUNCTION_BLOCK F (* @ts 1ms *) VAR_INPUT X : LREAL; B : BOOL; END_VAR VAR_OUTPUT Y : REAL; END_VAR\n"
           "VAR L : HY_GAIN; END_VAR\n" +
           statements + " END_FUNCTION_BLOCK";
  };
  EXPECT_EQ(faults_of(with("L(XIN := X, K := 2.0);")), Faults{});
  EXPECT_EQ(faults_of(with("IF B THEN L(XIN := X); END_IF;")), Faults{"218:3"});
  EXPECT_EQ(faults_of(with("IF B THEN RETURN; END_IF;\nL(XIN := X);")), Faults{"218:4"});
  EXPECT_EQ(faults_of(with("L(XIN := X);\nL(XIN := X);")), Faults{"205:4"});
}

TEST(Bodies, DurationsAreWholeMilliseconds) {
  double time = 0.0;
  for (const auto& [text, expected] :
       {std::pair{"1m30s", 90000.0}, {"5.5ms", 5.5}, {"-2h", -7200000.0}, {"50us", 0.05}, {"1d_2h", 93600000.0}}) {
    ASSERT_TRUE(language::milliseconds_of_time(text, time)) << text;
    EXPECT_EQ(time, expected) << text;
  }
  for (const auto* text : {"", "5", "s", "1s1m", "1.5m2s", "3x", "-"}) {
    EXPECT_FALSE(language::milliseconds_of_time(text, time)) << text;
  }
}

}  // namespace
}  // namespace hysteron::testing
