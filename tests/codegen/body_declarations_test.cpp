// What sequential bodies declare: subranges, constants of the file, structures at the border; and the ranges of memory.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "codegen/compile.hpp"
#include "codegen/interpreter/machine.hpp"
#include "support/errors.hpp"
#include "tests/codegen/refusal.hpp"

namespace hysteron::testing {
namespace {

/// The outputs of the last step, for inputs by row.
std::vector<double> last_of(const std::string& text, const std::vector<std::vector<double>>& rows) {
  const Program program = compile_text(text);
  Machine<double> machine(program, 0.01);
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      machine.set_input(i, row[i]);
    }
    machine.step();
  }
  std::vector<double> results;
  for (std::size_t i = 0; i < program.graph.outputs.size(); ++i) {
    results.push_back(machine.output(i));
  }
  return results;
}

std::vector<std::string> names_of(const auto& ports) {
  std::vector<std::string> names;
  for (const auto& one : ports) {
    names.emplace_back(one.name);
  }
  return names;
}

/// What is said of a text, the first time: its cause.
std::string said(const std::string& text) {
  const auto told = refusals(text);
  return told.empty() ? std::string() : told.front().cause;
}

TEST(BodyDeclarations, ASubrangeIsItsTypeAndBeginsAtItsLowestNumber) {
  const std::string text =
      "TYPE PERCENT : INT (0..100); END_TYPE\n"
      "FUNCTION_BLOCK F VAR_INPUT X : DINT (-5..5); P : PERCENT; END_VAR\n"
      "VAR_OUTPUT Y : INT; Z : SINT (3..9); END_VAR\n"
      "Y := P + 1; IF X > 4 THEN Z := 7; END_IF; END_FUNCTION_BLOCK";
  EXPECT_EQ(last_of(text, {{0, 41}}), (std::vector<double>{42, 3}));
  EXPECT_EQ(last_of(text, {{5, 300}}), (std::vector<double>{301, 7})) << "nothing limits a number when it runs";
  const Program program = compile_text(text);
  EXPECT_EQ(program.graph.inputs[0].minimum, -5.0);
  EXPECT_EQ(program.graph.inputs[1].maximum, 100.0);
  Diagnostics found;
  check(std::make_shared<const language::SourceFile>(language::parse("t", text, found)), found);
  ASSERT_EQ(found.all().size(), 1U) << "Z alone has no value of its own, and no 0";
  EXPECT_EQ(found.all()[0].number, error::other_meaning_elsewhere);
  EXPECT_EQ(found.all()[0].mend, "Give it its value: := 3.");
  const auto whole = [](const std::string& statement) {
    return said("FUNCTION_BLOCK F (* @body *) VAR_OUTPUT Y : INT (1..4) := 2; END_VAR " + statement +
                " END_FUNCTION_BLOCK");
  };
  EXPECT_EQ(whole("Y := 4;"), "");
  EXPECT_EQ(whole("Y := 5;"), "'Y' has the subrange 1..4, which has no 5");
  EXPECT_EQ(said("FUNCTION_BLOCK F VAR_OUTPUT Y : INT (4..1); END_VAR Y := 4; END_FUNCTION_BLOCK"),
            "the upper bound of this subrange, 1, is below the lower one, 4");
  EXPECT_EQ(said("FUNCTION_BLOCK F VAR_OUTPUT Y : USINT (0..300); END_VAR Y := 4; END_FUNCTION_BLOCK"),
            "USINT does not hold the subrange 0..300");
}

/// TwinCAT writes the type before each value; the third edition of the standard a type before the list.
TEST(BodyDeclarations, AnArmOfACaseNamesAValueWithItsType) {
  const std::string text =
      "TYPE MODE : INT (OFF := 0, HAND := 10, AUTO := 20); END_TYPE\n"
      "FUNCTION_BLOCK F VAR_INPUT M : MODE; END_VAR VAR_OUTPUT Y : INT; END_VAR\n"
      "CASE M OF MODE.OFF: Y := 1; MODE.HAND, MODE#AUTO: Y := 2; ELSE Y := 3; END_CASE; END_FUNCTION_BLOCK";
  EXPECT_EQ(last_of(text, {{0}}), (std::vector<double>{1}));
  EXPECT_EQ(last_of(text, {{10}}), (std::vector<double>{2}));
  EXPECT_EQ(last_of(text, {{20}}), (std::vector<double>{2}));
  EXPECT_EQ(last_of(text, {{21}}), (std::vector<double>{3}));
}

TEST(BodyDeclarations, ConstantsOfTheFileAreConstantsOfEachBlock) {
  const std::string constants =
      "VAR_GLOBAL CONSTANT ZONES : INT := 3; GAIN : REAL := 1.5; TWICE : REAL := GAIN * 2.0;\n"
      "LEVELS : ARRAY[1..3] OF INT := [10, 20, 30]; END_VAR\n";
  const std::string text =
      constants +
      "FUNCTION SCALED : REAL VAR_INPUT X : REAL; END_VAR SCALED := X * TWICE; END_FUNCTION\n"
      "FUNCTION_BLOCK F VAR_INPUT X : ARRAY[1..ZONES] OF REAL; END_VAR VAR_OUTPUT Y : REAL; N : INT; END_VAR\n"
      "VAR_EXTERNAL CONSTANT GAIN : REAL; END_VAR VAR I : INT; END_VAR\n"
      "Y := 0.0; N := 0; FOR I := 1 TO ZONES DO Y := Y + SCALED(X[I]) * GAIN; N := N + LEVELS[I]; END_FOR;\n"
      "END_FUNCTION_BLOCK";
  EXPECT_EQ(last_of(text, {{1, 2, 3}}), (std::vector<double>{27, 60}));
  // One of its own is meant before that of the file.
  EXPECT_EQ(
      last_of(constants + "FUNCTION_BLOCK F VAR CONSTANT GAIN : REAL := 7.0; END_VAR VAR_OUTPUT Y : REAL; END_VAR\n"
                          "Y := GAIN; END_FUNCTION_BLOCK",
              {{}}),
      (std::vector<double>{7}));
  EXPECT_EQ(
      said(constants + "FUNCTION_BLOCK F VAR_OUTPUT Y : INT; END_VAR LEVELS[1] := 4; Y := ZONES; END_FUNCTION_BLOCK"),
      "'LEVELS_1' cannot be assigned to");
  const auto number = [](const std::string& whole) {
    const auto told = refusals(whole);
    return told.empty() ? 0 : told.front().number;
  };
  EXPECT_EQ(
      number("VAR_GLOBAL N : INT; END_VAR FUNCTION_BLOCK F VAR_OUTPUT Y : INT; END_VAR Y := N; END_FUNCTION_BLOCK"),
      error::refused_section);
  EXPECT_EQ(
      number("FUNCTION_BLOCK F VAR_OUTPUT Y : INT; END_VAR VAR_EXTERNAL N : INT; END_VAR Y := N; END_FUNCTION_BLOCK"),
      error::refused_section);
}

TEST(BodyDeclarations, AStructureAtTheBorderIsItsMembers) {
  const std::string types =
      "TYPE AXIS : STRUCT POS : LREAL := 2.0; ON : BOOL; LIMITS : ARRAY[0..1] OF LREAL := [-1.0, 1.0]; END_STRUCT;\n"
      "PAIR : STRUCT A : AXIS; N : ARRAY[1..2] OF AXIS; END_STRUCT; END_TYPE\n";
  const std::string block =
      "FUNCTION_BLOCK MOVE VAR_INPUT TARGET : AXIS; END_VAR VAR_IN_OUT S : AXIS; END_VAR VAR_OUTPUT MOVED : AXIS; "
      "END_VAR\n"
      "MOVED := TARGET; MOVED.POS := LIMIT(TARGET.LIMITS[0], TARGET.POS, TARGET.LIMITS[1]); S.POS := S.POS + 1.0;\n"
      "END_FUNCTION_BLOCK\n";
  const Program program = compile_text(types + block);
  EXPECT_EQ(names_of(program.graph.inputs),
            (std::vector<std::string>{"TARGET_POS", "TARGET_ON", "TARGET_LIMITS[0]", "TARGET_LIMITS[1]", "S_POS",
                                      "S_ON", "S_LIMITS[0]", "S_LIMITS[1]"}));
  EXPECT_EQ(names_of(program.graph.outputs),
            (std::vector<std::string>{"S_POS_OUT", "S_ON_OUT", "S_LIMITS_OUT[0]", "S_LIMITS_OUT[1]", "MOVED_POS",
                                      "MOVED_ON", "MOVED_LIMITS[0]", "MOVED_LIMITS[1]"}));
  EXPECT_EQ(program.graph.inputs[0].preset, 2.0);
  EXPECT_EQ(last_of(types + block, {{5, 1, -3, 3, 7, 0, 8, 9}}), (std::vector<double>{8, 0, 8, 9, 3, 1, -3, 3}));
  // A diagram wires the members, and a vector in it as a whole; another body names them as the text does.
  const std::string diagram =
      "FUNCTION_BLOCK TOP VAR_INPUT X : LREAL; END_VAR VAR_OUTPUT Y : LREAL; L : ARRAY[0..1] OF LREAL; END_VAR VAR M : "
      "MOVE; "
      "END_VAR\nM(TARGET_POS := X, TARGET_LIMITS := [-4.0, 4.0]); Y := M.MOVED_POS; L := M.MOVED_LIMITS; "
      "END_FUNCTION_BLOCK";
  EXPECT_EQ(last_of(types + block + diagram, {{9}}), (std::vector<double>{4, -4, 4}));
  const std::string nested =
      "FUNCTION_BLOCK N VAR_INPUT P : PAIR; END_VAR VAR_OUTPUT Y : LREAL; END_VAR VAR M : MOVE; T : AXIS; END_VAR\n"
      "M(TARGET := P.N[2], S := T); Y := M.MOVED.POS + P.A.POS; END_FUNCTION_BLOCK";
  const Program inner = compile_text(types + block + nested);
  EXPECT_EQ(inner.graph.inputs.size(), 12U);
  EXPECT_EQ(inner.graph.inputs[8].name, "P_N_2_POS");
  EXPECT_EQ(said(types + "FUNCTION_BLOCK F VAR_INPUT A : AXIS; A_ON : BOOL; END_VAR VAR_OUTPUT Y : BOOL; END_VAR\n"
                         "Y := A.ON; END_FUNCTION_BLOCK"),
            "'A_ON' is declared twice");
  EXPECT_EQ(said("FUNCTION_BLOCK F VAR_INPUT T : TON; END_VAR VAR_OUTPUT Y : INT; END_VAR Y := 1; END_FUNCTION_BLOCK"),
            "'T' at the border of the block is an instance, or has one in it");
}

/// What is assigned and read in one block is its memory, one for all that it calls; what nothing assigns, a constant.
TEST(BodyDeclarations, AGlobalThatClosesWithinTheTextIsMemoryOrAConstant) {
  const std::string text =
      "VAR_GLOBAL GAIN : REAL := 2.0; LAST : REAL := 1.5; N : INT := 2; UNUSED : REAL; C : INT := 40; END_VAR\n"
      "VAR_GLOBAL RETAIN COUNT : INT; END_VAR\n"
      "FUNCTION SCALED : REAL VAR_INPUT X : REAL; END_VAR SCALED := GAIN * X; COUNT := COUNT + 1; END_FUNCTION\n"
      "FUNCTION_BLOCK STAGE VAR_INPUT X : REAL; END_VAR VAR_OUTPUT Y : REAL; END_VAR VAR C : INT; END_VAR\n"
      "C := C + 1; COUNT := COUNT + 1; Y := SCALED(X); END_FUNCTION_BLOCK\n"
      "FUNCTION_BLOCK TOP VAR_INPUT X : REAL; END_VAR VAR_EXTERNAL COUNT : INT; LAST : REAL; END_VAR\n"
      "VAR_OUTPUT Y, D, A : REAL; K : INT; END_VAR VAR S, T : STAGE; L : ARRAY[1..N] OF REAL; END_VAR\n"
      "S(X := X); T(X := S.Y); IF T.Y > 30.0 THEN COUNT := C; END_IF; D := X - LAST; LAST := X;\n"
      "L[2] := T.Y; A := L[N]; Y := T.Y; K := COUNT; END_FUNCTION_BLOCK";
  EXPECT_EQ(last_of(text, {{2}}), (std::vector<double>{8, 0.5, 8, 4}));
  EXPECT_EQ(last_of(text, {{2}, {3}, {4}}), (std::vector<double>{16, 1, 16, 12}));
  EXPECT_EQ(last_of(text, {{2}, {9}, {4}}), (std::vector<double>{16, -5, 16, 44}));
  // A variable of the block of the same name is another, also where a loop's rounds follow from its range.
  EXPECT_EQ(
      last_of("VAR_GLOBAL N : INT := 30; END_VAR FUNCTION G : INT VAR_INPUT X : INT; END_VAR\n"
              "G := N + X; N := G; END_FUNCTION FUNCTION_BLOCK F VAR_OUTPUT S : INT; T : INT; END_VAR VAR N : INT; I : "
              "INT; END_VAR\n"
              "IF N < 3 THEN N := N + 1; END_IF; S := 0; FOR I := 1 TO N DO S := S + 1; END_FOR; T := G(S); "
              "END_FUNCTION_BLOCK",
              {{}, {}}),
      (std::vector<double>{2, 33}));
}

TEST(BodyDeclarations, AGlobalThatIsAWireIsRefusedWithItsPin) {
  const auto told = [](const std::string& text) {
    const auto all = refusals(text);
    return all.empty() ? std::string() : all.front().cause + " / " + all.front().mend;
  };
  const std::string g = "FUNCTION_BLOCK G (* @body *) VAR_OUTPUT Y : INT; END_VAR ";
  const std::string f = "FUNCTION_BLOCK F (* @body *) VAR_OUTPUT Y : INT; END_VAR ";
  const std::string end = " END_FUNCTION_BLOCK\n";
  const std::string n = "VAR_GLOBAL N : INT; END_VAR ";
  EXPECT_EQ(told(n + f + "Y := N;" + end),
            "the global variable 'N' is read, and nothing in this file gives it a value / Make it a VAR_INPUT of F; "
            "where it is a constant, give it its value: N : INT := …;");
  EXPECT_EQ(told(n + f + "Y := 1; N := Y;" + end),
            "the global variable 'N' is assigned, and nothing in this file reads it / Make it a VAR_OUTPUT of F.");
  EXPECT_EQ(
      told(n + g + "N := 1; Y := 2;" + end + f + "Y := N;" + end),
      "the global variable 'N' joins F and G / Hand it over: a VAR_OUTPUT of the one that assigns it, a VAR_INPUT "
      "of the other.");
  const std::string counts = n + f + "N := N + 1; Y := N;" + end;
  EXPECT_EQ(told(counts), "");
  const std::string top = "FUNCTION_BLOCK TOP VAR_OUTPUT A, B : DINT; END_VAR VAR F1, F2 : F; END_VAR\n";
  EXPECT_EQ(told(counts + "FUNCTION_BLOCK ONE VAR_OUTPUT A : DINT; END_VAR VAR F1 : F; END_VAR F1(); A := F1.Y;" + end),
            "");
  EXPECT_EQ(told(counts + top + "F1(); F2(); A := F1.Y; B := F2.Y;" + end),
            "the global variable 'N' joins the instances F1 and F2 / Each has a memory of its own: put the variable "
            "into their block, or hand it over as input and output.");
  EXPECT_EQ(told("VAR_GLOBAL T : TON; END_VAR " + f + "T(IN := TRUE, PT := T#1s); Y := 1;" + end),
            "the global variable 'T' is an instance / Declare it between VAR and END_VAR of F.");
}

const std::string points =
    "TYPE POINT : STRUCT X : REAL; Y : REAL := 2.0; N : INT; END_STRUCT; ROW : ARRAY[0..2] OF REAL; END_TYPE\n"
    "FUNCTION MAKE : POINT VAR_INPUT A : REAL; END_VAR MAKE.X := A; MAKE.N := MAKE.N + 1; END_FUNCTION\n"
    "FUNCTION MOVED : POINT VAR_INPUT P : POINT; D : REAL; END_VAR VAR_OUTPUT OLD : POINT; END_VAR\n"
    "OLD := P; MOVED := P; MOVED.X := P.X + D; IF P.X > 3.0 THEN RETURN; END_IF; MOVED.Y := P.Y * 2.0; END_FUNCTION\n"
    "FUNCTION SUM_OF : REAL VAR_INPUT P : POINT; END_VAR SUM_OF := P.X + P.Y; END_FUNCTION\n"
    "FUNCTION THREE : ROW VAR_INPUT A : REAL; END_VAR VAR I : INT; END_VAR\n"
    "FOR I := 0 TO 2 DO THREE[I] := A * INT_TO_REAL(I); END_FOR; END_FUNCTION\n"
    "FUNCTION_BLOCK KEEP VAR_INPUT P : POINT; END_VAR VAR_OUTPUT Q : POINT; END_VAR\n"
    "Q.X := Q.X + P.X; Q.Y := P.Y; END_FUNCTION_BLOCK\n";

/// Its statements in a block beside those points, with inputs A and K.
std::string with_points(const std::string& statements) {
  return points +
         "FUNCTION_BLOCK F (* @body *) VAR_INPUT A : REAL; K : INT; END_VAR VAR_OUTPUT Y, Z : REAL; END_VAR\n"
         "VAR P, Q : POINT; R : ROW; L : ARRAY[0..3] OF POINT; I : KEEP; END_VAR\n" +
         statements + " END_FUNCTION_BLOCK";
}

/// A FUNCTION gives all of a structure or an array: to a variable, an input, or another FUNCTION.
TEST(BodyDeclarations, AFunctionGivesAStructure) {
  using Values = std::vector<double>;
  const auto of = [](const std::string& statements, const std::vector<std::vector<double>>& rows) {
    return last_of(with_points(statements), rows);
  };
  EXPECT_EQ(of("P := MAKE(A); Y := P.X + P.Y; Z := P.N;", {{5, 0}, {5, 0}}), (Values{7, 1})) << "begins anew";
  EXPECT_EQ(of("P := MOVED(MOVED(MAKE(A), D := 0.5), 1.0, OLD => Q); Y := P.X + 10 * P.Y; Z := Q.X;", {{1, 0}}),
            (Values{2.5 + 80, 1.5}));
  EXPECT_EQ(of("P := MOVED(MAKE(A), 1.0); Y := P.X; Z := P.Y;", {{4, 0}}), (Values{5, 2})) << "behind its RETURN";
  EXPECT_EQ(of("IF SUM_OF(MAKE(A)) > 3.0 THEN Y := SUM_OF(MOVED(D := 1.0, P := MAKE(A))); END_IF; Z := 1.0;", {{2, 0}}),
            (Values{7, 1}));
  EXPECT_EQ(of("R := THREE(A); Y := R[0] + R[1] + 10 * R[2];", {{3, 0}}), (Values{63, 0}));
  EXPECT_EQ(of("I(P := MAKE(A), Q => L[K]); Y := L[2].X; Z := L[2].Y;", {{3, 2}, {4, 2}, {5, 1}}), (Values{7, 2}));
}

/// Where the index is known only when it runs, all of the element is meant.
TEST(BodyDeclarations, AnElementIsAWhole) {
  using Values = std::vector<double>;
  const auto of = [](const std::string& statements, const std::vector<std::vector<double>>& rows) {
    return last_of(with_points(statements), rows);
  };
  EXPECT_EQ(of("P.X := A; L[K] := P; Y := L[1].X; Z := L[2].X;", {{5, 1}, {6, 2}}), (Values{5, 6}));
  EXPECT_EQ(of("L[K] := MAKE(A); P := L[K - 1]; Y := P.X; Z := SUM_OF(L[K]);", {{5, 1}, {6, 2}}), (Values{5, 8}));
  EXPECT_EQ(of("L[K].X := A; I(P := L[K]); L[K] := L[0]; Y := I.Q.X; Z := L[2].X;", {{5, 0}, {6, 2}}), (Values{11, 5}));
}

/// An index that runs chooses the instance that is called, and the variable that a VAR_IN_OUT stands for.
TEST(BodyDeclarations, AnIndexChoosesWhatIsCalledAndHandedOver) {
  using Values = std::vector<double>;
  const std::string units =
      "TYPE PUMP : STRUCT RUNS : BOOL; STARTS : INT; END_STRUCT; END_TYPE\n"
      "FUNCTION_BLOCK DRIVE VAR_INPUT GO : BOOL; END_VAR VAR_IN_OUT P : PUMP; N : INT; END_VAR VAR_OUTPUT CALLS : INT; "
      "END_VAR VAR UP : R_TRIG; END_VAR\n"
      "UP(CLK := GO); P.RUNS := GO; IF UP.Q THEN P.STARTS := P.STARTS + 1; END_IF; CALLS := CALLS + 1; N := N + 10; "
      "END_FUNCTION_BLOCK\n"
      "FUNCTION ADDED : INT VAR_IN_OUT X : INT; END_VAR X := X + 1; ADDED := X; END_FUNCTION\n";
  const std::string text =
      units +
      "FUNCTION_BLOCK F (* @ts 10ms *) VAR_INPUT K : INT; GO : BOOL; END_VAR VAR_OUTPUT A, B, C, D, E : INT; Q : BOOL; "
      "END_VAR\n"
      "VAR DRIVES : ARRAY[0..2] OF DRIVE; P : ARRAY[0..2] OF PUMP; N : ARRAY[1..2] OF INT; T : ARRAY[0..2] OF TON; "
      "END_VAR\n"
      "DRIVES[K](GO := GO, P := P[2 - K], N := N[K], CALLS => A); T[K](IN := GO, PT := T#15ms, Q => Q);\n"
      "B := P[0].STARTS + 10 * P[1].STARTS + 100 * P[2].STARTS; C := N[1]; D := N[2]; E := ADDED(X := N[K + 1]);\n"
      "END_FUNCTION_BLOCK";
  EXPECT_EQ(last_of(text, {{0, 1}}), (Values{1, 100, 10, 0, 11, 0}));
  EXPECT_EQ(last_of(text, {{0, 1}, {0, 0}, {0, 1}}), (Values{3, 200, 32, 0, 33, 0}));
  EXPECT_EQ(last_of(text, {{0, 1}, {1, 1}, {2, 0}}), (Values{1, 110, 21, 11, 12, 0}));
  EXPECT_EQ(last_of(text, {{1, 1}, {1, 1}, {1, 1}}), (Values{3, 10, 30, 2, 3, 1})) << "each timer has its own time";
}

/// Kept as an INT where nothing is said, or in the type that is said; it takes any whole number.
TEST(BodyDeclarations, AnEnumerationHasTheTypeItIsKeptIn) {
  const std::string text =
      "TYPE MODE : (OFF, ON, FAULT := 99) UINT; STAGE : (FIRST, SECOND); LARGE : (LITTLE, MUCH := 100000); END_TYPE\n"
      "FUNCTION_BLOCK F VAR_INPUT N : DINT; END_VAR VAR_OUTPUT A : UINT; B : INT; C : DINT; END_VAR VAR M : MODE; S : "
      "STAGE; L : LARGE; END_VAR\n"
      "M := MODE.FAULT; S := N; L := MUCH; IF S = SECOND THEN M := ON; END_IF; A := M; B := S; C := L; "
      "END_FUNCTION_BLOCK";
  EXPECT_EQ(last_of(text, {{5}}), (std::vector<double>{99, 5, 100000}));
  EXPECT_EQ(last_of(text, {{1}}), (std::vector<double>{1, 1, 100000}));
}

/// The standard's blocks have other names for some pins in CODESYS and TwinCAT.
TEST(BodyDeclarations, PinsOfTheStandardHaveTwoNames) {
  const std::string text =
      "FUNCTION_BLOCK F VAR_INPUT U, D, R : BOOL; END_VAR VAR_OUTPUT N : INT; Q1, Q2 : BOOL; END_VAR VAR C : CTUD; S : "
      "SR; T : RS; END_VAR\n"
      "IF TRUE THEN C(CU := U, CD := D, RESET := R, LOAD := FALSE, PV := 5); S(SET1 := U, RESET := R); T(SET := U, "
      "RESET1 "
      ":= R); END_IF;\n"
      "N := C.CV; Q1 := S.Q1; Q2 := T.Q1; END_FUNCTION_BLOCK";
  EXPECT_EQ(last_of(text, {{1, 0, 0}, {0, 0, 0}, {1, 0, 0}}), (std::vector<double>{2, 1, 1}));
  EXPECT_EQ(last_of(text, {{1, 0, 0}, {0, 0, 1}}), (std::vector<double>{0, 0, 0}));
}

TEST(BodyDeclarations, AWholeThatIsMeantAsOneValueIsRefused) {
  const auto told = [](const std::string& statements) {
    const auto all = refusals(with_points(statements));
    return all.empty() ? std::string() : all.front().cause + " / " + all.front().mend;
  };
  EXPECT_EQ(told("Y := MAKE(A) + 1.0;"),
            "MAKE gives no single value / Assign all of it first: X := MAKE( … ), with X of the same type; then read a "
            "member or an element of X.");
  EXPECT_EQ(told("Y := MAKE(A).X;"),
            "A part is taken of what MAKE gives. / Assign all of it first: X := MAKE( … ), with X of the same type; "
            "then read the part of X.");
  EXPECT_EQ(told("Y := MAKE(A);"), "'Y' and 'MAKE' are not of one type / Take one of its members or elements.");
  EXPECT_EQ(told("P := THREE(A);"),
            "'P' and 'THREE' are not of one type / Copy an array or a structure into one of the same type.");
  EXPECT_EQ(told("Y := SUM_OF(1.0);"),
            "here is one value, where an array or a structure is expected / Write a variable of that type, or a "
            "FUNCTION that gives one.");
  EXPECT_EQ(told("P := I;"),
            "'P' and 'I' are not of one type / Copy an array or a structure into one of the same type.");
}

/// A counter that a condition holds back stays where it is held, step after step: its loop ends.
TEST(BodyDeclarations, MemoryStaysWhereEveryStepLeavesIt) {
  const auto average = [](const std::string& counting) {
    return "FUNCTION_BLOCK F VAR_INPUT X : INT; GO : BOOL; END_VAR VAR_OUTPUT Y : INT; END_VAR\n"
           "VAR CONSTANT N : INT := 4; END_VAR VAR A : ARRAY[1..4] OF INT; C, I : INT; PLACE : INT := 1; END_VAR\n" +
           counting +
           "A[PLACE] := X; PLACE := PLACE + 1; IF PLACE > N THEN PLACE := 1; END_IF;\n"
           "Y := 0; FOR I := 1 TO C DO Y := Y + A[I]; END_FOR; END_FUNCTION_BLOCK";
  };
  const std::string held = average("IF C < N THEN C := C + 1; END_IF;\n");
  EXPECT_EQ(last_of(held, {{1, 0}, {2, 0}, {4, 0}}), (std::vector<double>{7}));
  EXPECT_EQ(last_of(held, {{1, 0}, {2, 0}, {4, 0}, {8, 0}, {16, 0}, {32, 0}}), (std::vector<double>{60}));
  EXPECT_EQ(said(average("IF GO THEN C := 0; ELSIF C <> N THEN C := MIN(C + 1, N); END_IF;\n")), "");
  EXPECT_EQ(said(average("IF GO THEN C := C + 1; END_IF;\n")), "this FOR may have 32767 rounds, more than 10000")
      << "nothing holds this one";
  EXPECT_EQ(said(average("IF C < N THEN C := C + X; END_IF;\n")), "this FOR may have 32767 rounds, more than 10000");
  const auto told = refusals(average("C := X;\n"));
  ASSERT_FALSE(told.empty());
  EXPECT_EQ(told.front().mend, "Bound it by what there can be: FOR I := … TO LIMIT(0, C, 32) DO.");
}

TEST(BodyDeclarations, ALoopOverTheBitsOfAWordEnds) {
  const std::string text =
      "FUNCTION_BLOCK F VAR_INPUT W : WORD; N : INT; END_VAR VAR_OUTPUT ONES : INT; TURNED : WORD; END_VAR VAR T : "
      "WORD; "
      "END_VAR\nT := W; ONES := 0; WHILE T <> 0 DO IF T.0 THEN ONES := ONES + 1; END_IF; T := SHR(T, 1); END_WHILE;\n"
      "TURNED := ROL(W, N); END_FUNCTION_BLOCK";
  EXPECT_EQ(last_of(text, {{0xF001, 4}}), (std::vector<double>{5, 0x001F}));
  EXPECT_EQ(last_of(text, {{0x8001, 0}}), (std::vector<double>{2, 0x8001}));
  EXPECT_EQ(last_of(text, {{0x8001, 17}}), (std::vector<double>{2, 0x0003})) << "a word is a ring";
}

}  // namespace
}  // namespace hysteron::testing
