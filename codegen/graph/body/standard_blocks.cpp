#include "codegen/graph/body/standard_blocks.hpp"

#include <memory>
#include <string>

#include "codegen/language/syntax.hpp"

namespace hysteron::bodies {
namespace {

constexpr const char* text = R"(
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

}  // namespace

const language::body::Library& standard_blocks() {
  static const language::SourceFile source = [] {
    Diagnostics none;
    return language::parse("the blocks of the standard", text, none);
  }();
  return *source.bodies;
}

}  // namespace hysteron::bodies
