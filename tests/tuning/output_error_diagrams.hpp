// Diagrams for the tests of the output-error fit: each with the truth that makes its record, and a start away from it.
#pragma once

#include <string_view>

namespace hysteron::output_error_diagrams {

inline constexpr std::string_view hysteresis = R"(FUNCTION_BLOCK STACK (* @ts 10ms *)
  VAR_INPUT U : LREAL; (* @unit V *) END_VAR
  VAR_OUTPUT Y : LREAL; (* @unit um *) END_VAR
  VAR HYST : HY_HYSTERESIS_RO := (C1 := 1.0, START := 1); END_VAR
  HYST(XIN := U);
  Y := HYST.XOUT;
END_FUNCTION_BLOCK
)";
inline constexpr std::string_view hysteresis_truth = "[parameters.HYST]\nC1 = 5.0\nC2 = 4.5\nC3 = 0.8\nY0 = -118.0\n";
inline constexpr std::string_view hysteresis_start =
    "[parameters.HYST]\nC1 = 8.0\nC2 = 2.0\nC3 = 1.2\nY0 = -110.0\n"
    "[fit.HYST]\nC1 = {}\nC2 = {}\nC3 = {}\nY0 = {}\n";

/// A body that is heated: first order towards the ambient temperature.
inline constexpr std::string_view thermal = R"(FUNCTION_BLOCK OVEN (* @ts 1s *)
  VAR_INPUT
    HEAT : LREAL; (* @unit W *)
    AMBIENT : LREAL := 20.0; (* @param @unit K *)
  END_VAR
  VAR_OUTPUT TEMP : LREAL; (* @unit K *) END_VAR
  VAR
    RISE : HY_GAIN;
    BODY : HY_LAG := (T1 := 10.0);
  END_VAR
  RISE(XIN := HEAT);
  BODY(XIN := RISE.XOUT);
  TEMP := BODY.XOUT + AMBIENT;
END_FUNCTION_BLOCK
)";
inline constexpr std::string_view thermal_truth =
    "[parameters]\nAMBIENT = 21.5\n[parameters.RISE]\nK = 0.6\n[parameters.BODY]\nT1 = 35.0\n";
inline constexpr std::string_view thermal_start =
    "[parameters]\nAMBIENT = 25.0\n[parameters.RISE]\nK = 1.0\n[parameters.BODY]\nT1 = 10.0\n"
    "[fit]\nAMBIENT = {}\n[fit.RISE]\nK = {}\n[fit.BODY]\nT1 = {min = 1.0, max = 300.0}\n";

/// A motor with an axis: torque less Coulomb friction, a lag to the speed, its integral, two measured outputs.
inline constexpr std::string_view servo = R"(FUNCTION_BLOCK AXIS (* @ts 2ms *)
  VAR_INPUT
    I : LREAL; (* @unit A *)
    LOAD : LREAL := 0.0; (* @param @unit A *)
  END_VAR
  VAR_OUTPUT
    SPEED : LREAL; (* @unit mm/s *)
    POS : LREAL; (* @unit mm *)
  END_VAR
  VAR
    MOTOR : HY_SECOND_ORDER := (T := 0.02, ZETA := 1.0);
    PATH : HY_INTEGRAL;
  END_VAR
  MOTOR(XIN := I - LOAD);
  PATH(XIN := MOTOR.XOUT);
  SPEED := MOTOR.XOUT;
  POS := PATH.XOUT;
END_FUNCTION_BLOCK
)";
inline constexpr std::string_view servo_truth =
    "[parameters]\nLOAD = 0.2\n[parameters.MOTOR]\nK = 40.0\nT = 0.03\nZETA = 0.6\n";
inline constexpr std::string_view servo_start =
    "[parameters]\nLOAD = 0.0\n[parameters.MOTOR]\nK = 20.0\nT = 0.015\nZETA = 1.0\n"
    "[fit]\nLOAD = {}\n[fit.MOTOR]\nK = {}\nT = {}\nZETA = {}\n";

/// A resonance by its coefficients in s, and a discrete filter behind it.
inline constexpr std::string_view resonance = R"(FUNCTION_BLOCK RESONANCE (* @ts 1ms *)
  VAR_INPUT U : LREAL; END_VAR
  VAR_OUTPUT Y : LREAL; Z : LREAL; END_VAR
  VAR
    G : HY_TRANSFER_FUNCTION_S := (NUM := [1.0], DEN := [0.0002, 0.01, 1.0]);
    F : HY_TRANSFER_FUNCTION := (NUM := [0.3, 0.0], DEN := [1.0, -0.5, 0.0]);
  END_VAR
  G(XIN := U);
  F(XIN := U);
  Y := G.XOUT;
  Z := F.XOUT;
END_FUNCTION_BLOCK
)";
inline constexpr std::string_view resonance_truth =
    "[parameters.G]\nNUM = 1.5\nDEN = [0.0002, 0.006, 1.2]\n"
    "[parameters.F]\nNUM = [0.4, 0.1]\nDEN = [1.0, -0.7, 0.12]\n";
inline constexpr std::string_view resonance_start = "[fit.G]\nNUM = {}\nDEN = {}\n[fit.F]\nNUM = {}\nDEN = {}\n";

/// A lag alone: it takes over its input in the first sample.
inline constexpr std::string_view body = R"(FUNCTION_BLOCK BODY (* @ts 1s *)
  VAR_INPUT X : LREAL; END_VAR
  VAR_OUTPUT Y : LREAL; END_VAR
  VAR L : HY_LAG := (T1 := 20.0); END_VAR
  L(XIN := X);
  Y := L.XOUT;
END_FUNCTION_BLOCK
)";

}  // namespace hysteron::output_error_diagrams
