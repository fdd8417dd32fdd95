// Errors in sequential bodies: what is said of what was written.
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "codegen/compile.hpp"
#include "support/errors.hpp"

namespace hysteron::testing {
namespace {

TEST(BodyErrors, NameWhatThereIsInstead) {
  const auto first = [](const std::string& statement, const std::string& locals = "") {
    Diagnostics found;
    check(
        std::make_shared<const language::SourceFile>(language::parse(
            "t",
            "TYPE P : STRUCT KP : REAL; TI : TIME; END_STRUCT; END_TYPE FUNCTION_BLOCK G VAR_INPUT SPEED, LOAD : REAL; "
            "END_VAR VAR_OUTPUT OUT : REAL; END_VAR VAR HID : REAL; END_VAR OUT := SPEED; HID := LOAD; "
            "END_FUNCTION_BLOCK FUNCTION_BLOCK F (* @ts 1ms @body *) VAR_INPUT X : LREAL; N : INT; D : TIME; END_VAR "
            "VAR_OUTPUT Y : DINT; R : REAL; E : TIME; END_VAR VAR M : G; PAR : P; A : ARRAY[1..3] OF INT; W : BYTE; " +
                locals + " END_VAR\n" + statement + " END_FUNCTION_BLOCK",
            found)),
        found);
    for (const Diagnostic& one : found.all()) {
      if (one.place.line == 2 || !locals.empty()) {
        return one.cause + " / " + one.mend;
      }
    }
    return std::string();
  };
  EXPECT_EQ(first("M(SPED := 1.0);"), "'M' has no input 'SPED' / Did you mean SPEED?");
  EXPECT_EQ(
      first("M(1.0);"),
      "this argument does not say which input of 'M' it is for / Write NAME := before it. There are SPEED, LOAD, OUT.");
  EXPECT_EQ(first("M(OTU => R);"), "'M' has no output 'OTU' / Did you mean OUT?");
  EXPECT_EQ(first("PAR.KI := 1.0;"), "'PAR' has no member 'KI' / There are KP, TI.");
  EXPECT_EQ(first("A[4] := 1;"), "the index 4 lies outside of 1..3 / 'A' has the elements 1 to 3.");
  EXPECT_EQ(first("A[X] := 1;"),
            "this index is LREAL, no whole number / Index by an INT or a DINT: LREAL_TO_DINT( … ).");
  EXPECT_EQ(first("Y := INT#40000;"), "INT# does not hold 40000 / It holds whole numbers from -32768 to 32767.");
  EXPECT_EQ(first("W.9 := TRUE;"), "'W' has no bit 9 / It is BYTE, with the bits 0 to 7.");
  EXPECT_EQ(first("R := LIMIT(MN := 0.0, IN := R, MAX := 1.0);"),
            "LIMIT has no 'MAX' among 3 arguments / Its arguments are MN, IN, MX.");
  EXPECT_EQ(first("E := D + 5;"), "+ does not take TIME and DINT / Write the number with its unit: T#5s, or T#5ms.");
  EXPECT_EQ(
      first("E := DINT_TO_TIME(Y);"),
      "DINT_TO_TIME counts in milliseconds here, as in CODESYS, TwinCAT and SIMATIC; MATIEC counts seconds / Write "
      "T#1ms * ( … ), which means the same everywhere.");
  EXPECT_EQ(first("Y := 1;", "B : ARRAY[5..2] OF INT;"),
            "the upper bound of this array, 2, is below the lower one, 5 / Write the lower one first: 2..5.");
  EXPECT_EQ(
      first("Y := 1;", "B : ULINT;"),
      "A body has no ULINT: its numbers have 32 bits, or are LREAL. / Use UDINT; above 4294967295 an LREAL, which "
      "has every whole number up to 9007199254740992.");
  EXPECT_EQ(
      first("Y := LINT_TO_DINT(Y);"),
      "LINT_TO_DINT: a body has no LINT / Use DINT; above 2147483647 an LREAL, which has every whole number up to "
      "9007199254740992.");
  EXPECT_EQ(first("Y := LINT#5;"),
            "LINT# is no type of a body / Use DINT; above 2147483647 an LREAL, which has every whole number up to "
            "9007199254740992.");
}

/// By the standard methods stand before the body: what is behind them is read as the body.
TEST(BodyErrors, ABodyBehindMethodsIsRead) {
  Diagnostics found;
  check(std::make_shared<const language::SourceFile>(
            language::parse("t",
                            "FUNCTION_BLOCK F (* @ts 1ms *) VAR_INPUT X : REAL; END_VAR VAR_OUTPUT Y : REAL; END_VAR\n"
                            "METHOD M : BOOL END_METHOD\nIF X > 0.0 THEN Y := X; END_IF;\nY := Z;\nEND_FUNCTION_BLOCK",
                            found)),
        found);
  ASSERT_EQ(found.all().size(), 2U);
  EXPECT_EQ(found.all()[0].number, error::refused_in_body);
  EXPECT_EQ(found.all()[0].place.line, 2U);
  EXPECT_EQ(found.all()[1].place.line, 4U) << "Z is not declared";
}

}  // namespace
}  // namespace hysteron::testing
