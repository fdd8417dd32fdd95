// Inner signals of a served diagram, and the picture that shows them.
#include "tool/live_diagram.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tool/serve_program.hpp"

namespace hysteron {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

constexpr const char* drawn_plant = R"(FUNCTION_BLOCK PLANT  (* @ts 1ms *)
  VAR_INPUT
    X : LREAL := 1.0;  (* @unit V *)
    OFF : BOOL;
  END_VAR
  VAR_OUTPUT
    Y : LREAL;  (* @unit um *)
    SLOW : LREAL;  (* @unit um *)
    UP : BOOL;
  END_VAR
  VAR
    WAVE : HY_SINE := (AMPLITUDE := 3.0, FREQUENCY := 7.0);
    HYST : HY_HYSTERESIS_RO := (C1 := 1.5, C2 := 0.1, C3 := 0.7);
    BRANCH : HY_BRANCH;
    AT4 : HY_SAMPLE;  (* @every 4 *)
    BACK : HY_HOLD;
  END_VAR

  HYST(XIN := X * WAVE.XOUT);
  BRANCH(XIN := X);
  AT4(XIN := HYST.XOUT);
  BACK(XIN := AT4.XOUT);
  Y := HYST.XOUT;
  SLOW := BACK.XOUT;
  UP := BRANCH.Q AND NOT OFF;
  WAVE();
END_FUNCTION_BLOCK
)";

std::vector<std::string> names_of(const std::vector<tool::InnerSignal>& signals) {
  std::vector<std::string> names;
  for (const tool::InnerSignal& one : signals) {
    names.push_back(one.name);
  }
  std::ranges::sort(names);
  return names;
}

TEST(InnerSignals, AreWhatBlocksAndExpressionsGiveInEveryStep) {
  const Program program = compile_text(drawn_plant);
  const auto signals = tool::inner_signals(program);
  EXPECT_THAT(names_of(signals), ElementsAre("BACK.XOUT", "BRANCH.Q", "HYST.XIN", "HYST.XOUT", "UP", "WAVE.XOUT"));
  for (const tool::InnerSignal& one : signals) {
    EXPECT_EQ(one.type, one.name == "UP" || one.name == "BRANCH.Q" ? Type::Bool : Type::Real) << one.name;
    if (one.name == "HYST.XOUT") {
      EXPECT_EQ(one.unit, "um");
    }
  }
}

TEST(InnerSignals, HaveTheSameBitsByBothEnginesAndChangeNone) {
  const Program program = compile_text(drawn_plant);
  const auto signals = tool::inner_signals(program);
  const auto plain = tool::step_program(program, tool::Engine::compiled, false);
  const auto compiled = tool::step_program(program, tool::Engine::compiled, false, signals);
  const auto interpreted = tool::step_program(program, tool::Engine::interpreter, false, signals);
  EXPECT_EQ(compiled->shape().layout, plain->shape().layout);
  EXPECT_EQ(compiled->state_size(), plain->state_size()) << "a retained state fits with and without the live page";
  ASSERT_EQ(compiled->shape().inner.size(), signals.size());
  std::vector<double> inputs{1.0, 0.0};
  std::vector<std::vector<double>> outputs(3, std::vector<double>(3));
  std::vector<std::vector<double>> inner(2, std::vector<double>(signals.size()));
  bool moved = false;
  for (int k = 0; k < 3000; ++k) {
    inputs[0] = 1.0 + 0.001 * (k % 700);
    plain->step(inputs, outputs[0]);
    compiled->step(inputs, outputs[1]);
    interpreted->step(inputs, outputs[2]);
    ASSERT_EQ(outputs[0], outputs[1]) << k;
    ASSERT_EQ(outputs[0], outputs[2]) << k;
    const std::vector<double> before = inner[0];
    compiled->inner_values(inner[0]);
    interpreted->inner_values(inner[1]);
    ASSERT_EQ(inner[0], inner[1]) << k;
    moved = moved || inner[0] != before;
    const auto hysteresis = std::ranges::find(signals, "HYST.XOUT", &tool::InnerSignal::name) - signals.begin();
    ASSERT_EQ(inner[0][static_cast<std::size_t>(hysteresis)], outputs[0][0]) << "Y := HYST.XOUT";
  }
  EXPECT_TRUE(moved);
}

TEST(LiveDiagram, HasAPlaceForEachValue) {
  const Program program = compile_text(drawn_plant);
  const auto signals = tool::inner_signals(program);
  const std::string svg = tool::live_diagram(program.graph, signals);
  EXPECT_THAT(svg, testing::StartsWith("<svg xmlns=\"http://www.w3.org/2000/svg\""));
  for (const char* const name : {"X", "OFF", "Y", "SLOW", "UP"}) {
    EXPECT_THAT(svg, HasSubstr("data-point=\"" + std::string(name) + "\""));
  }
  for (std::size_t i = 0; i < signals.size(); ++i) {
    EXPECT_THAT(svg, HasSubstr("data-inner=\"" + std::to_string(i) + "\"")) << signals[i].name;
  }
  EXPECT_THAT(svg, Not(HasSubstr("style="))) << "the page's policy would block it";
  EXPECT_EQ(tool::live_diagram(compile_text("FUNCTION_BLOCK E (* @ts 1ms *)\n  VAR_OUTPUT Y : LREAL; END_VAR\n  Y := "
                                            "1.0;\nEND_FUNCTION_BLOCK\n")
                                   .graph,
                               {}),
            "");
}

}  // namespace
}  // namespace hysteron
