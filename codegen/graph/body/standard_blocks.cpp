#include "codegen/graph/body/standard_blocks.hpp"

#include <memory>
#include <string>

#include "codegen/language/syntax.hpp"

namespace hysteron::bodies {
namespace {

constexpr const char* without_time = R"(
FUNCTION_BLOCK R_TRIG (* @body *)
VAR_INPUT CLK : BOOL; END_VAR
VAR_OUTPUT Q : BOOL; END_VAR
VAR M : BOOL; END_VAR
Q := CLK AND NOT M;
M := CLK;
END_FUNCTION_BLOCK
FUNCTION_BLOCK F_TRIG (* @body *)
VAR_INPUT CLK : BOOL; END_VAR
VAR_OUTPUT Q : BOOL; END_VAR
VAR M : BOOL; END_VAR
Q := NOT CLK AND NOT M;
M := NOT CLK;
END_FUNCTION_BLOCK
FUNCTION_BLOCK SR (* @body *)
VAR_INPUT S1 : BOOL; R : BOOL; END_VAR
VAR_OUTPUT Q1 : BOOL; END_VAR
Q1 := S1 OR (NOT R AND Q1);
END_FUNCTION_BLOCK
FUNCTION_BLOCK RS (* @body *)
VAR_INPUT S : BOOL; R1 : BOOL; END_VAR
VAR_OUTPUT Q1 : BOOL; END_VAR
Q1 := NOT R1 AND (S OR Q1);
END_FUNCTION_BLOCK
FUNCTION_BLOCK CTU
VAR_INPUT CU : BOOL; R : BOOL; PV : INT; END_VAR
VAR_OUTPUT Q : BOOL; CV : INT; END_VAR
VAR M : BOOL; END_VAR
IF R THEN CV := 0;
ELSIF CU AND NOT M AND CV < 32767 THEN CV := CV + 1;
END_IF;
M := CU;
Q := CV >= PV;
END_FUNCTION_BLOCK
FUNCTION_BLOCK CTD
VAR_INPUT CD : BOOL; LD : BOOL; PV : INT; END_VAR
VAR_OUTPUT Q : BOOL; CV : INT; END_VAR
VAR M : BOOL; END_VAR
IF LD THEN CV := PV;
ELSIF CD AND NOT M AND CV > -32768 THEN CV := CV - 1;
END_IF;
M := CD;
Q := CV <= 0;
END_FUNCTION_BLOCK
FUNCTION_BLOCK CTUD
VAR_INPUT CU : BOOL; CD : BOOL; R : BOOL; LD : BOOL; PV : INT; END_VAR
VAR_OUTPUT QU : BOOL; QD : BOOL; CV : INT; END_VAR
VAR MU : BOOL; MD : BOOL; END_VAR
IF R THEN CV := 0;
ELSIF LD THEN CV := PV;
ELSIF NOT (CU AND NOT MU AND CD AND NOT MD) THEN
  IF CU AND NOT MU AND CV < 32767 THEN CV := CV + 1;
  ELSIF CD AND NOT MD AND CV > -32768 THEN CV := CV - 1;
  END_IF;
END_IF;
MU := CU;
MD := CD;
QU := CV >= PV;
QD := CV <= 0;
END_FUNCTION_BLOCK
)";

constexpr const char* by_clock = R"(
FUNCTION_BLOCK TON
VAR_INPUT IN : BOOL; PT : TIME; END_VAR
VAR_OUTPUT Q : BOOL; ET : TIME; END_VAR
VAR RUNS : BOOL; SINCE : UDINT; END_VAR
IF IN THEN
  IF NOT RUNS THEN
    RUNS := TRUE;
    SINCE := CLOCK_STEPS();
  END_IF;
  IF NOT Q THEN
    ET := STEP_TIME() * UDINT_TO_LREAL(CLOCK_STEPS() - SINCE);
    Q := ET + STEP_TIME() * 0.0625 >= PT;
  END_IF;
  IF Q THEN ET := MAX(PT, T#0s); END_IF;
ELSE
  RUNS := FALSE;
  Q := FALSE;
  ET := T#0s;
END_IF;
END_FUNCTION_BLOCK
FUNCTION_BLOCK TOF
VAR_INPUT IN : BOOL; PT : TIME; END_VAR
VAR_OUTPUT Q : BOOL; ET : TIME; END_VAR
VAR RUNS : BOOL; SINCE : UDINT; END_VAR
IF IN THEN
  RUNS := FALSE;
  Q := TRUE;
  ET := T#0s;
ELSE
  IF Q AND NOT RUNS THEN
    RUNS := TRUE;
    SINCE := CLOCK_STEPS();
  END_IF;
  IF Q THEN
    ET := STEP_TIME() * UDINT_TO_LREAL(CLOCK_STEPS() - SINCE);
    Q := ET + STEP_TIME() * 0.0625 < PT;
  END_IF;
  IF RUNS AND NOT Q THEN ET := MAX(PT, T#0s); END_IF;
END_IF;
END_FUNCTION_BLOCK
FUNCTION_BLOCK TP
VAR_INPUT IN : BOOL; PT : TIME; END_VAR
VAR_OUTPUT Q : BOOL; ET : TIME; END_VAR
VAR RUNS : BOOL; OVER : BOOL; SINCE : UDINT; END_VAR
IF IN AND NOT RUNS THEN
  RUNS := TRUE;
  OVER := FALSE;
  SINCE := CLOCK_STEPS();
END_IF;
IF RUNS THEN
  IF NOT OVER THEN
    ET := STEP_TIME() * UDINT_TO_LREAL(CLOCK_STEPS() - SINCE);
    OVER := ET + STEP_TIME() * 0.0625 >= PT;
  END_IF;
  IF OVER THEN ET := MAX(PT, T#0s); END_IF;
  Q := NOT OVER;
  IF OVER AND NOT IN THEN
    RUNS := FALSE;
    ET := T#0s;
  END_IF;
END_IF;
END_FUNCTION_BLOCK
)";

language::SourceFile parsed(const char* text) {
  Diagnostics none;
  return language::parse("the blocks of the standard", text, none);
}

}  // namespace

const language::body::Library& standard_blocks() {
  static const language::SourceFile source = parsed(without_time);
  return *source.bodies;
}

const language::body::Library& timers_by_clock() {
  static const language::SourceFile source = parsed(by_clock);
  return *source.bodies;
}

}  // namespace hysteron::bodies
