// Diagrams of as many instances as wanted: groups of five in a chain, each group with a feedback through its delay.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>

namespace hysteron::bench {

/// Five blocks: their declarations and their calls; {0} is the group's number, {1} what it gets.
struct Group {
  std::string_view declarations;
  std::string_view calls;
  std::string_view output;
};

/// Some operations each.
inline constexpr Group plain{.declarations = R"(    GAIN{0} : HY_GAIN := (K := 0.9);
    LIMIT{0} : HY_LIMIT;
    LAG{0} : HY_LAG := (T1 := 0.01);
    LEAD{0} : HY_LEAD_LAG;
    HOLD{0} : HY_DELAY;
)",
                             .calls = R"(  GAIN{0}(XIN := {1} - 0.25 * HOLD{0}.XOUT);
  LIMIT{0}(XIN := GAIN{0}.XOUT);
  LAG{0}(XIN := LIMIT{0}.XOUT);
  LEAD{0}(XIN := LAG{0}.XOUT);
  HOLD{0}(XIN := LEAD{0}.XOUT);
)",
                             .output = "LEAD{0}.XOUT"};

/// A fifth of the blocks has fifty operations.
inline constexpr Group with_hysteresis{.declarations = R"(    GAIN{0} : HY_GAIN := (K := 0.9);
    LAG{0} : HY_LAG := (T1 := 0.01);
    HYST{0} : HY_HYSTERESIS_RO := (C1 := 0.5, C2 := 0.1, C3 := 0.7);
    BRANCH{0} : HY_BRANCH;
    HOLD{0} : HY_DELAY;
)",
                                       .calls = R"(  GAIN{0}(XIN := {1} - 0.25 * HOLD{0}.XOUT);
  LAG{0}(XIN := GAIN{0}.XOUT);
  BRANCH{0}(XIN := LAG{0}.XOUT);
  HYST{0}(XIN := LAG{0}.XOUT, R1 := BRANCH{0}.Q);
  HOLD{0}(XIN := HYST{0}.XOUT);
)",
                                       .output = "HYST{0}.XOUT"};

inline std::string many_instances(int instances, const Group& group = with_hysteresis) {
  std::string declarations;
  std::string calls;
  std::string input = "X";
  for (int number = 0; number < instances / 5; ++number) {
    declarations += fmt::format(fmt::runtime(group.declarations), number);
    calls += fmt::format(fmt::runtime(group.calls), number, input);
    input = fmt::format(fmt::runtime(group.output), number);
  }
  return "FUNCTION_BLOCK MANY (* @ts 1ms *)\n  VAR_INPUT\n    X : LREAL;\n  END_VAR\n  VAR_OUTPUT\n    Y : LREAL;\n  "
         "END_VAR\n"
         "  VAR\n" +
         declarations + "  END_VAR\n\n" + calls + "  Y := " + input + ";\nEND_FUNCTION_BLOCK\n";
}

}  // namespace hysteron::bench
