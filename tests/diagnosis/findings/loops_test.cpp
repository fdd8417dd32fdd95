// Over which input an output is drawn: through a hysteresis or a play, by the families of the blocks' effects.
#include "diagnosis/findings/loops.hpp"

#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "codegen/compile.hpp"
#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// Y through a block of U plus a lag of F; Z through the lag alone.
Program with_block(const std::string& type) {
  return compile_text(
      "FUNCTION_BLOCK ONE (* @ts 5ms *) VAR_INPUT F : LREAL; U : LREAL; END_VAR VAR_OUTPUT Y : LREAL; Z : LREAL; "
      "END_VAR "
      "VAR L : HY_LAG; A : " +
      type + "; END_VAR L(XIN := F); A(XIN := U); Y := A.XOUT + L.XOUT; Z := L.XOUT; END_FUNCTION_BLOCK");
}

TEST(Loops, AreThoseOfAHysteresisAndOfAPlay) {
  for (const char* type : {"HY_HYSTERESIS_RO", "HY_HYSTERESIS_GENERAL", "HY_BACKLASH"}) {
    const Program program = with_block(type);
    EXPECT_THAT(inputs_of_loop(program.graph, "Y"), ElementsAre("U")) << type;
    EXPECT_THAT(inputs_of_loop(program.graph, "Z"), IsEmpty()) << type;
    EXPECT_THAT(inputs_of(program.graph, "Y"), ElementsAre("F", "U")) << type;
  }
  for (const char* type : {"HY_GAIN", "HY_LAG", "HY_COULOMB_FRICTION"}) {
    EXPECT_THAT(inputs_of_loop(with_block(type).graph, "Y"), IsEmpty()) << type;
  }
}

TEST(Loops, AreFoundAroundALoopOfTheDiagram) {
  const Program program = compile_text(
      "FUNCTION_BLOCK ONE (* @ts 5ms *) VAR_INPUT R : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR VAR H : "
      "HY_HYSTERESIS_RO; D : HY_DELAY; END_VAR H(XIN := R - D.XOUT); Y := H.XOUT; D(XIN := H.XOUT); "
      "END_FUNCTION_BLOCK");
  EXPECT_THAT(inputs_of_loop(program.graph, "Y"), ElementsAre("R"));
}

class DrawnOver : public testing::Test {
 protected:
  std::vector<Trace> drawn(const Program& program, const Evidence& evidence = {}) {
    std::vector<Trace> traces{{.record = task_.records[0].file(), .signal = "Y"}};
    draw_over_inputs(task_, program.graph, evidence, traces);
    return traces;
  }
  static Task task_with(const std::string& input, std::vector<double> values) {
    Task task;
    task.records = {test::record_of(input, std::move(values))};
    task.records[0].add({.name = "Y", .values = std::vector<double>(task.records[0].size(), 0.0)});
    return task;
  }
  Task task_ = task_with("U", {0.0, 1.0, 2.0, 1.0});
};

TEST_F(DrawnOver, TheInputThatMoves) {
  const std::vector<Trace> traces = drawn(with_block("HY_BACKLASH"));
  EXPECT_EQ(traces[0].over.name, "U");
  EXPECT_THAT(traces[0].over.values, ElementsAre(0.0, 1.0, 2.0, 1.0));
  task_ = task_with("U", {1.0, 1.0, 1.0});
  EXPECT_EQ(drawn(with_block("HY_BACKLASH"))[0].over.name, "") << "nothing moves";
  task_ = task_with("F", {0.0, 1.0, 2.0});
  EXPECT_EQ(drawn(with_block("HY_BACKLASH"))[0].over.name, "") << "U has no column";
}

TEST_F(DrawnOver, AnyInputWhereTheEvidenceTellsOfAHysteresis) {
  const Program plain = with_block("HY_GAIN");
  EXPECT_EQ(drawn(plain)[0].over.name, "");
  Evidence evidence;
  evidence.families = {{.family = "play"}};
  evidence.is_told = true;
  EXPECT_EQ(drawn(plain, evidence)[0].over.name, "U");
  evidence.families = {{.family = "dry_friction"}};
  EXPECT_EQ(drawn(plain, evidence)[0].over.name, "");
}

}  // namespace
}  // namespace hysteron::diagnosis
