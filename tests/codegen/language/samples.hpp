// Diagrams that use every form of the language, for tests of round trips and mutations.
#pragma once

#include <array>
#include <string_view>

namespace hysteron::test {

inline constexpr std::array<std::string_view, 6> sample_diagrams{
    // The shortest.
    "FUNCTION_BLOCK F END_FUNCTION_BLOCK",
    // The feedforward of a piezo actuator, as one might type it.
    R"(FUNCTION_BLOCK PIEZO_FF                          (* @ts 50us *)
  VAR_INPUT   Y_REF : LREAL;  (* @unit um *)  RESET : BOOL;  END_VAR
  VAR_OUTPUT  U     : LREAL;  (* @unit V  *)                 END_VAR
  VAR  RATE : HY_DERIVATIVE;  BRANCH : HY_BRANCH;  P : HY_MOMENTUM;  INV : HY_M_INVERSE;  SUM : HY_INTEGRAL;  HOLD : HY_DELAY;  END_VAR
  RATE(XIN := Y_REF);
  BRANCH(XIN := RATE.XOUT);
  INV(XIN := RATE.XOUT, P := HOLD.XOUT, R1 := BRANCH.Q);
  P(XIN := INV.XOUT, R1 := BRANCH.Q OR RESET);
  SUM(XIN := INV.XOUT, R1 := RESET);
  HOLD(XIN := P.XOUT);
  U := SUM.XOUT;
END_FUNCTION_BLOCK
)",
    // Comments everywhere, blank lines, settings, arrays, constants, lists of names.
    R"((* head of the file *)

(* a second comment,
     on two lines *)
function_block Outer (* @ts 1ms *) (* @doc what it is for *)
  (* @top *)
  var_input (* what comes in *)
    A,B : lreal := 1.0e-3; (* @unit um @min -1.0 @max 40 *) (* more *)


    (* about C *)
    C (* in progress @unit 1 *) : BOOL := TRUE;
  end_var (* behind the inputs *)
  VAR_OUTPUT Y : LREAL; (* @doc a long word
       on two lines *) Z : DINT := 16#FF; END_VAR
  VAR CONSTANT N : DINT := -2147483648; W : WORD := WORD#16#00_FF; K : LREAL := LREAL#-1.5; END_VAR
  VAR END_VAR
  VAR T : HY_TABLE := (X := [0.0, 1.0, 2.0], Y := [0.0, -1.5e-3, 1_000.0]); I : Inner; END_VAR
  (* above the first call *)
  I(A := A * (B + 2.0) ** 2.0 - -B, (* inside *) B := NOT C & TRUE); (* beside it *)

  (* above the second *)
  (* twice *)
  T(XIN := LIMIT(MN := 0.0, IN := I.Y, MX := MAX(A, B, 1.0)));



  Y := T.XOUT; Z := (N + 3) MOD 8#17 / 2#1010;
  (* at the end *)
END_FUNCTION_BLOCK (* of Outer *)
FUNCTION_BLOCK Inner
VAR_INPUT A : LREAL; B : BOOL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR
Y := SEL(B = FALSE XOR A >= 1.0 OR A <> 2.0 AND NOT (A < 3.0), A, -A);
END_FUNCTION_BLOCK

(* tail *)
)",
    // Statements and declarations that are too long for a line.
    R"(FUNCTION_BLOCK LONG
  VAR A_VERY_LONG_NAME_THAT_PUSHES_ALL_OTHERS_ASIDE, ANOTHER_VERY_LONG_NAME_THAT_PUSHES_ALL_OTHERS_ASIDE : LREAL; X : LREAL; (* short *)
  CURVE : HY_TABLE := (X := [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 11.0, 12.0, 13.0, 14.0, 15.0, 16.0], Y := [0.0, 1.0]);
  END_VAR
  CURVE(FIRST_PIN_OF_THIS := X + X + X + X + X, SECOND_PIN_OF_THIS := LIMIT(0.0, X, 1.0) * X, THIRD_PIN_OF_THIS := X, FOURTH_PIN := X);
  X := 1.0 + 2.0 * 3.0 + 4.0 * 5.0 + 6.0 * 7.0 + 8.0 * 9.0 + 10.0 * 11.0 + 12.0 * 13.0 + 14.0 * 15.0 + 16.0 * 17.0 + (18.0 - 19.0) / 20.0;
  CURVE(ONE_PIN := MAX(11111111.0, 22222222.0, 33333333.0, 44444444.0, 55555555.0, 66666666.0, 77777777.0, 88888888.0, 99999999.0, 1.0), B := 2.0);
END_FUNCTION_BLOCK
)",
    // Line ends of Windows, and a byte order mark.
    "\xEF\xBB\xBF(* \xC2\xB5m *) FUNCTION_BLOCK F (* one\r\n  two *)\r\nVAR_INPUT\tX : LREAL; (* @unit \xC2\xB5m "
    "*)\r\n\r\n\r\nY : BOOL; END_VAR\r\nX := 1.0;\r\n\r\n\r\n(* \xE2\x86\x92 *)\r\nY := X > 0.0;\r\nEND_FUNCTION_BLOCK",
    // Comments in the oddest places.
    R"(FUNCTION_BLOCK(* a *)F(* b *)VAR(* c *)CONSTANT(* d *)X(* e *),(* f *)Y(* g *):(* h *)LREAL(* i *):=(* j *)-(* k
 *)1.0(* l *);(* m *)END_VAR(* n *)Z(* o *)(*p*)((* q *)A(* r *):=(* s *)((* t *)NOT(* u *)B(* v *).(* w *)C(* x *))(* y *)
)(* z *);(**)END_FUNCTION_BLOCK(* end
of
all *))"};

}  // namespace hysteron::test
