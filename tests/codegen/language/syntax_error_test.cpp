// Syntax errors: each has its number and its exact place, one slip is one message, and reading goes on behind it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

#include "codegen/language/syntax.hpp"
#include "support/errors.hpp"
#include "tests/codegen/language/dump.hpp"

namespace hysteron::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

struct Found {
  language::SourceFile file;
  Diagnostics diagnostics;
};

Found parse_wrong(std::string text) {
  Found found;
  found.file = language::parse("test.st", std::move(text), found.diagnostics);
  EXPECT_FALSE(found.file.valid);
  return found;
}

/// "102 3:5+2": number, line, column, length.
std::vector<std::string> errors(std::string text) {
  std::vector<std::string> list;
  const auto found = parse_wrong(std::move(text));
  for (const auto& one : found.diagnostics.all()) {
    EXPECT_EQ(one.place.file, "test.st");
    EXPECT_EQ(one.severity, Severity::Error);
    EXPECT_FALSE(one.mend.empty());
    list.push_back(fmt::format("{} {}:{}+{}", one.number, one.place.line, one.place.column, one.place.length));
  }
  return list;
}

/// Errors of statements; the first line is line 1.
std::vector<std::string> in_statements(std::string_view statements) {
  return errors(fmt::format("FUNCTION_BLOCK F {}\nEND_FUNCTION_BLOCK", statements));
}

std::vector<std::string> in_section(std::string_view declarations) {
  return errors(fmt::format("FUNCTION_BLOCK F\nVAR\n{}\nEND_VAR\nEND_FUNCTION_BLOCK", declarations));
}

std::string first_mend(std::string_view statement) {
  return parse_wrong(fmt::format("FUNCTION_BLOCK F {}\nEND_FUNCTION_BLOCK", statement)).diagnostics.all().at(0).mend;
}

TEST(SyntaxError, CharactersAndComments) {
  EXPECT_THAT(in_statements("A := B # C;"), ElementsAre("101 1:25+1"));
  EXPECT_THAT(in_statements("A := \xC2\xB5;"), ElementsAre("101 1:23+1"));
  EXPECT_THAT(in_statements("A := B \xE2\x80\x9C\xE2\x80\x9D;"), ElementsAre("101 1:25+2"));
  EXPECT_THAT(in_statements("A := B; \xFF"), ElementsAre("101 1:26+1"));
  EXPECT_THAT(in_statements(std::string_view("A := B;\0\0\0", 10)), ElementsAre("101 1:25+3"));
  EXPECT_THAT(in_statements("A := B; (* no end"), ElementsAre("104 1:26+2"));
  EXPECT_THAT(in_statements("A := B; // note\nC := D;"), ElementsAre("105 1:26+2"));
  EXPECT_THAT(in_statements("A := /* note */ B;"), ElementsAre("105 1:23+2"));
  EXPECT_THAT(in_statements("A := B; (* a (* b *)"), ElementsAre("105 1:31+2"));
  EXPECT_THAT(in_statements("{x} A := B;"), ElementsAre("106 1:18+1"));
  EXPECT_THAT(in_statements("{ A := B;"), ElementsAre("106 1:18+1"));
}

TEST(SyntaxError, Literals) {
  EXPECT_THAT(in_statements("A := 1.; B := .5; C := 1e6; D := 1__0; E := 16#G; F := 3#12; G := 50us; H := 16#;"),
              ElementsAre("107 1:23+2", "107 1:32+2", "107 1:41+3", "107 1:51+4", "107 1:62+4", "107 1:73+4",
                          "107 1:84+4", "107 1:95+3"));
  EXPECT_THAT(in_statements("A := BOOL#2; B := DINT#1.5; C := LREAL#; D := WORD#X;"),
              ElementsAre("107 1:23+6", "107 1:36+8", "107 1:51+6", "107 1:64+6"));
  EXPECT_THAT(in_statements("A := 2147483648; B := -2147483649; C := -(2147483648); D := WORD#65536; E := WORD#-1;"),
              ElementsAre("108 1:23+10", "108 1:41+10", "108 1:60+10", "108 1:78+10", "108 1:95+7"));
  EXPECT_THAT(in_statements("A := 1.0e400; B := 1.0e-400; C := 99999999999999999999;"),
              ElementsAre("108 1:23+7", "108 1:37+8", "108 1:52+20"));
  EXPECT_THAT(in_statements("A := LTIME#50us; B := ltime#1h_2.5m; C := DT#2024-01-31-12:00:00; D := LTIME#1ns;"),
              ElementsAre("109 1:23+10", "109 1:40+13", "109 1:60+22", "109 1:89+9"));
  EXPECT_THAT(in_statements("A := 'it$'s'; B := \"x\"; C := 'open\n;"),
              ElementsAre("110 1:23+7", "110 1:37+3", "110 1:47+5"));
  EXPECT_THAT(in_statements("A := REAL#1.0;"), ElementsAre("113 1:23+8"));
  EXPECT_THAT(in_statements("A := %IX0.1; %QD4 := B;"), ElementsAre("127 1:23+6", "127 1:31+4"));
}

TEST(SyntaxError, LiteralsAreMended) {
  EXPECT_THAT(first_mend("A := 1.;"), HasSubstr("1.0"));
  EXPECT_THAT(first_mend("A := .5;"), HasSubstr("0.5"));
  EXPECT_THAT(first_mend("A := 1e-6;"), HasSubstr("1.0e-6"));
  EXPECT_THAT(first_mend("A := LTIME#50us;"), HasSubstr("5.0e-5"));
  EXPECT_THAT(first_mend("A = B;"), HasSubstr(":="));
  EXPECT_THAT(first_mend("I.P := B;"), HasSubstr("I(P := …)"));
  EXPECT_THAT(first_mend("I(P => B);"), HasSubstr("I"));
}

TEST(SyntaxError, Statements) {
  EXPECT_THAT(in_statements("A = B;"), ElementsAre("102 1:20+1"));
  EXPECT_THAT(in_statements("A B;"), ElementsAre("102 1:20+1"));
  EXPECT_THAT(in_statements(";"), ElementsAre("102 1:18+1"));
  EXPECT_THAT(in_statements("END_VAR"), ElementsAre("102 1:18+7"));
  EXPECT_THAT(in_statements("3 := A;"), ElementsAre("102 1:18+1"));
  EXPECT_THAT(in_statements("A : LREAL;"), ElementsAre("102 1:20+1"));
  EXPECT_THAT(in_statements("A := B +;"), ElementsAre("102 1:26+1"));
  EXPECT_THAT(in_statements("A := (B;"), ElementsAre("102 1:25+1"));
  EXPECT_THAT(in_statements("A := B);"), ElementsAre("102 1:24+1"));
  EXPECT_THAT(in_statements("A := MAX(B, );"), ElementsAre("102 1:30+1"));
  EXPECT_THAT(in_statements("A(X := 1.0,);"), ElementsAre("102 1:29+1"));
  EXPECT_THAT(in_statements("A := AND;"), ElementsAre("102 1:23+3"));
  EXPECT_THAT(in_statements("TRUE := A;"), ElementsAre("102 1:18+4"));
  EXPECT_THAT(in_statements("A := B C := D;"), ElementsAre("103 1:24+1"));
  EXPECT_THAT(in_statements("A := B"), ElementsAre("103 1:24+1"));
  EXPECT_THAT(in_statements("A(X := B)\nC := D;"), ElementsAre("103 1:27+1"));
}

TEST(SyntaxError, WhatADiagramDoesNotHave) {
  EXPECT_THAT(in_statements("IF A THEN IF B THEN C := ); END_IF; END_IF; D := );"),
              ElementsAre("102 1:43+1", "102 1:67+1"));
  EXPECT_THAT(in_statements("FOR I := 1 TO 3 DO A := B; END_FOR\nEXIT; REPEAT A := B;"),
              ElementsAre("129 2:1+4", "102 3:1+18"));  // a body
  EXPECT_THAT(in_statements("A := B; END_IF;\nEXIT;"), ElementsAre("111 1:26+6", "111 2:1+4"));
  EXPECT_THAT(in_statements("IF A THEN EXIT; END_IF;\nCONTINUE;\nRETURN;"), ElementsAre("129 1:28+4", "129 2:1+8"));
  EXPECT_THAT(in_statements("FOR I := 1 TO 3 DO IF A THEN EXIT; ELSE CONTINUE; END_IF; END_FOR EXIT;"),
              ElementsAre("129 1:84+4"));
  EXPECT_THAT(in_statements("WHILE A DO CONTINUE; END_WHILE REPEAT EXIT; UNTIL A END_REPEAT EXIT;"),
              ElementsAre("129 1:81+4"));
  EXPECT_THAT(in_statements("A(B);"), ElementsAre("118 1:20+1"));
  EXPECT_THAT(in_statements("A(1.0);"), ElementsAre("118 1:20+3"));
  EXPECT_THAT(in_statements("A(X = 1.0);"), ElementsAre("118 1:22+1"));
  EXPECT_THAT(in_statements("A(X => B);"), ElementsAre("118 1:22+2"));
  EXPECT_THAT(in_statements("A := LIMIT(0.0, IN := B, MX := 1.0);"), ElementsAre("118 1:34+2", "118 1:43+2"));
  EXPECT_THAT(in_statements("I.P := A;"), ElementsAre("119 1:18+3"));
  EXPECT_THAT(in_statements("A := -B ** C; D := NOT E ** F; G := A ** -B ** C;"),
              ElementsAre("120 1:23+2", "120 1:37+5", "120 1:59+2"));
  EXPECT_THAT(in_statements("A := --B; C := NOT -D; E := +F; G := NOT NOT H;"),
              ElementsAre("120 1:24+1", "120 1:37+1", "120 1:46+1", "120 1:59+3"));
  EXPECT_THAT(in_statements("A := [[1.0]]; B := 1.0 + [2.0, [3.0]];"), ElementsAre("126 1:24+1", "126 1:49+1"));
  EXPECT_THAT(in_statements("A := B.C.D; A := B[1][2]; A := B[1].C;"),
              ElementsAre("128 1:26+1", "128 1:39+1", "128 1:53+1"));
}

TEST(SyntaxError, Declarations) {
  EXPECT_THAT(in_section("X : LINT; Y : POINTER; Z : DATE;"), ElementsAre("113 3:5+4", "113 3:15+7", "113 3:28+4"));
  EXPECT_THAT(in_section("A__B, C_ : LREAL;"), ElementsAre("114 3:1+4", "114 3:7+2"));
  EXPECT_THAT(in_section("X AT %QX0.0 : BOOL;"), ElementsAre("127 3:3+2", "127 3:6+6"));
  EXPECT_THAT(in_section("IF : BOOL; Y : LREAL := ; Z LREAL;"), ElementsAre("124 3:1+2", "102 3:25+1", "102 3:29+5"));
  EXPECT_THAT(in_section("TYPE, Class : LREAL; Y : BOOL := TYPE;"), ElementsAre("124 3:1+4", "124 3:34+4"));
  EXPECT_THAT(in_section("X : LREAL\nY : BOOL;"), ElementsAre("103 3:10+1"));
  EXPECT_THAT(in_section("T : HY_TABLE := (X := [0.0, [1.0]]);"), ElementsAre("126 3:29+1"));
  EXPECT_THAT(in_section("T : HY_TABLE := (X := []);"), ElementsAre("102 3:24+1"));
  EXPECT_THAT(in_section("T : HY_GAIN := (K := 1.0, 2.0);"), ElementsAre("118 3:27+3"));
  EXPECT_THAT(errors("FUNCTION_BLOCK F VAR_GLOBAL X : LREAL; END_VAR VAR Y : BOOL; END_VAR END_FUNCTION_BLOCK"),
              ElementsAre("112 1:18+10"));
  EXPECT_THAT(errors("FUNCTION_BLOCK F VAR Y : BOOL; END_VAR VAR_INPUT CONSTANT Z : BOOL; END_VAR END_FUNCTION_BLOCK"),
              ElementsAre("112 1:50+8"));
}

TEST(SyntaxError, PartsThatDoNotEnd) {
  EXPECT_THAT(errors("FUNCTION_BLOCK F\nVAR\nX : LREAL;\nVAR_INPUT\nY : LREAL;\nEND_VAR\nEND_FUNCTION_BLOCK"),
              ElementsAre("115 2:1+3"));
  EXPECT_THAT(errors("FUNCTION_BLOCK F\nVAR\nX : HY_GAIN;\nX(XIN := 1.0);\nEND_FUNCTION_BLOCK"),
              ElementsAre("115 2:1+3"));
  EXPECT_THAT(errors("FUNCTION_BLOCK F\nA := B;\nFUNCTION_BLOCK G\nA := B;\n"),
              ElementsAre("115 1:1+14", "115 3:1+14"));
  EXPECT_THAT(errors("FUNCTION_BLOCK F\nA := B;\nPROGRAM P\nEND_PROGRAM"), ElementsAre("115 1:1+14", "117 3:1+7"));
  EXPECT_THAT(errors("FUNCTION_BLOCK F\nA := B;\nVAR B : LREAL; END_VAR\nEND_FUNCTION_BLOCK"),
              ElementsAre("123 3:1+3"));
}

TEST(SyntaxError, Files) {
  EXPECT_THAT(errors(""), ElementsAre("116 1:1+1"));
  EXPECT_THAT(errors("\n (* nothing *)\n"), ElementsAre("116 1:1+1"));
  EXPECT_THAT(errors("\xEF\xBB\xBF"), ElementsAre("116 1:1+1"));
  EXPECT_THAT(errors("PROGRAM P\nEND_PROGRAM\nFUNCTION_BLOCK F END_FUNCTION_BLOCK\n  x"),
              ElementsAre("117 1:1+7", "117 4:3+1"));
  EXPECT_THAT(errors("FUNCTION_BLOCK END_FUNCTION_BLOCK"), ElementsAre("102 1:16+18"));
  EXPECT_THAT(errors("FUNCTION_BLOCK IF\nEND_FUNCTION_BLOCK"), ElementsAre("124 1:16+2"));
}

TEST(SyntaxError, AnnotationsThatBelongToNothing) {
  EXPECT_THAT(in_section("(* @unit um *)\nX : LREAL;"), ElementsAre("122 3:4+8"));
  EXPECT_THAT(in_section("X : LREAL;\n (* @unit um *)"), ElementsAre("122 4:5+8"));
  EXPECT_THAT(in_statements("A := B; (* @unit um *)"), ElementsAre("122 1:29+8"));
  EXPECT_THAT(errors("(* @ts 1ms *)\nFUNCTION_BLOCK F END_FUNCTION_BLOCK"), ElementsAre("122 1:4+7"));
}

TEST(SyntaxError, DepthIsBounded) {
  const auto nested = [](std::size_t depth) {
    return "A := " + std::string(depth, '(') + "B" + std::string(depth, ')') + ";";
  };
  const auto chain = [](std::size_t terms) {
    std::string text = "A := B";
    for (std::size_t i = 1; i < terms; ++i) {
      text += " + B";
    }
    return text + ";";
  };
  const auto number_of_errors = [](const std::string& statement) {
    Diagnostics diagnostics;
    language::parse("", "FUNCTION_BLOCK F " + statement + " END_FUNCTION_BLOCK", diagnostics);
    return diagnostics.all().size();
  };
  EXPECT_EQ(number_of_errors(nested(256)), 0U);
  EXPECT_THAT(in_statements(nested(257)), ElementsAre("121 1:279+1"));
  EXPECT_THAT(in_statements(nested(1000000)), ElementsAre("121 1:279+1"));
  EXPECT_EQ(number_of_errors(chain(256)), 0U);
  EXPECT_THAT(in_statements(chain(257)), ElementsAre("121 1:23+1025"));
  const auto cause = [](const std::string& statement) {
    return parse_wrong("FUNCTION_BLOCK F " + statement + " END_FUNCTION_BLOCK").diagnostics.all().front().cause;
  };
  EXPECT_THAT(cause(chain(257)), HasSubstr("Each operator of a chain such as A + B + C counts as a level"));
  EXPECT_THAT(cause(nested(257)), HasSubstr("nested more than 256 levels deep"));
  std::string functions = "A := ";
  for (int i = 0; i < 100000; ++i) {
    functions += "F(";
  }
  EXPECT_THAT(in_statements(functions), ElementsAre("121 1:535+1"));
}

TEST(SyntaxError, TheListEndsAfterAThousand) {
  const auto found = parse_wrong("FUNCTION_BLOCK F " + std::string(5000, ';') + " END_FUNCTION_BLOCK");
  ASSERT_EQ(found.diagnostics.all().size(), 1001U);
  EXPECT_EQ(found.diagnostics.all().back().number, error::too_many_errors);
  EXPECT_EQ(found.diagnostics.all().back().place.column, 18U + 1000U);
}

TEST(SyntaxError, ColumnsCountCharacters) {
  // A tab is one character, a byte order mark none, and the letters of a comment one each, however many bytes.
  EXPECT_THAT(errors("\xEF\xBB\xBF"
                     "FUNCTION_BLOCK F\n\t\tA = B;\nEND_FUNCTION_BLOCK"),
              ElementsAre("102 2:5+1"));
  EXPECT_THAT(errors("\xEF\xBB\xBF"
                     "FUNCTION_BLOCK F A = B; END_FUNCTION_BLOCK"),
              ElementsAre("102 1:20+1"));
  EXPECT_THAT(
      errors("FUNCTION_BLOCK F\r\n(* \xC2\xB5m \xE2\x86\x92 \xF0\x9F\x99\x82 *) A = B;\r\nC D;\r\nEND_FUNCTION_BLOCK"),
      ElementsAre("102 2:16+1", "102 3:3+1"));
  EXPECT_THAT(errors("FUNCTION_BLOCK F\r\nA := B\r\nEND_FUNCTION_BLOCK"), ElementsAre("103 2:7+1"));
}

TEST(SyntaxError, WhatIsRightBesideAnErrorIsRead) {
  const auto found = parse_wrong(
      "FUNCTION_BLOCK F\nVAR A, : LREAL; B : LREAL; END_VAR\nX := ; Y := B;\nZ(P := );\nU := 1.0\nV := "
      "2.0;\nEND_FUNCTION_BLOCK\n"
      "FUNCTION_BLOCK G\nY := B;\nEND_FUNCTION_BLOCK");
  EXPECT_EQ(found.diagnostics.all().size(), 4U);
  EXPECT_EQ(Dump(found.file).whole(), "block F\nlocal B : LREAL\nY := B\nU := 1r\nV := 2r\nblock G\nY := B\n");
}

TEST(SyntaxError, AFileThatCannotBeRead) {
  Diagnostics diagnostics;
  const auto file = language::parse_file("/nowhere/at_all.st", diagnostics);
  EXPECT_FALSE(file.valid);
  EXPECT_TRUE(file.blocks.empty());
  ASSERT_EQ(diagnostics.all().size(), 1U);
  EXPECT_EQ(diagnostics.all()[0].number, error::unreadable_file);
  EXPECT_EQ(diagnostics.all()[0].place.file, "/nowhere/at_all.st");
  EXPECT_EQ(language::format(file), "");
}

}  // namespace
}  // namespace hysteron::test
