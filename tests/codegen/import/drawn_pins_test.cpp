// Pins of drawn elements: what is negated, what is compared in a row, and what is refused by name because it is open,
// has a name that the function has not, or says what no diagram has.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "codegen/import/plcopen_import.hpp"
#include "codegen/interpreter/machine.hpp"
#include "support/errors.hpp"

namespace hysteron::testing {
namespace {

using ::testing::HasSubstr;

std::string point_in(const std::vector<int>& from) {
  std::string wires;
  for (const int one : from) {
    wires += fmt::format(R"(<connection refLocalId="{}"/>)", one);
  }
  return "<connectionPointIn>" + wires + "</connectionPointIn>";
}

std::string drawn_input(const std::string& name, int from) {
  return fmt::format(R"(<variable formalParameter="{}">{}</variable>)", name,
                     point_in(from == 0 ? std::vector<int>{} : std::vector{from}));
}

/// Block 7, its result to Y.
std::string drawn_function(const std::string& type, const std::string& pins,
                           const std::string& result = R"(<variable formalParameter="OUT"/>)") {
  return fmt::format(
      R"(<block localId="7" typeName="{}"><inputVariables>{}</inputVariables><outputVariables>{}</outputVariables></block>
<outVariable localId="8">{}<expression>Y</expression></outVariable>)",
      type, pins, result, point_in({7}));
}

/// With inputs A, B and C of one type, localIds 1 to 3.
std::string drawn_with(const std::string& type, const std::string& elements, const std::string& result = "BOOL") {
  std::string variables;
  std::string inputs;
  int id = 0;
  for (const char* const name : {"A", "B", "C"}) {
    variables += fmt::format(R"(<variable name="{}"><type><{}/></type></variable>)", name, type);
    inputs += fmt::format(R"(<inVariable localId="{}"><expression>{}</expression></inVariable>)", ++id, name);
  }
  return fmt::format(
      R"(<project xmlns="http://www.plcopen.org/xml/tc6_0201"><types><dataTypes/><pous>
<pou name="P" pouType="functionBlock"><interface><inputVars>{}</inputVars>
<outputVars><variable name="Y"><type><{}/></type></variable></outputVars></interface>
<body><FBD>{}{}</FBD></body></pou></pous></types></project>)",
      variables, result, inputs, elements);
}

double result_of_drawing(const std::string& xml, const std::vector<double>& inputs) {
  Diagnostics warnings;
  const Program program = compile_text(import_plcopen("drawing.xml", xml, {.cycle = "1ms"}, warnings));
  Machine<double> machine(program);
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    machine.set_input(i, inputs[i]);
  }
  machine.step();
  return machine.output(0);
}

std::string cause_of(const std::string& xml) {
  Diagnostics warnings;
  try {
    return import_plcopen("drawing.xml", xml, {}, warnings);
  } catch (const InputError& error) {
    EXPECT_EQ(error.diagnostics().all().front().number, error::untranslatable_element);
    return error.diagnostics().all().front().cause;
  }
}

constexpr const char* negated_result = R"(<variable formalParameter="OUT" negated="true"/>)";

TEST(DrawnPins, ANegatedResultOfAFunctionIsNot) {
  const std::string both = drawn_input("IN1", 1) + drawn_input("IN2", 2);
  const std::string nand = drawn_with("BOOL", drawn_function("AND", both, negated_result));
  const std::string nor = drawn_with("BOOL", drawn_function("OR", both, negated_result));
  for (const double a : {0.0, 1.0}) {
    for (const double b : {0.0, 1.0}) {
      EXPECT_EQ(result_of_drawing(nand, {a, b}), a * b == 0.0 ? 1.0 : 0.0);
      EXPECT_EQ(result_of_drawing(nor, {a, b}), a + b == 0.0 ? 1.0 : 0.0);
    }
  }
  const std::string not_greater = drawn_with("LREAL", drawn_function("GT", both, negated_result));
  EXPECT_EQ(result_of_drawing(not_greater, {2.0, 1.0}), 0.0);
  EXPECT_EQ(result_of_drawing(not_greater, {1.0, 2.0}), 1.0);
  EXPECT_EQ(cause_of(drawn_with("LREAL", drawn_function("ADD", both, negated_result), "LREAL")),
            "block ADD (localId 7) of P: it negates (A + B), which is a number");
}

TEST(DrawnPins, AComparisonOfThreeHoldsForEachPair) {
  const std::string three = drawn_input("IN1", 1) + drawn_input("IN2", 2) + drawn_input("IN3", 3);
  const std::string equal = drawn_with("BOOL", drawn_function("EQ", three));
  EXPECT_EQ(result_of_drawing(equal, {0.0, 0.0, 0.0}), 1.0);
  EXPECT_EQ(result_of_drawing(equal, {0.0, 0.0, 1.0}), 0.0);
  EXPECT_EQ(result_of_drawing(equal, {0.0, 1.0, 0.0}), 0.0) << "(0 = 1) = 0 was TRUE";
  const std::string falling = drawn_with("LREAL", drawn_function("GT", three));
  EXPECT_EQ(result_of_drawing(falling, {3.0, 2.0, 1.0}), 1.0);
  EXPECT_EQ(result_of_drawing(falling, {3.0, 1.0, 2.0}), 0.0);
  const std::string rising = drawn_with("LREAL", drawn_function("LE", three));
  EXPECT_EQ(result_of_drawing(rising, {1.0, 1.0, 2.0}), 1.0);
  EXPECT_EQ(result_of_drawing(rising, {2.0, 1.0, 2.0}), 0.0);
}

TEST(DrawnPins, WhatAFunctionDoesNotTakeIsRefused) {
  const std::string three = drawn_input("IN1", 1) + drawn_input("IN2", 2) + drawn_input("IN3", 3);
  EXPECT_EQ(cause_of(drawn_with("BOOL", drawn_function("NE", three))),
            "block NE (localId 7) of P: it has 3 inputs, and NE takes two");
  EXPECT_EQ(cause_of(drawn_with("LREAL", drawn_function("SUB", three), "LREAL")),
            "block SUB (localId 7) of P: it has 3 inputs, and SUB takes two");
  for (const char* const type : {"ADD", "MUL", "SUB", "MAX"}) {
    const std::string open = drawn_function(type, drawn_input("IN1", 1) + drawn_input("IN2", 0));
    EXPECT_EQ(cause_of(drawn_with("LREAL", open, "LREAL")),
              fmt::format("block {} (localId 7) of P: its input IN2 is not connected", type));
    EXPECT_EQ(cause_of(drawn_with("LREAL", drawn_function(type, drawn_input("IN1", 1)), "LREAL")),
              fmt::format("block {} (localId 7) of P: it has one input, and takes two", type));
  }
  EXPECT_EQ(cause_of(drawn_with("LREAL", drawn_function("ADD", drawn_input("IN1", 1) + drawn_input("FOO", 2)))),
            "block ADD (localId 7) of P: ADD has no input FOO");
  EXPECT_EQ(cause_of(drawn_with("LREAL", drawn_function("ADD", drawn_input("IN1", 1) + drawn_input("IN1", 2)))),
            "block ADD (localId 7) of P: its input IN1 is there twice");
}

TEST(DrawnPins, AttributesThatSayWhatNoDiagramHasAreRefused) {
  const std::string both = drawn_input("IN1", 1) + drawn_input("IN2", 2);
  const auto cause = [&](const std::string& attribute) {
    return cause_of(
        drawn_with("BOOL", drawn_function("AND", both, "<variable formalParameter=\"OUT\" " + attribute + "/>")));
  };
  EXPECT_EQ(cause(R"(negated="maybe")"), "block AND (localId 7) of P: its negated=\"maybe\" says nothing here");
  EXPECT_EQ(cause(R"(edge="rising")"), "block AND (localId 7) of P: its output OUT takes an edge");
  EXPECT_EQ(cause(R"(storage="set")"), "block AND (localId 7) of P: its pin OUT sets or resets");
  EXPECT_EQ(cause_of(drawn_with("BOOL", R"(<inVariable localId="1"><expression>B</expression></inVariable>)")),
            "inVariable B (localId 1) of P: another element has this localId");
  const std::string vendor =
      R"(<vendorElement localId="9"><inputVariables>)" + drawn_input("IN", 1) + "</inputVariables></vendorElement>";
  EXPECT_EQ(cause_of(drawn_with("BOOL", drawn_function("AND", both) + vendor)),
            "vendorElement (localId 9) of P: nobody but its editor knows what it does");
  const std::string title = R"(<vendorElement localId="1"><alternativeText/></vendorElement>)";
  EXPECT_EQ(result_of_drawing(drawn_with("BOOL", drawn_function("AND", both) + title), {1.0, 1.0}), 1.0)
      << "a title of an editor";
}

TEST(DrawnPins, WiresThatCarryNothingOrNoBoolAreRefused) {
  const auto to_y = [](const std::string& elements, const std::vector<int>& from) {
    return elements + "<outVariable localId=\"8\">" + point_in(from) + "<expression>Y</expression></outVariable>";
  };
  const std::string contact = "<contact localId=\"5\">" + point_in({}) + "<variable>A</variable></contact>";
  EXPECT_EQ(cause_of(drawn_with("BOOL", to_y(contact, {5}))), "contact A (localId 5) of P: nothing is connected to it");
  EXPECT_EQ(cause_of(drawn_with("LREAL", to_y("", {1, 2}), "LREAL")),
            "outVariable Y (localId 8) of P: 2 wires lead to it, and only BOOLs are joined, by an OR");
  EXPECT_EQ(result_of_drawing(drawn_with("BOOL", to_y("", {1, 2})), {0.0, 1.0}), 1.0);
}

TEST(DrawnPins, AnEmptyFileIsSaidToBeEmpty) {
  Diagnostics warnings;
  try {
    (void)import_plcopen("drawing.xml", "", {}, warnings);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.diagnostics().all().front().number, error::not_plcopen);
    EXPECT_THAT(error.diagnostics().all().front().cause, HasSubstr("no XML element"));
  }
}

}  // namespace
}  // namespace hysteron::testing
