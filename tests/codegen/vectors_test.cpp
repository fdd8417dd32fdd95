// Vectors of diagrams: what is refused, and that a diagram with vectors has the bits of the one that writes its
// elements out.
#include "codegen/graph/vectors.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <random>
#include <string>
#include <vector>

#include "codegen/backends/c_family/names.hpp"
#include "codegen/compile.hpp"
#include "codegen/interpreter/machine.hpp"
#include "codegen/parameters/apply.hpp"
#include "codegen/parameters/parameter_file.hpp"
#include "support/errors.hpp"

namespace hysteron::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Each as "HY221 3:8 cause".
std::vector<std::string> vector_faults(const std::string& text) {
  Diagnostics diagnostics;
  auto parsed = language::parse("test.st", text, diagnostics);
  if (!diagnostics.has_errors()) {
    check(std::make_shared<const language::SourceFile>(std::move(parsed)), diagnostics);
  }
  std::vector<std::string> list;
  for (const Diagnostic& one : diagnostics.all()) {
    EXPECT_FALSE(one.mend.empty()) << one.cause;
    list.push_back(fmt::format("HY{} {}:{} {}", one.number, one.place.line, one.place.column, one.cause));
  }
  return list;
}

/// Over X, Z of three, W of two, S, B and K.
std::vector<std::string> faults_of(const std::string& statements, const std::string& locals = "") {
  return vector_faults(
      "FUNCTION_BLOCK T (* @ts 1ms *) VAR CONSTANT N : DINT := 3; C : LREAL := 1.0; END_VAR "
      "VAR_INPUT X, Z : ARRAY[0..N - 1] OF LREAL; W : ARRAY[0..1] OF LREAL; S : LREAL; K : DINT; B : BOOL; END_VAR "
      "VAR_OUTPUT Y : ARRAY[0..2] OF LREAL; R : LREAL; END_VAR VAR " +
      locals + " END_VAR\n" + statements + "\nEND_FUNCTION_BLOCK\n");
}

TEST(Vectors, AreReadAndWiredWithoutAFault) {
  EXPECT_THAT(faults_of("Y := X + Z * 2.0; R := SUM(X) + DOT(X, Z) + NORM(W) + X[N - 1] + X[0];"), IsEmpty());
  EXPECT_THAT(faults_of("Y[0] := S; Y[2] := W[1]; Y[1] := X[1]; R := S;"), IsEmpty());
  EXPECT_THAT(faults_of("Y := SEL(B, -X, MIN(X, S, Z)); R := 1.0;"), IsEmpty());
  EXPECT_THAT(
      faults_of("V := X > Z; Y := [SEL(V[0], 0.0, 1.0), S, DINT_TO_LREAL(K)]; R := S;", "V : ARRAY[0..2] OF BOOL;"),
      IsEmpty());
}

TEST(Vectors, OfWrongSizesAreRefusedByTheirSizes) {
  EXPECT_THAT(faults_of("Y := X + W; R := S;"), ElementsAre("HY220 2:6 vectors of 3 and of 2 elements stand together"));
  EXPECT_THAT(faults_of("Y := W; R := S;"), ElementsAre("HY220 2:6 'Y' has 3 elements, the value has 2"));
  EXPECT_THAT(faults_of("Y := [S, S]; R := DOT(X, W);"),
              ElementsAre("HY220 2:6 'Y' has 3 elements, the value has 2",
                          "HY220 2:19 vectors of 3 and of 2 elements stand together"));
  EXPECT_THAT(faults_of("Y := MAX(X, W); R := S;"),
              ElementsAre("HY220 2:6 vectors of 3 and of 2 elements stand together"));
}

TEST(Vectors, AnIndexOutsideOrNotConstantIsRefusedByItsRange) {
  EXPECT_THAT(faults_of("Y := X; R := X[3];"), ElementsAre("HY221 2:16 'X' has the elements 0 to 2, not 3"));
  EXPECT_THAT(faults_of("Y := X; R := X[-1];"), ElementsAre("HY221 2:16 'X' has the elements 0 to 2, not -1"));
  EXPECT_THAT(faults_of("Y := X; R := X[K];"), ElementsAre("HY221 2:16 the index of 'X' is not a whole constant"));
  EXPECT_THAT(faults_of("Y := X; R := X[C];"), ElementsAre("HY221 2:16 the index of 'X' is not a whole constant"));
  EXPECT_THAT(faults_of("Y := X; R := S[0];"), ElementsAre("HY221 2:16 'S' is no vector and has no elements"));
  EXPECT_THAT(faults_of("Y[7] := S; R := S;"), ElementsAre("HY221 2:3 'Y' has the elements 0 to 2, not 7"));
}

TEST(Vectors, OneValueAndAVectorAreNotMistakenForEachOther) {
  EXPECT_THAT(faults_of("Y := 0.0; R := S;"), ElementsAre("HY222 2:6 'Y' takes a vector of 3, here is one value"));
  EXPECT_THAT(faults_of("Y := X; R := Z;"), ElementsAre("HY225 2:14 'R' takes one value, here is a vector of 3"));
  EXPECT_THAT(faults_of("Y[1] := X; R := S;"), ElementsAre("HY225 2:9 'Y[1]' takes one value, here is a vector of 3"));
  EXPECT_THAT(faults_of("Y := X; R := SUM(S);"), ElementsAre("HY222 2:18 SUM takes a vector, here is one value"));
  EXPECT_THAT(faults_of("Y := X; R := SEL(X = Z, 0.0, 1.0);")[0], HasSubstr("HY225 2:18 whether vectors are equal"));
  EXPECT_THAT(faults_of("G(XIN := X); Y := X; R := G.XOUT;", "G : HY_GAIN;"),
              ElementsAre("HY225 2:10 G.XIN takes one value, here is a vector of 3"));
  EXPECT_THAT(faults_of("Y := [X, Z, S]; R := S;"),
              ElementsAre("HY225 2:7 An element of a list takes one value, here is a vector of 3"));
}

TEST(Vectors, BoundsAreWholeConstantsFromZero) {
  EXPECT_THAT(faults_of("V := X; Y := X; R := S;", "V : ARRAY[0..K] OF LREAL;")[0],
              HasSubstr("HY223 1:264 the bounds of the vector 'V' are not whole constants"));
  EXPECT_THAT(faults_of("Y := X; R := S;", "V : ARRAY[0..256] OF LREAL;")[0], HasSubstr("has 257 elements"));
  EXPECT_THAT(faults_of("Y := X; R := S;", "V : ARRAY[0..-1] OF LREAL;")[0], HasSubstr("ends at -1"));
}

/// A name that is not declared has its own error, and no other.
TEST(Vectors, WhatIsNotDeclaredIsSaidOnce) {
  const std::string gain = "M : HY_MATRIX_GAIN := (K := [1.0, 2.0, 3.0, 4.0, 5.0, 6.0], ROWS := 2);";
  const auto one = [&](const std::string& statements) {
    const auto faults = faults_of(statements, gain);
    return faults.size() == 1 ? faults[0] : fmt::format("{} faults: {}", faults.size(), fmt::join(faults, "; "));
  };
  EXPECT_EQ(one("M(XIN := X); Y := X; R := SUM(M.OUT);"), "HY202 2:33 HY_MATRIX_GAIN has no output 'OUT'");
  EXPECT_EQ(one("M(XIN := X); Y := M.OUT; R := S;"), "HY202 2:21 HY_MATRIX_GAIN has no output 'OUT'");
  EXPECT_EQ(one("M(XIN := X); Y := X; R := M.OUT[0];"), "HY202 2:29 HY_MATRIX_GAIN has no output 'OUT'");
  EXPECT_EQ(one("M(XIN := X, KX := 1.0); Y := X; R := S;"), "HY202 2:13 HY_MATRIX_GAIN has no input 'KX'");
  EXPECT_EQ(one("M(XIN := X); Y := [Q, S, 1.0]; R := S;"), "HY203 2:20 'Q' is not declared");
  EXPECT_EQ(one("M(XIN := X); Y := X + Q * 2.0; R := S;"), "HY203 2:23 'Q' is not declared");
  EXPECT_EQ(one("M(XIN := X); Y := X; R := DOT(X, Q);"), "HY203 2:34 'Q' is not declared");
  EXPECT_EQ(one("M(XIN := X); Y := X; R := S; Q := X;"), "HY203 2:30 'Q' is not declared");
  EXPECT_EQ(one("M(XIN := X); Y := X; R := S; Q[1] := X[1];"), "HY203 2:30 'Q' is not declared");
}

TEST(Vectors, AFaultOfEveryElementIsToldOnce) {
  const auto undriven = faults_of("R := S;");
  ASSERT_EQ(undriven.size(), 1U);
  EXPECT_THAT(undriven[0], HasSubstr("HY206"));
  const auto twice = faults_of("Y := X; Y := Z; R := S;");
  ASSERT_EQ(twice.size(), 1U);
  EXPECT_THAT(twice[0], HasSubstr("HY205 2:9"));
}

TEST(Vectors, UnitsHoldForEachElement) {
  const auto found = vector_faults(
      "FUNCTION_BLOCK T (* @ts 1ms *)\nVAR_INPUT X : ARRAY[0..1] OF LREAL; (* @unit um *) END_VAR\n"
      "VAR_OUTPUT Y : ARRAY[0..1] OF LREAL; (* @unit V *) END_VAR\nY := X;\nEND_FUNCTION_BLOCK");
  ASSERT_FALSE(found.empty());
  EXPECT_THAT(found[0], HasSubstr("HY301"));
}

/// The outputs of a text over random inputs, one row after the other.
std::vector<double> outputs_of(const std::string& text, const std::string& top) {
  Machine<double> machine(compile_text(text, {.top = top}));
  const Graph& graph = machine.program().graph;
  std::mt19937_64 engine(7);
  std::vector<double> values;
  for (int k = 0; k < 300; ++k) {
    for (std::size_t i = 0; i < graph.inputs.size(); ++i) {
      const double number = static_cast<double>(engine() >> 11U) * 0x1p-52 - 1.0;
      machine.set_input(i, graph.inputs[i].type == Type::Bool ? static_cast<double>(number > 0.8) : number);
    }
    machine.step();
    for (std::size_t i = 0; i < graph.outputs.size(); ++i) {
      values.push_back(machine.output(i));
    }
  }
  return values;
}

void hold_equal(const std::string& vectors, const std::string& elements) {
  const auto a = outputs_of(vectors, "T");
  const auto b = outputs_of(elements, "T");
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(std::bit_cast<std::uint64_t>(a[i]), std::bit_cast<std::uint64_t>(b[i]))
        << i << ": " << a[i] << ", " << b[i];
  }
}

TEST(Vectors, HaveTheBitsOfTheirElementsWrittenOut) {
  hold_equal(R"(
FUNCTION_BLOCK SMOOTH
  VAR_INPUT U : ARRAY[0..2] OF LREAL; G : LREAL; END_VAR
  VAR_OUTPUT Y : ARRAY[0..2] OF LREAL; END_VAR
  VAR L0, L1, L2 : HY_LAG := (T1 := 0.01); END_VAR
  L0(XIN := U[0]); L1(XIN := U[1]); L2(XIN := U[2]);
  Y := [L0.XOUT, L1.XOUT, L2.XOUT] * G;
END_FUNCTION_BLOCK
FUNCTION_BLOCK T (* @ts 1ms *)
  VAR CONSTANT C : ARRAY[0..2] OF LREAL := [1.0, -2.0, 0.5]; END_VAR
  VAR_INPUT X : ARRAY[0..2] OF LREAL; S : LREAL; END_VAR
  VAR_OUTPUT Y : ARRAY[0..2] OF LREAL; R, Q, P : LREAL; B : ARRAY[0..2] OF BOOL; END_VAR
  VAR F : SMOOTH; V : ARRAY[0..2] OF LREAL; END_VAR
  V := X * C + S;
  F(U := V, G := 0.5);
  Y := MAX(F.Y, -X) - V / 3.0;
  R := SUM(X); Q := DOT(F.Y, C); P := NORM(V) + F.Y[1];
  B := X > F.Y;
END_FUNCTION_BLOCK)",
             R"(
FUNCTION_BLOCK T (* @ts 1ms *)
  VAR_INPUT X0, X1, X2, S : LREAL; END_VAR
  VAR_OUTPUT Y0, Y1, Y2, R, Q, P : LREAL; B0, B1, B2 : BOOL; END_VAR
  VAR L0, L1, L2 : HY_LAG := (T1 := 0.01); V0, V1, V2, F0, F1, F2 : LREAL; END_VAR
  V0 := X0 * 1.0 + S; V1 := X1 * (-2.0) + S; V2 := X2 * 0.5 + S;
  L0(XIN := V0); L1(XIN := V1); L2(XIN := V2);
  F0 := L0.XOUT * 0.5; F1 := L1.XOUT * 0.5; F2 := L2.XOUT * 0.5;
  Y0 := MAX(F0, -X0) - V0 / 3.0; Y1 := MAX(F1, -X1) - V1 / 3.0; Y2 := MAX(F2, -X2) - V2 / 3.0;
  R := X0 + X1 + X2;
  Q := F0 * 1.0 + F1 * (-2.0) + F2 * 0.5;
  P := SQRT(V0 * V0 + V1 * V1 + V2 * V2) + F1;
  B0 := X0 > F0; B1 := X1 > F1; B2 := X2 > F2;
END_FUNCTION_BLOCK)");
}

TEST(Vectors, PassTheBorderOfASequentialBody) {
  hold_equal(R"(
FUNCTION_BLOCK SORTED (* @body *)
  VAR_INPUT U : ARRAY[1..3] OF LREAL; END_VAR
  VAR_OUTPUT Y : ARRAY[1..3] OF LREAL; END_VAR
  VAR_TEMP I, J : INT; H : LREAL; END_VAR
  Y := U;
  FOR I := 1 TO 2 DO
    FOR J := 1 TO 2 DO
      IF Y[J] > Y[J + 1] THEN H := Y[J]; Y[J] := Y[J + 1]; Y[J + 1] := H; END_IF;
    END_FOR;
  END_FOR;
END_FUNCTION_BLOCK
FUNCTION_BLOCK T (* @ts 1ms *)
  VAR_INPUT X : ARRAY[0..2] OF LREAL; END_VAR
  VAR_OUTPUT Y : ARRAY[0..2] OF LREAL; END_VAR
  VAR F : SORTED; END_VAR
  F(U := X);
  Y := F.Y * 2.0;
END_FUNCTION_BLOCK)",
             R"(
FUNCTION_BLOCK T (* @ts 1ms *)
  VAR_INPUT A, B, C : LREAL; END_VAR
  VAR_OUTPUT LOW, MID_1, HIGH : LREAL; END_VAR
  LOW := MIN(A, B, C) * 2.0;
  MID_1 := MAX(MIN(A, B), MIN(MAX(A, B), C)) * 2.0;
  HIGH := MAX(A, B, C) * 2.0;
END_FUNCTION_BLOCK)");
}

TEST(Vectors, AreOneArrayOfATargetWhereTheyBeginAtZero) {
  const auto members = [](const std::string& bounds) {
    const Program program = compile_text("FUNCTION_BLOCK T (* @ts 1ms *) VAR_INPUT N : ARRAY[" + bounds +
                                         "] OF LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR\nIF N[0] > 0.0 THEN Y := "
                                         "1.0; END_IF; END_FUNCTION_BLOCK\n");
    return port_members(program.graph.inputs);
  };
  EXPECT_THAT(members("0..1"), ElementsAre("n[0]", "n[1]"));
  EXPECT_THAT(members("-1..1"), ElementsAre("n_m1", "n_0", "n_1"));
  EXPECT_THAT(members("-2..0"), ElementsAre("n_m2", "n_m1", "n_0"));
}

TEST(Vectors, AreLaidOutAndStayWhatTheyAre) {
  const std::string text =
      "FUNCTION_BLOCK T\n  VAR_INPUT\n    X : array [ 0 .. 2 ] of lreal;\n    LONGER : BOOL;\n  END_VAR\n  VAR_OUTPUT\n"
      "    Y : ARRAY[0..2] OF LREAL;\n    R : LREAL;\n  END_VAR\n\n  Y[ 0 ]:=X [1];Y[1]:=[X[0],1.0][ 0 "
      "];\nEND_FUNCTION_BLOCK\n";
  Diagnostics refused;
  format_text("t.st", text, refused);
  EXPECT_TRUE(refused.has_errors());  // a list has no index
  Diagnostics none;
  const std::string wanted =
      "FUNCTION_BLOCK T\n  VAR_INPUT\n    X      : ARRAY[0..2] OF LREAL;\n    LONGER : BOOL;\n  END_VAR\n  VAR_OUTPUT\n"
      "    Y : ARRAY[0..2] OF LREAL;\n    R : LREAL;\n  END_VAR\n\n  Y[0] := X[1];\n  Y[1] := 1.0;\n  Y[2] := -X[2];\n"
      "  R := DOT(X, [1.0, X[0], 2.0]);\nEND_FUNCTION_BLOCK\n";
  const std::string loose =
      "FUNCTION_BLOCK T\nVAR_INPUT X : array [ 0 .. 2 ] of lreal; LONGER : BOOL; END_VAR\nVAR_OUTPUT\n"
      "Y : ARRAY[0..2] OF LREAL; R : LREAL; END_VAR\nY[ 0 ]:=X [1];Y[1]:=1.0; Y[2] := -X[ 2 ];\n"
      "R := DOT( X,[ 1.0,X[0],2.0 ] );\nEND_FUNCTION_BLOCK\n";
  EXPECT_EQ(format_text("t.st", loose, none), wanted);
  EXPECT_EQ(format_text("t.st", wanted, none), wanted);
  EXPECT_FALSE(none.has_errors());
}

TEST(Vectors, StatementsAreSortedAsTheyWereWritten) {
  Diagnostics diagnostics;
  const std::string text =
      "FUNCTION_BLOCK T\n  VAR_INPUT\n    X : ARRAY[0..1] OF LREAL;\n  END_VAR\n  VAR_OUTPUT\n    Y : ARRAY[0..1] OF "
      "LREAL;\n"
      "  END_VAR\n  VAR\n    V : ARRAY[0..1] OF LREAL;\n  END_VAR\n\n";
  const std::string sorted =
      format_text("t.st", text + "  Y := V * 2.0;\n  V := -X;\nEND_FUNCTION_BLOCK\n", diagnostics, {.any_order = true});
  EXPECT_EQ(sorted, text + "  V := -X;\n  Y := V * 2.0;\nEND_FUNCTION_BLOCK\n");
}

TEST(Vectors, ParametersOfAVectorAreSetByTheirElementsAndWrittenAgain) {
  Program program = compile_text(R"(FUNCTION_BLOCK T  (* @ts 1ms *)
  VAR_INPUT
    U : LREAL;
    K : ARRAY[0..1] OF LREAL := [1.0, 2.0];  (* @param *)
  END_VAR
  VAR_OUTPUT
    Y : LREAL;
  END_VAR
  VAR
    G : HY_STATE_SPACE := (A := [0.5, 0.0, 0.0, 0.5], B := [1.0, 1.0], C := [1.0, 0.0], D := 1.0);
  END_VAR

  G(U := U * K[0]);
  Y := G.Y + SUM(K);
END_FUNCTION_BLOCK
)");
  const std::string text =
      "[parameters]\n\"K[1]\" = 7.0\n\n[parameters.G]\nA = [0.25, 0.0, 0.0, 0.5]\n\n[initial.G]\n\"X[1]\" = 3.0\n";
  const auto file = parameters::parse_parameter_file("t.toml", text);
  Diagnostics diagnostics;
  parameters::apply(file, program.graph, diagnostics);
  EXPECT_FALSE(diagnostics.has_errors()) << diagnostics.all()[0].cause;
  EXPECT_EQ(program.graph.parameters[static_cast<std::size_t>(find_parameter(program.graph, "K[1]"))].value[0], 7.0);
  EXPECT_EQ(program.graph.parameters[static_cast<std::size_t>(find_parameter(program.graph, "G.A"))].value[0], 0.25);
  ASSERT_EQ(program.graph.initial_states.size(), 1U);
  EXPECT_EQ(program.graph.initial_states[0].value, 3.0);
  EXPECT_THAT(parameters::parameter_text(file), HasSubstr("\"K[1]\" = 7.0"));
  EXPECT_THAT(parameters::parameter_text(file), HasSubstr("\"X[1]\" = 3.0"));

  Diagnostics refused;
  parameters::apply(parameters::parse_parameter_file("t.toml", "[parameters.G]\nA = [0.25, 0.0]\n"), program.graph,
                    refused);
  ASSERT_TRUE(refused.has_errors());
  EXPECT_THAT(refused.all()[0].cause, HasSubstr("takes 4 numbers, here are 2"));
}

TEST(Vectors, NamesOfElements) {
  EXPECT_EQ(element_name("Y", 2), "Y[2]");
  EXPECT_EQ(element_of("Y[12]")->vector, "Y");
  EXPECT_EQ(element_of("Y[12]")->index, 12);
  EXPECT_FALSE(element_of("Y"));
  EXPECT_FALSE(element_of("Y[]"));
  EXPECT_FALSE(element_of("Y[1"));
}

}  // namespace
}  // namespace hysteron::testing
