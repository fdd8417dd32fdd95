// A diagram of as many instances as wanted: groups of five in a chain, each group with a feedback through its delay.
#pragma once

#include <string>

namespace hysteron::bench {

inline std::string many_instances(int instances) {
  std::string declarations;
  std::string statements;
  std::string input = "X";
  for (int group = 0; group < instances / 5; ++group) {
    const std::string n = std::to_string(group);
    declarations += "    GAIN" + n + " : HY_GAIN := (K := 0.9);\n    LAG" + n + " : HY_LAG := (T1 := 0.01);\n    HYST" +
                    n + " : HY_HYSTERESIS_RO := (C1 := 0.5, C2 := 0.1, C3 := 0.7);\n    BRANCH" + n +
                    " : HY_BRANCH;\n    HOLD" + n + " : HY_DELAY;\n";
    statements += "  GAIN" + n + "(XIN := " + input + " - 0.25 * HOLD" + n + ".XOUT);\n";
    statements += "  LAG" + n + "(XIN := GAIN" + n + ".XOUT);\n";
    statements += "  BRANCH" + n + "(XIN := LAG" + n + ".XOUT);\n";
    statements += "  HYST" + n + "(XIN := LAG" + n + ".XOUT, R1 := BRANCH" + n + ".Q);\n";
    statements += "  HOLD" + n + "(XIN := HYST" + n + ".XOUT);\n";
    input = "HYST" + n + ".XOUT";
  }
  return "FUNCTION_BLOCK MANY (* @ts 1ms *)\n  VAR_INPUT\n    X : LREAL;\n  END_VAR\n  VAR_OUTPUT\n    Y : LREAL;\n  "
         "END_VAR\n"
         "  VAR\n" +
         declarations + "  END_VAR\n\n" + statements + "  Y := " + input + ";\nEND_FUNCTION_BLOCK\n";
}

}  // namespace hysteron::bench
