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
  EXPECT_THAT(remarks("AMP.OUT"),
              ElementsAre(testing::AllOf(HasSubstr("AMP.OUT is no signal of STACK"),
                                         HasSubstr("did you mean AMP.XOUT?"), HasSubstr("--column AMP_OUT=AMP.OUT."))));
  EXPECT_THAT(remarks("amp.xout"), IsEmpty());
  EXPECT_THAT(remarks("TEMPERATURE"), IsEmpty()) << "it may be a disturbance";
}

/// A tag of a PLC is a driver by a name of the language, and `improved.toml` says which column that is.
TEST(InnerSignals, ATagOfAPlcDrives) {
  DiagnosisInput input = test::input_of(test::axis(), test::axis_parameters, {test::warm_sensor()});
  records::Record log = records::Record::even(0.0, 0.005, 2000);
  for (records::Column column : input.records.front().columns()) {
    column.name = column.name == "temp" ? "Hall[1].Temp" : column.name;
    log.add(std::move(column));
  }
  log.add({.name = "HALL_1_TEMP", .values = std::vector<double>(2000, 1.0)});
  log.add({.name = "Hall.Off", .values = std::vector<double>(2000, 1.0)});
  log.add({.name = "Speed.Act", .values = test::rich_voltage()});
  input.records = {log};
  std::vector<std::string> remarks;
  const DiagnosisInput named = with_named_drivers(input, remarks);
  EXPECT_THAT(remarks, ElementsAre(HasSubstr("--column HALL_1_TEMP_2=Hall[1].Temp.")));
  EXPECT_NE(named.records.front().find("SPEED.ACT"), nullptr) << "a signal of SPEED it claims to be";
  EXPECT_NE(named.records.front().find("Hall.Off"), nullptr) << "it moves nothing";
  const Diagnosis found = diagnose(input, {.effects = {"cross_coupling"}});
  ASSERT_EQ(found.effects.size(), 1U);
  EXPECT_THAT(found.effects.front().drivers, ElementsAre("HALL_1_TEMP_2"));
  EXPECT_THAT(found.improved_text, HasSubstr("HALL_1_TEMP_2"));
  ASSERT_EQ(found.improved_file.record.columns.size(), 1U);
  EXPECT_EQ(found.improved_file.record.columns.front().key, "HALL_1_TEMP_2");
  EXPECT_EQ(found.improved_file.record.columns.front().value.text, "Hall[1].Temp");
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
