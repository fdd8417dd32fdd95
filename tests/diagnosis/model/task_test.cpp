// Which parameters of a diagram count as known numbers of the machine, to be refitted where none is named.
#include "diagnosis/model/task.hpp"

#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

using testing::UnorderedElementsAre;

std::vector<std::string> known(const std::string& gain, const std::string& annotation) {
  const std::string text =
      "FUNCTION_BLOCK PLANT (* @ts 1ms *) VAR_INPUT U : LREAL; " + gain + " : LREAL := 0.0; (* @param " + annotation +
      " *) END_VAR VAR_OUTPUT Y : LREAL; END_VAR VAR L : HY_LAG := (T1 := 0.1); D : HY_DELAY := (X0 := 2.0); END_VAR "
      "L(XIN := " +
      gain + " * U); D(XIN := L.XOUT); Y := D.XOUT; END_FUNCTION_BLOCK";
  records::Record record = test::record_of("U", std::vector<double>(20, 1.0));
  record.add({.name = "Y", .values = std::vector<double>(20, 1.0)});
  const DiagnosisInput input{.program = compile_text(text, {.top = "PLANT"}),
                             .file = parameters::parse_parameter_file("p.toml", "[parameters]\n" + gain + " = 2.0\n"),
                             .records = {record}};
  std::vector<std::string> names;
  for (const Unknown& one : task_of(input).known) {
    names.push_back(one.path);
  }
  return names;
}

TEST(Task, AParameterIsANumberOfTheMachineWhateverItsName) {
  EXPECT_THAT(known("GA", ""), UnorderedElementsAre("GA", "L.T1"));
  EXPECT_THAT(known("G0", ""), UnorderedElementsAre("G0", "L.T1"));
}

TEST(Task, WhatARecordBeginsWithIsNone) {
  // D.X0 by the description of HY_DELAY, GA by its own word.
  EXPECT_THAT(known("GA", "@role start"), UnorderedElementsAre("L.T1"));
}

}  // namespace
}  // namespace hysteron::diagnosis
