// Inner signals that the log holds too: the diagram is cut there, and says on which side the gap lies.
#include "diagnosis/findings/inner_signals.hpp"

#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// The record of a stack with an effect, with the amplifier's output under the name that the log gives it.
records::Record log_of(const test::Effect& effect, const std::string& column) {
  std::string machine = test::stack(effect);
  const std::string outputs = "VAR_OUTPUT Y : LREAL;";
  machine.replace(machine.find(outputs), outputs.size(), "VAR_OUTPUT INNER : LREAL; Y : LREAL;");
  const std::string end = "END_FUNCTION_BLOCK";
  machine.replace(machine.find(end), end.size(), "  INNER := AMP.XOUT;\n" + end);
  const records::Record simulated =
      test::measured(test::program_of(machine), test::record_of("U", test::rich_voltage()), 0.01);
  records::Record log = records::Record::even(0.0, simulated.sample_time(), simulated.size());
  for (records::Column one : simulated.columns()) {
    one.name = one.name == "INNER" ? column : one.name;
    log.add(std::move(one));
  }
  return log;
}

Diagnosis diagnosed(const test::Effect& effect, std::vector<std::string> tried) {
  return diagnose(test::input_of(test::stack(), test::stack_parameters, {log_of(effect, "Amp.xout")}),
                  {.effects = std::move(tried)});
}

TEST(InnerSignals, BecomeOutputsOfTheText) {
  const DiagnosisInput input = test::input_of(test::stack(), test::stack_parameters, {log_of({}, "AMP.XOUT")});
  std::vector<std::string> signals;
  const DiagnosisInput cut = with_inner_signals(input, signals);
  EXPECT_THAT(signals, ElementsAre("AMP_XOUT_MEASURED"));
  EXPECT_THAT(cut.text, HasSubstr("AMP_XOUT_MEASURED := AMP.XOUT;"));
  EXPECT_EQ(cut.program.graph.outputs.back().name, "AMP_XOUT_MEASURED");
  EXPECT_NE(cut.records.front().find("AMP_XOUT_MEASURED"), nullptr);
  EXPECT_EQ(cut.records.front().find("AMP.XOUT"), nullptr);
  // What a diagnosis has written is diagnosed again with the same log.
  DiagnosisInput again = input;
  again.text = cut.text;
  again.program = cut.program;
  std::vector<std::string> same;
  EXPECT_EQ(with_inner_signals(again, same).text, cut.text);
  EXPECT_EQ(same, signals);
}

TEST(InnerSignals, OtherColumnsStayAsTheyAre) {
  const DiagnosisInput input = test::input_of(test::stack(), test::stack_parameters, {log_of({}, "TEMPERATURE")});
  std::vector<std::string> signals;
  EXPECT_EQ(with_inner_signals(input, signals).text, input.text);
  EXPECT_THAT(signals, IsEmpty());
}

TEST(InnerSignals, AColumnThatCutsNowhereIsRemarked) {
  const auto remarks = [](const std::string& column) {
    return unmatched_columns(test::input_of(test::stack(), test::stack_parameters, {log_of({}, column)}));
  };
  EXPECT_THAT(remarks("AMP.OUT"), ElementsAre(testing::AllOf(HasSubstr("AMP.OUT is no signal of STACK"),
                                                             HasSubstr("did you mean AMP.XOUT?"))));
  EXPECT_THAT(remarks("PUMP.FLOW"), ElementsAre(HasSubstr("PUMP.FLOW is no signal of STACK and is left aside.")));
  EXPECT_THAT(remarks("amp.xout"), IsEmpty());
  EXPECT_THAT(remarks("TEMPERATURE"), IsEmpty()) << "it may be a disturbance";
}

TEST(InnerSignals, JoinTheOutputsThatTheParameterFileLists) {
  DiagnosisInput input = test::input_of(
      test::stack(), std::string(test::stack_parameters) + "[tune]\noutputs = [\"Y\"]\n", {log_of({}, "AMP.XOUT")});
  std::vector<std::string> signals;
  EXPECT_EQ(with_inner_signals(input, signals).file.tune.outputs.size(), 2U);
}

TEST(InnerSignals, AnEffectBehindTheCutLeavesItInAgreement) {
  const Diagnosis found = diagnosed({"HY_CREEP := (GAIN := 0.05)", "HYST.XOUT"}, {"creep", "lag", "delay"});
  ASSERT_EQ(found.cuts.size(), 1U);
  EXPECT_EQ(found.cuts.front().signal, "AMP_XOUT_MEASURED");
  EXPECT_TRUE(found.cuts.front().agrees);
  ASSERT_FALSE(found.effects.empty());
  EXPECT_EQ(found.effects.front().id, "creep");
  EXPECT_EQ(found.effects.front().edge, "HYST.XOUT");
}

TEST(InnerSignals, AnEffectBeforeTheCutDoesNot) {
  const Diagnosis found = diagnosed({"HY_DEAD_TIME := (DEAD_TIME := 0.03)", "U"}, {"delay", "creep"});
  ASSERT_EQ(found.cuts.size(), 1U);
  EXPECT_FALSE(found.cuts.front().agrees);
}

TEST(InnerSignals, TellADelayBeforeTheChainFromOneBehindIt) {
  // From U and Y alone they are the same; with the amplifier's output each has one place.
  for (const std::string edge : {"U", "HYST.XOUT"}) {
    const Diagnosis found = diagnosed({"HY_DEAD_TIME := (DEAD_TIME := 0.03)", edge}, {"delay"});
    ASSERT_EQ(found.effects.size(), 1U) << edge;
    EXPECT_EQ(found.effects.front().id, "delay");
    EXPECT_EQ(found.effects.front().edge, edge);
    for (const std::string& same : found.effects.front().same_edges) {
      EXPECT_NE(same, edge == "U" ? "HYST.XOUT" : "U");
    }
  }
}

}  // namespace
}  // namespace hysteron::diagnosis
