// Control loops whose mathematics is known by hand, for the tests of goals.
#pragma once

#include <fmt/format.h>

#include <fstream>
#include <string>
#include <string_view>

#include "codegen/compile.hpp"
#include "codegen/parameters/parameter_file.hpp"
#include "tuning/goal/goal_search.hpp"

namespace hysteron::loops {

inline constexpr double ts = 0.01;  ///< of the integrators, s

/// An integrator, y(k+1) = y(k) + TS·B·u(k), under a proportional controller u = K·(r − y), TS = 0.01 s. The closed
/// loop is the pole 1 − TS·B·K. With further delays of the measurement, `delays`, the open loop is TS·B·K·z⁻ᵈ/(z − 1).
inline std::string integrator(int delays = 0) {
  std::string declared;
  std::string measured = "PLANT.XOUT";
  std::string calls;
  for (int k = 0; k < delays; ++k) {
    declared += fmt::format("    D{} : HY_DELAY;\n", k);
    calls = fmt::format("  D{}(XIN := {});\n", k, measured) + calls;
    measured = fmt::format("D{}.XOUT", k);
  }
  return fmt::format(R"(FUNCTION_BLOCK LOOP  (* @ts 10ms *)
  VAR_INPUT
    SP : LREAL;
  END_VAR
  VAR_OUTPUT
    Y : LREAL;
  END_VAR
  VAR
    P     : HY_GAIN := (K := 1.0);
    BODY  : HY_GAIN := (K := 1.0);
    PLANT : HY_INTEGRAL_FORWARD;
    BESIDE : HY_GAIN;
{}  END_VAR

  BESIDE(XIN := SP);
  P(XIN := SP - {});
  BODY(XIN := P.XOUT);
  Y := PLANT.XOUT;
{}  PLANT(XIN := BODY.XOUT);
END_FUNCTION_BLOCK
)",
                     declared, measured, calls);
}

/// A PID before two lags and a dead time: nothing of it is known by hand.
inline constexpr std::string_view oven = R"(FUNCTION_BLOCK OVEN  (* @ts 50ms *)
  VAR_INPUT
    SP : LREAL;
  END_VAR
  VAR_OUTPUT
    Y : LREAL;
  END_VAR
  VAR
    LAST : HY_DELAY;
    PID  : HY_PID := (KP := 1.0, TR := 2.0, TD := 0.1);
    DEAD : HY_DEAD_TIME := (DEAD_TIME := 0.32);
    BODY : HY_LAG := (T1 := 1.5);
    WALL : HY_LAG := (T1 := 0.4);
  END_VAR

  PID(SP := SP, PV := LAST.XOUT);
  DEAD(XIN := PID.XOUT);
  BODY(XIN := DEAD.XOUT);
  WALL(XIN := BODY.XOUT);
  Y := WALL.XOUT;
  LAST(XIN := Y);
END_FUNCTION_BLOCK
)";

inline GoalProblem problem_of(std::string_view diagram, std::string_view settings) {
  return goal_problem(compile_text(std::string(diagram), {.keep_names = true}),
                      parameters::parse_parameter_file("p.toml", settings), {});
}

inline Eigen::VectorXd start_of(const GoalProblem& problem) {
  Eigen::VectorXd x(std::ssize(problem.parameters));
  for (Eigen::Index j = 0; j < x.size(); ++j) {
    x[j] = problem.parameters[static_cast<std::size_t>(j)].start;
  }
  return x;
}

}  // namespace hysteron::loops
