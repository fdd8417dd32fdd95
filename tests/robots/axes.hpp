// Axes whose joints are known by hand.
#pragma once

#include <string>

#include "codegen/compile.hpp"
#include "codegen/parameters/apply.hpp"
#include "robots/joint.hpp"

namespace hysteron::robots {

/// J = 2e-4 kg·m², KT = 0.05 N·m/A behind a current of ±4 A, 0.004 N·m dry, 0.0006 N·m·s/rad viscous.
inline constexpr const char* servo = R"(FUNCTION_BLOCK AXIS  (* @ts 1ms *)
  VAR_INPUT
    I : LREAL;  (* @unit A *)
  END_VAR
  VAR_OUTPUT
    OMEGA : LREAL;  (* @unit rad/s *)
  END_VAR
  VAR
    MOST    : HY_LIMIT            := (MN := -4.0, MX := 4.0);
    KT      : HY_GAIN             := (K := 0.05);
    TORQUE  : LREAL;  (* @unit N*m *)
    DRY     : HY_COULOMB_FRICTION := (LEVEL := 0.004, PRESLIDE := 0.00001);
    B       : HY_GAIN             := (K := 0.0006);
    INERTIA : HY_GAIN             := (K := 5000.0);
    SPEED   : HY_INTEGRAL_FORWARD;
    TACHO   : HY_QUANTIZER        := (QUANTUM := 0.01);
  END_VAR

  MOST(XIN := I);
  KT(XIN := MOST.XOUT);
  TORQUE := KT.XOUT;
  B(XIN := SPEED.XOUT);
  DRY(XIN := TORQUE, V := SPEED.XOUT);
  INERTIA(XIN := DRY.XOUT - B.XOUT);
  TACHO(XIN := SPEED.XOUT);
  OMEGA := TACHO.XOUT;
  SPEED(XIN := INERTIA.XOUT);
END_FUNCTION_BLOCK
)";

/// A table on a spring: 3 kg, 40 N·s/m, 200 N/m about 5 mm, in mm and mm/s; a lag of 10 ms before a force of ±20 N.
inline constexpr const char* table = R"(FUNCTION_BLOCK TABLE  (* @ts 1ms *)
  VAR_INPUT
    U : LREAL;  (* @unit V @min -5 @max 5 *)
  END_VAR
  VAR_OUTPUT
    X : LREAL;  (* @unit mm *)
  END_VAR
  VAR
    AMP    : HY_LAG   := (T1 := 0.01);
    FORCE  : HY_GAIN  := (K := 8.0);
    MOST   : HY_LIMIT := (MN := -20.0, MX := 20.0);
    F      : LREAL;  (* @unit N *)
    V      : LREAL;  (* @unit mm/s *)
    DAMPER : HY_GAIN   := (K := 0.04);
    ORIGIN : HY_OFFSET := (BIAS := -5.0);
    SPRING : HY_GAIN   := (K := 0.2);
    MASS   : HY_GAIN   := (K := 333.33333333333333);
    SPEED  : HY_INTEGRAL_FORWARD;
    PLACE  : HY_INTEGRAL_FORWARD_BOUNDED := (MN := -30.0, MX := 50.0);
  END_VAR

  AMP(XIN := U);
  FORCE(XIN := AMP.XOUT);
  MOST(XIN := FORCE.XOUT);
  F := MOST.XOUT;
  V := SPEED.XOUT;
  X := PLACE.XOUT;
  PLACE(XIN := SPEED.XOUT);
  DAMPER(XIN := V);
  ORIGIN(XIN := X);
  SPRING(XIN := ORIGIN.XOUT);
  MASS(XIN := F - DAMPER.XOUT - SPRING.XOUT);
  SPEED(XIN := MASS.XOUT);
END_FUNCTION_BLOCK
)";

inline Program program_of(const std::string& text) {
  return compile_text(text, {.keep_names = true});
}
inline Joint joint_of_text(const std::string& text, const JointOptions& options = {}) {
  return joint_of(program_of(text), options);
}
/// The text with one of its parts exchanged.
inline std::string with(std::string text, const std::string& part, const std::string& other) {
  return text.replace(text.find(part), part.size(), other);
}

/// What is left out, a line each.
inline std::string all_of(const std::vector<Neglected>& list) {
  std::string text;
  for (const Neglected& one : list) {
    text += one.what + "; " + one.size + "; " + one.why + "\n";
  }
  return text;
}

}  // namespace hysteron::robots
