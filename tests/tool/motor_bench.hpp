// A folder with the FMU of the tests, a diagram that has it, and a record that drives it.
#pragma once

#include <string_view>

#include "tests/tool/fmu_model.hpp"
#include "tests/tool/workbench.hpp"

namespace hysteron::test {

inline constexpr std::string_view motor_loop = R"(FUNCTION_BLOCK LOOP  (* @ts 1ms *)
  VAR_INPUT
    U : LREAL;
    N : DINT := 0;
    GAIN : LREAL := 2.0;  (* @param @min 0.0 @max 100.0 *)
  END_VAR
  VAR_OUTPUT
    Y : LREAL;
    COUNT : DINT;
    BUSY : BOOL;
  END_VAR
  VAR
    PLANT : HY_FMU;  (* @file motor.fmu *)
  END_VAR

  Y := PLANT.Y;
  COUNT := PLANT.MOTOR_COUNT;
  BUSY := PLANT.ON_NOW;
  PLANT(U := U, MOTOR_N := N, ON_1 := U > 0.5, GAIN := GAIN);
END_FUNCTION_BLOCK
)";

inline constexpr std::string_view motor_log = "t,u,n\n0.000,1.0,0\n0.001,1.0,3\n0.002,0.25,0\n0.003,0.5,0\n";

/// A folder with the FMU of the tests, a diagram of it and a record.
struct MotorBench : Workbench {
  MotorBench() {
    write_motor(path() / "motor.fmu");
    write("loop.st", motor_loop);
    write("log.csv", motor_log);
  }
};

}  // namespace hysteron::test
