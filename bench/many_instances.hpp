// A diagram of as many instances as wanted: groups of five in a chain, each group with a feedback through its delay.
#pragma once

#include <fmt/format.h>

#include <string>

namespace hysteron::bench {

inline std::string many_instances(int instances) {
  std::string declarations;
  std::string statements;
  std::string input = "X";
  for (int group = 0; group < instances / 5; ++group) {
    declarations += fmt::format(R"(    GAIN{0} : HY_GAIN := (K := 0.9);
    LAG{0} : HY_LAG := (T1 := 0.01);
    HYST{0} : HY_HYSTERESIS_RO := (C1 := 0.5, C2 := 0.1, C3 := 0.7);
    BRANCH{0} : HY_BRANCH;
    HOLD{0} : HY_DELAY;
)",
                                group);
    statements += fmt::format(R"(  GAIN{0}(XIN := {1} - 0.25 * HOLD{0}.XOUT);
  LAG{0}(XIN := GAIN{0}.XOUT);
  BRANCH{0}(XIN := LAG{0}.XOUT);
  HYST{0}(XIN := LAG{0}.XOUT, R1 := BRANCH{0}.Q);
  HOLD{0}(XIN := HYST{0}.XOUT);
)",
                              group, input);
    input = fmt::format("HYST{}.XOUT", group);
  }
  return "FUNCTION_BLOCK MANY (* @ts 1ms *)\n  VAR_INPUT\n    X : LREAL;\n  END_VAR\n  VAR_OUTPUT\n    Y : LREAL;\n  "
         "END_VAR\n"
         "  VAR\n" +
         declarations + "  END_VAR\n\n" + statements + "  Y := " + input + ";\nEND_FUNCTION_BLOCK\n";
}

}  // namespace hysteron::bench
