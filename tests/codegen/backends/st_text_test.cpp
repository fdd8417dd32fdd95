// What generated Structured Text owes to its compilers: names, characters, literals; and the same bytes each time.
#include "codegen/backends/st/st.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <array>
#include <cctype>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "codegen/backends/st/words.hpp"
#include "codegen/interpreter/machine.hpp"
#include "support/errors.hpp"
#include "tests/codegen/backends/st_as_cpp.hpp"
#include "tests/codegen/random_program.hpp"

namespace hysteron::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::string st_of(const std::string& diagram, std::string_view dialect = "portable") {
  return generate_st(compile_text(diagram), {.dialect = *st_dialect(dialect)}).front().text;
}

/// The names that a block declares, its own among them.
std::vector<std::string> declared_names(const std::string& text) {
  const auto tokens = StAsCpp(text).tokens();
  std::vector<std::string> names{tokens.at(1)};
  bool in_section = false;
  bool names_follow = false;
  for (const std::string& token : tokens) {
    if (token.starts_with("VAR")) {
      in_section = names_follow = true;
    } else if (token == "END_VAR") {
      in_section = false;
    } else if (in_section && names_follow && token != "CONSTANT" && token != ",") {
      if (token == ":") {
        names_follow = false;
      } else {
        names.push_back(token);
      }
    } else if (token == ";") {
      names_follow = true;
    }
  }
  return names;
}

TEST(StText, OfRandomProgramsIsPortable) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const Program program = RandomDiagram(seed + 500, "P", 40).program();
    const std::string text =
        generate_st(program, {.dialect = *st_dialect("portable"), .float32 = seed % 2 == 1})[0].text;
    std::set<std::string> seen;
    for (const std::string& name : declared_names(text)) {
      EXPECT_FALSE(is_st_word(name)) << name;
      EXPECT_TRUE(seen.insert(name).second) << name << " is declared twice";
      EXPECT_EQ(name.find("__"), std::string::npos) << name;
      EXPECT_NE(name.back(), '_') << name;
      EXPECT_TRUE(std::isalpha(static_cast<unsigned char>(name.front()))) << name;
    }
    EXPECT_GT(seen.size(), 40U);
    for (const char letter : text) {
      ASSERT_TRUE(letter == '\n' || (letter >= ' ' && letter <= '~')) << "seed " << seed;
    }
    for (const std::string& token : StAsCpp(text).tokens()) {
      EXPECT_NE(token, "inf");
      EXPECT_NE(token, "nan");
    }
    EXPECT_EQ(text, generate_st(program, {.dialect = *st_dialect("portable"), .float32 = seed % 2 == 1})[0].text);
  }
}

/// The standard has no empty list of statements, and MATIEC keeps to it.
void expect_statements_between(const std::string& text) {
  std::string before;
  for (const std::string& token : StAsCpp(text).tokens()) {
    const bool opens = before == "THEN" || before == "ELSE" || before == "DO" || before == "OF";
    EXPECT_FALSE(opens && (token.starts_with("END_") || token.starts_with("ELS"))) << before << ' ' << token;
    before = token;
  }
}

TEST(StText, OfRandomProgramsHasNoEmptyListOfStatements) {
  for (std::uint64_t seed = 0; seed < 120; ++seed) {
    const Program program = RandomDiagram(seed + 3000, "P", 30, {.rates = seed % 3 == 0}).program();
    expect_statements_between(generate_st(program, {.dialect = *st_dialect("portable")})[0].text);
    expect_statements_between(generate_st_structured(program, {.dialect = *st_dialect("portable")})[0].text);
  }
  expect_statements_between(generate_st_library(1'000'000, {.dialect = *st_dialect("portable")})[0].text);
}

TEST(StText, NamesThatACompilerKeepsAreChangedAndTheHeadSaysSo) {
  const std::string diagram =
      "FUNCTION_BLOCK SERVO (* @ts 1ms *) VAR_INPUT REF, RESET, SERVO : LREAL; NAME : LREAL; END_VAR\n"
      "VAR_OUTPUT S : LREAL; END_VAR VAR LREAL_TO : HY_GAIN; END_VAR\n"
      "LREAL_TO(XIN := REF + RESET + SERVO + NAME); S := LREAL_TO.XOUT; END_FUNCTION_BLOCK";
  const std::string text = st_of(diagram);
  EXPECT_THAT(text, HasSubstr("REF is called REF_2"));
  EXPECT_THAT(text, HasSubstr("S is called S_2"));
  EXPECT_THAT(text, HasSubstr("FUNCTION_BLOCK SERVO_2\n")) << "its input keeps the name";
  EXPECT_THAT(text, HasSubstr("RESET_ALL : BOOL := FALSE;"));
  EXPECT_THAT(text, HasSubstr("IF RESET_ALL OR NOT STARTED THEN"));
  EXPECT_THAT(text, HasSubstr("    NAME : LREAL;"));
  EXPECT_THAT(st_of(diagram, "siemens-scl"), HasSubstr("NAME is called NAME_2"));
}

/// MATIEC makes C of the text, with all names in capitals: what is a macro there can be no name.
TEST(StText, NamesThatCKnowsAreChanged) {
  const std::string diagram =
      "FUNCTION_BLOCK FILE (* @ts 1ms *) VAR_INPUT MAX_INPUT, EXP_1, MAX_TIME, M_PI : LREAL; MOD_STATUS : BOOL; "
      "END_VAR\n"
      "VAR_OUTPUT NAN : LREAL; STATE : BOOL; END_VAR VAR LAG : HY_LAG; FLOAT : LREAL; END_VAR\n"
      "FLOAT := SIN(MAX_INPUT) + EXP_1; LAG(XIN := FLOAT * FLOAT + MAX_TIME * M_PI); NAN := LAG.XOUT; STATE := "
      "MOD_STATUS;\n"
      "END_FUNCTION_BLOCK";
  const std::string text = st_of(diagram);
  for (const char* const name : {"FILE", "MAX_INPUT", "MAX_TIME", "MOD_STATUS", "NAN"}) {
    EXPECT_THAT(text, HasSubstr(fmt::format("   {0} is called {0}_2:", name)));
  }
  EXPECT_THAT(text, HasSubstr("   M_PI is called M_PI_3:")) << "M_PI_2 is a name of C, too";
  EXPECT_THAT(text, HasSubstr("    EXP_1 : LREAL;"));
  EXPECT_THAT(text, HasSubstr("  FLOAT := SIN(MAX_INPUT_2) + EXP_1;"));
  for (const std::string& name : declared_names(text)) {
    EXPECT_FALSE(is_st_word(name)) << name;
  }
}

TEST(StText, WordsAreThoseOfTheStandardAndOfTheVendors) {
  for (const char* const word : {"IF",
                                 "end_function_block",
                                 "Sel",
                                 "LIMIT",
                                 "R_TRIG",
                                 "LREAL_TO_DINT",
                                 "ST",
                                 "PID",
                                 "ADR",
                                 "PERSISTENT",
                                 "REF",
                                 "S",
                                 "MAX_TIME",
                                 "add_int",
                                 "MUX_DINT_REAL",
                                 "SUB_DATE_DATE",
                                 "BCD_TO_UINT",
                                 "M_PI",
                                 "NAN",
                                 "max_input",
                                 "MOD_STATUS",
                                 "EIO",
                                 "FILE",
                                 "IEC_LREAL"}) {
    EXPECT_TRUE(is_st_word(word)) << word;
  }
  for (const char* const word : {"REFERENCE_1", "X_TO_Y", "SUM", "XIN", "NAME", "VERSION", "STEP_TIME", "MAX_SPEED",
                                 "MAX_TIME_1", "TIME_MAX", "MAX_", "INT_1", "FLOAT", "STATE", "PI", "VOID"}) {
    EXPECT_FALSE(is_st_word(word)) << word;
  }
  EXPECT_TRUE(is_scl_word("Version"));
  EXPECT_TRUE(is_scl_word("IF"));
}

TEST(StText, ABoundThatIsNoneIsTheLargestNumber) {
  const std::string diagram =
      "FUNCTION_BLOCK B (* @ts 1ms *) VAR_INPUT X : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR VAR L : HY_LIMIT; "
      "END_VAR L(XIN := X); Y := L.XOUT; END_FUNCTION_BLOCK";
  EXPECT_THAT(st_of(diagram), HasSubstr("L_MX : LREAL := 3.4028234663852886E38;"));
  EXPECT_THAT(st_of(diagram), HasSubstr("L_MN : LREAL := -3.4028234663852886E38;"));
  EXPECT_THAT(st_of(diagram, "twincat"), HasSubstr("L_MX : LREAL := 1.7976931348623157E308;"));
  EXPECT_THAT(generate_st(compile_text(diagram), {.dialect = *st_dialect("codesys"), .float32 = true})[0].text,
              HasSubstr("L_MX : REAL := 3.4028235E38;"));
}

/// The outputs of a program over steps of SP and PV.
std::vector<double> outputs_over(const Program& program, std::span<const std::array<double, 2>> rows) {
  Machine<double> machine(program, 1e-3);
  for (std::size_t i = 2; i < program.graph.inputs.size(); ++i) {  // of a text that was generated: RESET, parameters
    machine.set_input(i, program.graph.inputs[i].preset);
  }
  std::vector<double> outputs;
  for (const auto& row : rows) {
    machine.set_input(0, row[0]);
    machine.set_input(1, row[1]);
    machine.step();
    outputs.push_back(machine.output(0));
  }
  return outputs;
}

TEST(StText, AnIntegralThatIsNoneStaysNone) {
  const std::string diagram =
      "FUNCTION_BLOCK B (* @ts 1ms *) VAR_INPUT SP, PV : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR VAR C : HY_PID; "
      "END_VAR C(SP := SP, PV := PV); Y := C.XOUT; END_FUNCTION_BLOCK";
  constexpr std::array<std::array<double, 2>, 5> rows{{{1.0, 0.0}, {1.0, 1.0}, {0.0, 1e30}, {2.0, 2.0}, {0.0, 1.0}}};
  const std::vector<double> wanted = outputs_over(compile_text(diagram), rows);
  ASSERT_EQ(wanted[1], 0.0);
  const Program program = compile_text(diagram);
  const StOptions options{.dialect = *st_dialect("portable")};
  for (const auto& files : {generate_st(program, options), generate_st_structured(program, options)}) {
    const std::vector<double> got = outputs_over(compile_text(files.front().text, {.top = "B"}), rows);
    EXPECT_EQ(got, wanted) << files.front().text;
  }
  for (const char* const dialect : {"portable", "codesys", "twincat"}) {
    EXPECT_THAT(st_of(diagram, dialect), HasSubstr("  IF C_TR >= LARGEST THEN")) << dialect;
  }
}

std::string body_of_expression(const std::string& expression, std::string_view dialect = "portable") {
  const std::string text =
      st_of(fmt::format("FUNCTION_BLOCK E (* @ts 1ms *) VAR_INPUT X, Z : LREAL; N, M : DINT; B, C, D : BOOL; END_VAR\n"
                        "VAR_OUTPUT Y : LREAL; K : DINT; Q : BOOL; END_VAR {} END_FUNCTION_BLOCK",
                        expression),
            dialect);
  return text.substr(text.find("END_IF;\n\n") + 9);
}

TEST(StText, WhatWouldStopAPlcIsGuarded) {
  const auto y = [](const std::string& expression) {
    return body_of_expression("Y := " + expression + "; K := 0; Q := FALSE;");
  };
  EXPECT_THAT(y("X / Z"), HasSubstr("  IF Z <> 0.0 THEN Y := X / Z;\n"
                                    "  ELSE Y := SEL(X < 0.0, SEL(X > 0.0, 0.0, LARGEST), -LARGEST); END_IF;\n"));
  EXPECT_THAT(y("X / 2.0"), HasSubstr("  Y := X / 2.0;\n"));
  EXPECT_THAT(y("X / (1.0 + ABS(Z))"), HasSubstr("  Y := X / (1.0 + ABS(Z));\n"));
  EXPECT_THAT(y("X / SEL(Z > 0.0, 1.0, Z)"), HasSubstr("  Y := X / SEL(0.0 < Z, 1.0, Z);\n"));
  EXPECT_THAT(y("X / SEL(Z > 0.0, Z, 1.0)"), HasSubstr("IF Y_CHOICE <> 0.0 THEN")) << "Z is at or below 0 there";
  EXPECT_THAT(y("1.0 / Z"), HasSubstr("ELSE Y := LARGEST; END_IF;"));
  EXPECT_THAT(y("SQRT(X)"), HasSubstr("  Y := SQRT(MAX(X, 0.0));\n"));
  EXPECT_THAT(y("SQRT(ABS(X))"), HasSubstr("  Y := SQRT(ABS(X));\n"));
  EXPECT_THAT(y("LN(X)"), HasSubstr("  Y := LN(SEL(X > 0.0, 1.2E-38, X));\n"));
  EXPECT_THAT(y("ASIN(X)"), HasSubstr("  Y := ASIN(LIMIT(-1.0, X, 1.0));\n"));
  EXPECT_THAT(y("X ** 3.0"), HasSubstr("  Y := EXPT(X, LREAL#3.0);\n"));
  EXPECT_THAT(y("X ** 2.0"), HasSubstr("  Y := X * X;\n"));
  EXPECT_THAT(y("X ** 1.5"), HasSubstr("  Y := EXPT(MAX(X, 0.0), LREAL#1.5);\n"));
  EXPECT_THAT(y("X ** (-2.0)"), HasSubstr("IF X <> 0.0 THEN Y := EXPT(X, -LREAL#2.0);\n"));
  EXPECT_THAT(y("X ** (-0.5)"), HasSubstr("IF X > 0.0 THEN Y := EXPT(X, -LREAL#0.5);\n"));
  EXPECT_THAT(y("X ** Z"), HasSubstr("  ELSIF X > 0.0 THEN Y := EXPT(X, Z);\n"));
}

/// Where a value is an output as it stands, it has the output's name from its computation on.
TEST(StText, OutputsKeepTheirOwnNames) {
  const std::string text = st_of(
      "FUNCTION_BLOCK OWN (* @ts 1ms *) VAR_INPUT X, Z : LREAL; V : ARRAY[0..3] OF LREAL; END_VAR\n"
      "VAR_OUTPUT Y, Q, COPY, SLOW, ONE : LREAL; ALL_OF_IT : ARRAY[0..3] OF LREAL; END_VAR\n"
      "VAR L : HY_LIMIT := (MN := -1.0, MX := 1.0); G : LREAL; S : HY_SAMPLE; (* @every 4 *) H : HY_HOLD; W : "
      "ARRAY[0..3] OF LREAL;\n"
      "P : HY_PID; END_VAR\n"
      "L(XIN := X); Y := L.XOUT; G := Y * Z; Q := G + G; COPY := Y; S(XIN := Q); H(XIN := S.XOUT); SLOW := H.XOUT;\n"
      "W := V * Y; ALL_OF_IT := W; ONE := W[2] * W[2]; P(SP := X, PV := Y); END_FUNCTION_BLOCK");
  EXPECT_THAT(text, HasSubstr("  Y := MIN(MAX(X, L_MN), L_MX);\n"));
  EXPECT_THAT(text, Not(HasSubstr("L_XOUT")));
  EXPECT_THAT(text, HasSubstr("  G := Y * Z;\n  Q := G + G;\n"));
  EXPECT_THAT(text, HasSubstr("  COPY := Y;\n")) << "a second name of the same value";
  EXPECT_THAT(text, HasSubstr("    S_XOUT := Q;\n"));
  EXPECT_THAT(text, HasSubstr("  SLOW := S_XOUT;\n"));
  EXPECT_THAT(text, HasSubstr("P_INTEGRAL := P_INTEGRAL_NEXT;\n")) << "what a memory becomes is called after it";
  for (const char* const output : {"Y", "Q", "COPY", "SLOW", "ONE"}) {
    std::size_t assignments = 0;
    const std::string assigned = fmt::format(" {} := ", output);
    for (std::size_t at = text.find(assigned); at != std::string::npos; at = text.find(assigned, at + 1)) {
      ++assignments;
    }
    EXPECT_EQ(assignments, 1U) << output;
  }
}

TEST(StText, IntegersKeepTheirRange) {
  const auto k = [](const std::string& expression) {
    return body_of_expression("Y := 0.0; K := " + expression + "; Q := FALSE;");
  };
  EXPECT_THAT(k("N / M"), HasSubstr("  IF M = 0 THEN K := 0;\n  ELSIF M = -1 THEN K := 0 - N;\n"
                                    "  ELSE K := N / M; END_IF;\n"));
  EXPECT_THAT(k("N MOD 7"), HasSubstr("  K := N MOD 7;\n"));
  EXPECT_THAT(k("TRUNC(X)"), HasSubstr("  IF X >= 2147483648.0 THEN K := 2147483647;\n"));
  EXPECT_THAT(k("MAX(1, N)"), HasSubstr("  K := MAX(DINT#1, N);\n")) << "a plain 1 may be taken for a USINT";
}

TEST(StText, OperatorsOfTruthValuesKeepTheirOrder) {
  const auto q = [](const std::string& expression) {
    return body_of_expression("Y := 0.0; K := 0; Q := " + expression + ";");
  };
  EXPECT_THAT(q("(B XOR C) AND D"), HasSubstr("  Q := (B XOR C) AND D;\n"));
  EXPECT_THAT(q("B XOR (C AND D)"), HasSubstr("  Q := B XOR (C AND D);\n"));
  EXPECT_THAT(q("NOT (B OR C)"), HasSubstr("  Q := NOT B AND NOT C;\n"));
  EXPECT_THAT(q("NOT (B AND (C OR NOT D))"), HasSubstr("  Q := NOT B OR (NOT C AND D);\n"));
  EXPECT_THAT(q("B = C"), HasSubstr("  Q := B = C;\n"));
  EXPECT_THAT(q("NOT (N = M)"), HasSubstr("  Q := N <> M;\n"));
  EXPECT_THAT(q("NOT (X < Z)"), HasSubstr("  Q := NOT (X < Z);\n"));  // not X >= Z: one may be no number
}

TEST(StText, WordsStayWords) {
  const auto z = [](const std::string& expression) {
    return st_of(
        "FUNCTION_BLOCK C (* @ts 1ms *) VAR_INPUT W, V : WORD; N : DINT; END_VAR\nVAR_OUTPUT Z : WORD; Q : BOOL; "
        "END_VAR Z := " +
        expression + "; Q := (W AND V) = 16#27 AND NOT W.3; END_FUNCTION_BLOCK");
  };
  EXPECT_THAT(z("(W AND 16#6F) XOR V"), HasSubstr("  Z := (W AND WORD#16#006F) XOR V;\n"));
  EXPECT_THAT(z("NOT (NOT W)"), HasSubstr("  Z := NOT (NOT W);\n"));
  EXPECT_THAT(z("SHL(W OR V, 4)"), HasSubstr("  Z := SHL(W OR V, 4);\n"));
  EXPECT_THAT(z("SHR(NOT W, 15)"), HasSubstr("  Z := SHR(NOT W, 15);\n"));
  EXPECT_THAT(z("DINT_TO_WORD(N) OR W"),
              HasSubstr("  Z := DWORD_TO_WORD(DINT_TO_DWORD(N) AND DWORD#16#0000FFFF) OR W;\n"));
  EXPECT_THAT(z("W"), HasSubstr("  Q := (W AND V) = WORD#16#0027 AND ((W AND WORD#16#0008) = WORD#16#0000);\n"));
}

TEST(StText, BitsOfIntegersAreConvertedAtTheirEdgesAlone) {
  const auto k = [](const std::string& expression) {
    return st_of(
        "FUNCTION_BLOCK C (* @ts 1ms @body *) VAR_INPUT D, E : DWORD; END_VAR VAR_OUTPUT K : DWORD; END_VAR K := " +
        expression + "; END_FUNCTION_BLOCK");
  };
  EXPECT_THAT(
      k("(D AND 16#FF) OR SHL(E, 8)"),
      HasSubstr("  K := DWORD_TO_DINT((DINT_TO_DWORD(D) AND DWORD#16#000000FF) OR SHL(DINT_TO_DWORD(E), 8));\n"));
  EXPECT_THAT(k("NOT (D XOR E)"), HasSubstr("  K := DWORD_TO_DINT(NOT (DINT_TO_DWORD(D) XOR DINT_TO_DWORD(E)));\n"));
}

TEST(StText, OneOperationOnAllElementsIsALoop) {
  const auto body = [](const std::string& statements) {
    return st_of(
        "FUNCTION_BLOCK C (* @ts 1ms *) VAR_INPUT A, B : ARRAY[0..10] OF LREAL; X : LREAL; END_VAR\n"
        "VAR_OUTPUT Y : ARRAY[0..10] OF LREAL; END_VAR " +
        statements + " END_FUNCTION_BLOCK");
  };
  EXPECT_THAT(body("Y := A * X + B[0];"),
              HasSubstr("  FOR PLACE := 0 TO 10 DO\n    Y[PLACE] := A[PLACE] * X + B[0];\n  END_FOR;\n"));
  EXPECT_THAT(body("Y := A - B;"), HasSubstr("Y[PLACE] := A[PLACE] - B[PLACE];"));
  EXPECT_THAT(body("Y := [A[0], A[1], A[2], A[3], A[4], A[5], A[6], A[7], A[8], A[10], A[9]];"),
              HasSubstr("  Y[9] := A[10];\n"));
}

TEST(StText, DialectsDifferWhereTheirCompilersDo) {
  const std::string scl = body_of_expression("Y := MAX(X, Z) ** 3.0; K := SEL(B, N, M); Q := FALSE;", "siemens-scl");
  EXPECT_THAT(scl, HasSubstr("#Y := (MAX(IN1 := #X, IN2 := #Z)) ** (LREAL#3.0);\n"));
  EXPECT_THAT(scl, HasSubstr("#K := SEL(G := #B, IN0 := #N, IN1 := #M);\n"));
  EXPECT_THAT(scl, HasSubstr("END_FUNCTION_BLOCK\n"));
  const std::string codesys = body_of_expression("Y := X; K := 0; Q := FALSE;", "codesys");
  EXPECT_THAT(codesys, Not(HasSubstr("END_FUNCTION_BLOCK")));
  EXPECT_FALSE(st_dialect("rockwell"));
}

TEST(StText, CommentsAreTheUsersWordsInAscii) {
  const std::string text = st_of(
      "FUNCTION_BLOCK C (* @ts 1ms *) VAR_INPUT X : LREAL; (* @unit um @doc 3·10⁻² µm, (x) *) END_VAR\n"
      "VAR_OUTPUT Y : LREAL; END_VAR Y := X; END_FUNCTION_BLOCK");
  EXPECT_THAT(text, HasSubstr("X : LREAL;  (* [um] 3*10?^2 um, (x) *)"));
}

TEST(StText, ADiagramWithoutASampleTimeIsRefused) {
  try {
    st_of("FUNCTION_BLOCK C VAR_INPUT X : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR Y := X; END_FUNCTION_BLOCK");
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(error.diagnostics().all().front().number, error::missing_sample_time);
  }
}

}  // namespace
}  // namespace hysteron::testing
