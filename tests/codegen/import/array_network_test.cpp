// Arrays in drawn networks: on wires, by their elements at pins and as targets, and what they were a cycle ago.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

#include "codegen/import/plcopen_import.hpp"
#include "codegen/interpreter/machine.hpp"
#include "support/errors.hpp"

namespace hysteron::testing {
namespace {

std::string array_variable(const std::string& name, int low, int high, const std::string& values = "") {
  std::string list;
  for (std::size_t begin = 0; begin < values.size();) {
    const auto end = std::min(values.find(' ', begin), values.size());
    list += fmt::format(R"(<value><simpleValue value="{}"/></value>)", values.substr(begin, end - begin));
    begin = end + 1;
  }
  return fmt::format(
      R"(<variable name="{}"><type><array><dimension lower="{}" upper="{}"/><baseType><LREAL/></baseType>)"
      "</array></type>{}</variable>",
      name, low, high, list.empty() ? "" : "<initialValue><arrayValue>" + list + "</arrayValue></initialValue>");
}

std::string pou(const std::string& name, const std::string& variables, const std::string& elements) {
  return fmt::format(
      R"(<pou name="{}" pouType="functionBlock"><interface>{}</interface><body><FBD>{}</FBD></body></pou>)", name,
      variables, elements);
}

std::string read(const std::string& pous) {
  Diagnostics warnings;
  return import_plcopen("drawing.xml",
                        R"(<project xmlns="http://www.plcopen.org/xml/tc6_0201"><types><dataTypes/><pous>)" + pous +
                            "</pous></types></project>",
                        {}, warnings);
}

std::string in(int id, const std::string& text) {
  return fmt::format(R"(<inVariable localId="{}"><connectionPointOut/><expression>{}</expression></inVariable>)", id,
                     text);
}

std::string wire(int from) {
  return fmt::format(R"(<connectionPointIn><connection refLocalId="{}"/></connectionPointIn>)", from);
}

std::string out(int id, const std::string& text, int from, const std::string& order = "") {
  return fmt::format(R"(<outVariable localId="{}"{}>{}<expression>{}</expression></outVariable>)", id,
                     order.empty() ? "" : fmt::format(R"( executionOrderId="{}")", order), wire(from), text);
}

std::string add(int id, int left, int right) {
  return fmt::format(
      R"(<block localId="{}" typeName="ADD"><inputVariables><variable formalParameter="IN1">{}</variable>)"
      R"(<variable formalParameter="IN2">{}</variable></inputVariables><inOutVariables/><outputVariables>)"
      R"(<variable formalParameter="OUT"><connectionPointOut/></variable></outputVariables></block>)",
      id, wire(left), wire(right));
}

std::string inputs(const std::string& list) {
  return "<inputVars>" + list + "</inputVars>";
}
std::string outputs(const std::string& list) {
  return "<outputVars>" + list + "</outputVars>";
}

/// Runs steps with the inputs 1, 2, 3, …; the outputs of the last one.
std::vector<double> outputs_after(const std::string& text, int steps, const std::string& top = "P") {
  const Program program = compile_text(text, {.top = top, .any_order = true});
  Machine<double> machine(program, 1e-3);
  for (std::size_t i = 0; i < program.graph.inputs.size(); ++i) {
    machine.set_input(i, static_cast<double>(i + 1));
  }
  std::vector<double> values;
  for (int k = 0; k < steps; ++k) {
    machine.step();
  }
  for (std::size_t i = 0; i < program.graph.outputs.size(); ++i) {
    values.push_back(machine.output(i));
  }
  return values;
}

/// What no element assigns keeps its first value, as in a PLC.
TEST(ArrayNetwork, ElementsAreReadAndAssignedOneByOne) {
  const std::string text = read(pou(
      "P", inputs(array_variable("V", 0, 2)) + outputs(array_variable("W", 0, 3, "5 6 7")),
      in(1, "V[1]") + in(2, "v[ 2 ]") + add(3, 1, 2) + out(4, "W[0]", 3) + in(5, "V[0] * 10.0") + out(6, "w[1]", 5)));
  EXPECT_EQ(outputs_after(text, 1), (std::vector{5.0, 10.0, 7.0, 0.0})) << text;
}

TEST(ArrayNetwork, AWholeArrayIsOnAWire) {
  const std::string text = read(
      pou("P", inputs(array_variable("V", 0, 1)) + outputs(array_variable("W", 0, 1)), in(1, "V") + out(2, "W", 1)));
  EXPECT_EQ(outputs_after(text, 1), (std::vector{1.0, 2.0})) << text;
}

TEST(ArrayNetwork, AnArrayMayBeginElsewhereThanAtZero) {
  const std::string text = read(pou("P", inputs(array_variable("V", 1, 3)) + outputs(array_variable("W", -1, 1)),
                                    in(1, "V[3]") + out(2, "W[-1]", 1) + in(3, "V[1]") + out(4, "W[1]", 3)));
  EXPECT_EQ(outputs_after(text, 1), (std::vector{3.0, 0.0, 1.0})) << text;
}

/// TOTAL[1] := TOTAL[1] + V[0]: memory, which begins at the first value of the element.
TEST(ArrayNetwork, AnElementThatIsReadBeforeItIsAssignedIsADelay) {
  const std::string text =
      read(pou("P", inputs(array_variable("V", 0, 1)) + outputs(array_variable("TOTAL", 0, 1, "3 4")),
               in(1, "TOTAL[1]") + in(2, "V[0]") + add(3, 1, 2) + out(4, "TOTAL[1]", 3)));
  EXPECT_EQ(outputs_after(text, 3), (std::vector{3.0, 7.0})) << text;
}

/// Y shows what W was a cycle ago, of each element.
TEST(ArrayNetwork, AWholeArrayOfTheLastCycleIsADelayOfEachElement) {
  const std::string network = in(1, "W") + out(2, "Y", 1, "1") + in(3, "V") + out(4, "W", 3, "2");
  const std::string text = read(pou(
      "P", inputs(array_variable("V", 0, 1)) + outputs(array_variable("Y", 0, 1) + array_variable("W", 0, 1, "8 9")),
      network));
  EXPECT_EQ(outputs_after(text, 1), (std::vector{8.0, 9.0, 1.0, 2.0})) << text;
  EXPECT_EQ(outputs_after(text, 2), (std::vector{1.0, 2.0, 1.0, 2.0})) << text;
}

TEST(ArrayNetwork, ABlockTakesAndGivesAnArray) {
  const std::string inner = pou("SWAP", inputs(array_variable("A", 0, 1)) + outputs(array_variable("B", 0, 1)),
                                in(1, "A[1]") + out(2, "B[0]", 1) + in(3, "A[0]") + out(4, "B[1]", 3));
  const std::string block =
      R"(<block localId="2" typeName="SWAP" instanceName="S"><inputVariables><variable formalParameter="A">)" +
      wire(1) +
      R"(</variable></inputVariables><inOutVariables/><outputVariables><variable formalParameter="B"><connectionPointOut/>)"
      R"(</variable></outputVariables></block>)";
  const std::string text = read(
      inner + pou("P",
                  inputs(array_variable("V", 0, 1)) + outputs(array_variable("W", 0, 1)) +
                      R"(<localVars><variable name="S"><type><derived name="SWAP"/></type></variable></localVars>)",
                  in(1, "V") + block +
                      R"(<outVariable localId="3"><connectionPointIn><connection refLocalId="2" formalParameter="B"/>)"
                      "</connectionPointIn><expression>W</expression></outVariable>"));
  EXPECT_EQ(outputs_after(text, 1), (std::vector{2.0, 1.0})) << text;
}

/// The cause of a refusal.
std::string cause(const std::string& network, const std::string& more = "") {
  try {
    read(pou("P", inputs(array_variable("V", 0, 1) + more) + outputs(array_variable("W", 0, 1)), network));
  } catch (const InputError& error) {
    return error.diagnostics().all().front().cause;
  }
  return "";
}

TEST(ArrayNetwork, WhatCannotBeAssignedOrReadIsNamed) {
  EXPECT_EQ(cause(in(1, "V[0]") + out(2, "W[2]", 1)),
            "outVariable W[2] (localId 2) of P: it assigns W[2], and W is of type ARRAY [0..1] OF LREAL");
  EXPECT_EQ(cause(in(1, "V[2]") + out(2, "W[0]", 1)),
            "inVariable V[2] (localId 1) of P: it reads V[2], and V is of type ARRAY [0..1] OF LREAL");
  EXPECT_EQ(cause(in(1, "V[0]") + out(2, "W[I]", 1)),
            "outVariable W[I] (localId 2) of P: it assigns an element of W whose place is no constant");
  EXPECT_EQ(cause(in(1, "V[0]") + out(2, "W[0]", 1) + in(3, "V") + out(4, "W", 3)),
            "outVariable W[0] (localId 2) of P: it assigns an element of W, which localId 4 assigns as a whole");
  EXPECT_EQ(cause(in(1, "W") + out(2, "X", 1, "1") + in(3, "V[0]") + out(4, "W[0]", 3, "2"), array_variable("X", 0, 1)),
            "inVariable W (localId 1) of P: it reads the whole of W before W[0] is assigned");
  EXPECT_EQ(cause(in(1, "V[0]") + out(2, "W[0]", 1), array_variable("LONG", 0, 256)),
            "LONG of P is of type ARRAY [0..256] OF LREAL, which no diagram has");
}

}  // namespace
}  // namespace hysteron::testing
