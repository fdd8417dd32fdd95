// Mistakes in the text of sequential bodies: literals that do not fit, divisions by one that is 0, names declared
// twice.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "codegen/backends/st/st.hpp"
#include "codegen/compile.hpp"
#include "codegen/interpreter/machine.hpp"
#include "support/errors.hpp"
#include "tests/codegen/refusal.hpp"

namespace hysteron::testing {
namespace {

using Faults = std::vector<std::string>;

Faults faults_of(const std::string& text) {
  Diagnostics found;
  const auto source = std::make_shared<const language::SourceFile>(language::parse("t", text, found));
  if (!found.has_errors()) {
    check(source, found);
  }
  Faults list;
  for (const Diagnostic& one : found.all()) {
    list.push_back(fmt::format("{}:{}", one.number, one.place.line));
  }
  return list;
}

std::string with_ports(const std::string& statements) {
  return "FUNCTION_BLOCK F (* @ts 10ms @body *)\nVAR_INPUT X : INT; B : BOOL; US : USINT; UD : UDINT; L : LREAL; "
         "END_VAR VAR_OUTPUT D : DINT; Y : INT; RR : REAL; W : WORD; Q : BOOL; END_VAR\n" +
         statements + "\nEND_FUNCTION_BLOCK";
}

/// The first output that is not 0, for X = 3, B = 1, US = 200, UD = 4e9 and L = 2.5.
double one_result(const std::string& statement) {
  const Program program = compile_text(with_ports(statement));
  Machine<double> machine(program, 0.01);
  std::size_t at = 0;
  for (const double input : {3.0, 1.0, 200.0, -294967296.0, 2.5}) {
    machine.set_input(at++, input);
  }
  machine.step();
  for (std::size_t i = 0; i < program.graph.outputs.size(); ++i) {
    if (machine.output(i) != 0.0) {
      return machine.output(i);
    }
  }
  return 0.0;
}

TEST(BodyMistakes, ALiteralBeyondItsNeighbourTakesATypeThatHoldsBoth) {
  for (const auto& [statement, expected] :
       std::vector<std::pair<std::string, double>>{{"Y := LIMIT(0, X, 65535);", 3},
                                                   {"Y := MIN(X, 40000);", 3},
                                                   {"D := SEL(B, X, 70000);", 70000},
                                                   {"D := SEL(NOT B, X, 70000);", 3},
                                                   {"D := MAX(X, 70000);", 70000},
                                                   {"D := MAX(1, X, 300, 70000);", 70000},
                                                   {"D := MUX(X, 1, US, 7, 300);", 300},
                                                   {"D := ABS(X - 40000);", 39997},
                                                   {"Y := LIMIT(0, US, 300);", 200},
                                                   {"Y := (X * 100000) / 200000 + 5;", 6},
                                                   {"D := SEL(UD > 3000000000, 1, 2);", 2},
                                                   {"D := SEL(MAX(US, 3000000000) = 3000000000, 1, 2);", 2},
                                                   {"Y := X AND 16#FFFF;", 3},
                                                   {"RR := 3000000000;", 3000000000.0F},
                                                   {"D := SEL(3000000000 / (UD AND 2 OR 2) = 1500000000, 1, 2);", 2},
                                                   {"D := REAL_TO_DINT(UDINT_TO_REAL(4000000000 - 3999999990));", 10},
                                                   {"D := 4000000000 - 3999999990;", 10}}) {
    EXPECT_EQ(one_result(statement), expected) << statement;
  }
  for (const char* const statement : {"Y := MAX(X, 40000);", "Y := X + 40000;", "Y := SEL(B, X, 70000);"}) {
    EXPECT_EQ(faults_of(with_ports(statement)), Faults{fmt::format("{}:3", error::type_mismatch)}) << statement;
  }
}

TEST(BodyMistakes, ALiteralThatNoTypeHoldsIsRefused) {
  for (const char* const statement :
       {"RR := 5000000000;", "D := 16#1FFFFFFFF;", "D := 5000000000;", "Q := X > 3000000000;", "Q := D > 3000000000;",
        "CASE X OF 4294967299: Y := 1; END_CASE;", "Q := UD > -1;", "RR := -3000000000;", "D := 2000000000 * 4;",
        "D := 4000000000 * 4000000000;"}) {
    EXPECT_EQ(faults_of(with_ports(statement)), Faults{fmt::format("{}:3", error::number_out_of_range)}) << statement;
  }
  EXPECT_EQ(faults_of(with_ports("D := 3000000000;")), Faults{fmt::format("{}:3", error::type_mismatch)});
}

TEST(BodyMistakes, ARealLiteralTakesTheTypeOfItsTarget) {
  for (const auto& [statement, expected] :
       std::vector<std::pair<std::string, double>>{{"RR := X * 0.1;", static_cast<float>(3 * 0.1)},
                                                   {"RR := MAX(X * 0.1, 0.2);", static_cast<float>(3 * 0.1)},
                                                   {"RR := MAX(X, 4.5);", 4.5},
                                                   {"RR := SQRT(2.25);", 1.5},
                                                   {"RR := (X + 0.5) / 2;", 1.75},
                                                   {"RR := 2.0 ** X;", 8.0}}) {
    EXPECT_EQ(one_result(statement), expected) << statement;
  }
  for (const char* const statement : {"RR := L * 0.1;", "RR := SQRT(L);", "RR := MAX(L, 0.1);"}) {
    EXPECT_EQ(faults_of(with_ports(statement)), Faults{fmt::format("{}:3", error::type_mismatch)}) << statement;
  }
}

TEST(BodyMistakes, ADivisionByALiteralZeroIsToldAndNotGenerated) {
  for (const char* const statement : {"Y := X / 0;", "D := D MOD 0;", "RR := RR / 0.0;", "Y := X / (1 - 1);"}) {
    const std::string text = with_ports(statement);
    EXPECT_EQ(faults_of(text), Faults{fmt::format("{}:3", error::other_meaning_elsewhere)}) << statement;
    const std::string generated = generate_st(compile_text(text), {}).front().text;
    EXPECT_EQ(generated.find("/ 0"), std::string::npos) << generated;
    EXPECT_EQ(generated.find("MOD 0"), std::string::npos) << generated;
  }
}

std::string told(const std::string& text) {
  Diagnostics found;
  const auto source = std::make_shared<const language::SourceFile>(language::parse("t", text, found));
  if (!found.has_errors()) {
    check(source, found);
  }
  return found.all().empty() ? std::string() : found.all().front().cause;
}

TEST(BodyMistakes, WhatIsDeclaredTwiceIsTold) {
  const auto block = [](const std::string& before, const std::string& locals) {
    return before + "\nFUNCTION_BLOCK F (* @ts 10ms @body *) VAR_INPUT X : INT; END_VAR VAR_OUTPUT Y : INT; END_VAR\n" +
           locals + "\nY := X;\nEND_FUNCTION_BLOCK";
  };
  for (const char* const locals :
       {"VAR N : INT; n : INT := 100; END_VAR", "VAR Y : REAL; END_VAR",
        "VAR N : INT; END_VAR VAR_TEMP N : BOOL; END_VAR", "VAR CONSTANT X : INT := 3; END_VAR",
        "VAR S : STRUCT A : INT; A : REAL; END_STRUCT; END_VAR"}) {
    EXPECT_EQ(faults_of(block("", locals)), Faults{fmt::format("{}:3", error::duplicate_name)}) << locals;
  }
  const std::string function = "FUNCTION G : REAL VAR_INPUT A : REAL; END_VAR G := A; END_FUNCTION ";
  for (const std::string& before :
       {std::string("TYPE P : INT; END_TYPE TYPE P : REAL; END_TYPE"), function + function,
        std::string("TYPE E : (ONE, TWO, ONE); END_TYPE"), "TYPE G : INT; END_TYPE " + function,
        std::string("FUNCTION G : REAL VAR_INPUT G : REAL; END_VAR G := 1.0; END_FUNCTION"),
        std::string("VAR_GLOBAL CONSTANT C : INT := 3; END_VAR VAR_GLOBAL CONSTANT C : INT := 4; END_VAR")}) {
    EXPECT_EQ(faults_of(block(before, "")), Faults{fmt::format("{}:1", error::duplicate_name)}) << before;
  }
  // A variable of the block hides a global one, and two enumerations may have a value of one name.
  EXPECT_EQ(faults_of(block("VAR_GLOBAL CONSTANT C : INT := 3; END_VAR TYPE A : (ONE); B : (ONE); END_TYPE",
                            "VAR C : INT; END_VAR")),
            Faults{});
}

TEST(BodyMistakes, ACaseHasEachValueOnceAndNoneThatItsSelectorNeverIs) {
  const auto arms = [](const std::string& text) { return with_ports("CASE X OF " + text + " END_CASE;"); };
  EXPECT_EQ(told(arms("1: Y := 1; 1: Y := 2;")), "the value 1 of this CASE stands here a second time");
  EXPECT_EQ(told(arms("-1: Y := 1; -5..0: Y := 2;")), "the value -1 of this CASE stands here a second time");
  EXPECT_EQ(told(arms("0..5: Y := 1; 6, 3: Y := 2;")), "the value 3 of this CASE stands here a second time");
  EXPECT_EQ(told(arms("9..7: Y := 1;")), "the range 9..7 is empty");
  EXPECT_EQ(told(arms("70000: Y := 1;")), "the selector is INT, which never is 70000");
  EXPECT_EQ(told(arms("1, 2: Y := 1; 3..5: Y := 2; -2..0: Y := 3;")), "");
  // In a loop, once.
  EXPECT_EQ(faults_of(with_ports("FOR D := 1 TO 3 DO CASE X OF 1: Y := 1; 1: Y := X / 0; END_CASE; END_FOR;")),
            (Faults{fmt::format("{}:3", error::refused_in_body), fmt::format("{}:3", error::other_meaning_elsewhere)}));
}

TEST(BodyMistakes, AnInitialValueLiesWithinItsType) {
  const auto of = [](const std::string& variable) {
    return told(with_ports("").replace(with_ports("").rfind("END_VAR\n"), 0, "END_VAR VAR " + variable + "; "));
  };
  EXPECT_NE(of("U : UINT := -1"), "");
  EXPECT_NE(of("U : WORD := -1"), "");
  EXPECT_EQ(of("U : UINT := 65535"), "");
  EXPECT_EQ(of("U : REAL := 1.0e60"), "U is REAL, which does not hold 1e+60");
  EXPECT_EQ(of("U : REAL := 3.4028235e38"), "");
  EXPECT_NE(told(with_ports("W := -1;")), "");
}

TEST(BodyMistakes, WordsOfTheLanguageAndOfOthersAreNamed) {
  const auto of = [](const std::string& variable) {
    return told(with_ports("").replace(with_ports("").rfind("END_VAR\n"), 0, "END_VAR VAR " + variable + "; "));
  };
  for (const char* const word : {"aT", "by", "TO", "IF"}) {
    EXPECT_EQ(of(std::string(word) + " : BOOL"),
              fmt::format("{} is a keyword of the language and cannot be the name of a variable.", word));
  }
  EXPECT_EQ(told(with_ports("GOTO AWAY;")), "A body has no GOTO.");
  EXPECT_EQ(told("FUNCTION_BLOCK F (* @body *) VAR_STAT N : INT; END_VAR VAR_OUTPUT Y : INT; END_VAR Y := N; "
                 "END_FUNCTION_BLOCK"),
            "VAR_STAT is shared by all instances of the block.");
  EXPECT_EQ(one_result("D := SEL(B AND_THEN X > 2, 1, 2);"), 2);
  EXPECT_EQ(one_result("D := SEL(X > 5 OR_ELSE NOT B AND_THEN Q, 1, 2);"), 1);
}

TEST(BodyMistakes, AnUnderscoreAtTheEndOfANameIsLeftOutOfStructuredText) {
  const std::string text =
      generate_st(compile_text("FUNCTION_BLOCK F_ (* @ts 10ms @body *) VAR_INPUT Stop_ : INT; INT_ : INT; END_VAR "
                               "VAR_OUTPUT a__b : INT; END_VAR a__b := Stop_ + INT_; END_FUNCTION_BLOCK"),
                  {})
          .front()
          .text;
  for (const char* const line :
       {"Stop_ is called STOP: IEC 61131-3 has single underscores, and none at the end of a name.",
        "INT_ is called INT_2", "a__b is called A_B", "F_ is called F:", "FUNCTION_BLOCK F\n", "STOP : DINT;"}) {
    EXPECT_NE(text.find(line), std::string::npos) << line << text;
  }
}

}  // namespace
}  // namespace hysteron::testing
