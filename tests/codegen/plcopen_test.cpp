// PLCopen XML, out and in: a diagram that was drawn and read back has the same bits; hostile files are refused.
#include "codegen/backends/plcopen/plcopen.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <random>
#include <sstream>
#include <string>

#include "codegen/import/plcopen_import.hpp"
#include "codegen/interpreter/machine.hpp"
#include "support/errors.hpp"
#include "tests/codegen/random_program.hpp"
#include "tests/support/mutation.hpp"

namespace hysteron {
namespace {

/// Every box at one place: what Graphviz would answer.
std::string placed(const std::string& dot) {
  std::istringstream lines(dot);
  std::string plain;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("digraph")) {
      plain += "graph 1 10 10\n";
    } else if (line.starts_with("}")) {
      plain += "stop\n";
    } else if (line.starts_with("  n") && line.find(" [width") != std::string::npos) {
      plain += "node " + line.substr(2, line.find(' ', 2) - 2) + " 1 1 1 1\n";
    }
  }
  return plain;
}

std::string drawn(const Program& program, std::string_view dialect = "portable") {
  return generate_plcopen(program, {.dialect = dialect, .body = PlcopenBody::Network, .place = placed}).front().text;
}

std::string read_back(const std::string& xml) {
  Diagnostics warnings;
  return import_plcopen("drawing.xml", xml, {}, warnings);
}

std::string project(const std::string& variables, const std::string& elements) {
  return R"(<project xmlns="http://www.plcopen.org/xml/tc6_0201"><types><dataTypes/><pous>
<pou name="P" pouType="functionBlock"><interface>)" +
         variables + "</interface><body><FBD>" + elements + "</FBD></body></pou></pous></types></project>";
}

/// Runs both with the same random inputs, by place.
void expect_same_bits(const Program& one, const Program& other) {
  Machine<double> a(one);
  Machine<double> b(other);
  ASSERT_EQ(one.graph.inputs.size(), other.graph.inputs.size());
  ASSERT_EQ(one.graph.outputs.size(), other.graph.outputs.size());
  std::mt19937_64 random(7);
  for (int k = 0; k < 200; ++k) {
    for (std::size_t i = 0; i < one.graph.inputs.size(); ++i) {
      const double value = one.graph.inputs[i].type == Type::Real ? static_cast<double>(random() % 2000) / 100.0 - 10.0
                                                                  : static_cast<double>(random() % 2);
      a.set_input(i, value);
      b.set_input(i, value);
    }
    a.step();
    b.step();
    for (std::size_t i = 0; i < one.graph.outputs.size(); ++i) {
      const double x = a.output(i);
      const double y = b.output(i);
      ASSERT_TRUE(std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y) ||
                  (std::isnan(x) && std::isnan(y)))
          << one.graph.outputs[i].name << " in step " << k << ": " << x << " and " << y;
    }
  }
}

constexpr const char* loop = R"(FUNCTION_BLOCK INNER
  VAR_INPUT X : LREAL; K : LREAL := 3.0; (* @param *) END_VAR
  VAR_OUTPUT Y : LREAL; END_VAR
  Y := K * X - SQRT(ABS(X));
END_FUNCTION_BLOCK
FUNCTION_BLOCK LOOP (* @ts 1ms @doc a loop *)
  VAR_INPUT X : LREAL; (* @min -10.0 @max 20.0 *) ON_1 : BOOL; END_VAR
  VAR_OUTPUT Y : LREAL; N : DINT; END_VAR
  VAR CONSTANT TOP : LREAL := 5.0; END_VAR
  VAR OLD : HY_DELAY := (X0 := 2.5); CUT : HY_LIMIT := (MN := -4.0, MX := 8.0); E : LREAL; I : INNER; C : HY_CTU; END_VAR
  E := X - OLD.XOUT;
  I(X := E, K := 2.0);
  CUT(XIN := MIN(I.Y, TOP) + SEL(ON_1, -E, E ** 2));
  C(CU := ON_1 AND NOT (E > 1.0), PV := 1000);
  OLD(XIN := CUT.XOUT);
  Y := CUT.XOUT;
  N := C.CV + 1;
END_FUNCTION_BLOCK
)";

TEST(Plcopen, ADrawnDiagramReadBackHasTheSameBits) {
  const Program program = compile_text(loop, {.top = "LOOP"});
  for (const char* const dialect : {"portable", "openplc", "codesys", "twincat"}) {
    const std::string text = read_back(drawn(program, dialect));
    expect_same_bits(program, compile_text(text, {.top = "LOOP", .any_order = true}));
    EXPECT_NE(text.find("@min -10.0 @max 20.0"), std::string::npos) << text;
    EXPECT_NE(text.find("@ts 1ms"), std::string::npos) << text;
  }
}

TEST(Plcopen, TheSameDiagramGivesTheSameBytes) {
  EXPECT_EQ(drawn(compile_text(loop, {.top = "LOOP"})), drawn(compile_text(loop, {.top = "LOOP"})));
}

/// Beremiz runs what feeds a variable before it assigns it, so that a wire would bring the next cycle's value.
TEST(Plcopen, AVariableTakesWhatABlockRemembersByItsName) {
  const std::string xml = drawn(compile_text(R"(FUNCTION_BLOCK LATE (* @ts 1ms *)
  VAR_INPUT X : LREAL; END_VAR
  VAR_OUTPUT Y : LREAL; END_VAR
  VAR D : HY_DELAY; END_VAR
  Y := D.XOUT;
  D(XIN := X);
END_FUNCTION_BLOCK
)"));
  EXPECT_NE(xml.find("<expression>D.XOUT</expression>"), std::string::npos) << xml;
}

/// The same the other way: a drawn wire from a block into a variable brings what the block has behind its call.
TEST(Plcopen, AVariableRunsTheBlockThatFeedsItFirst) {
  const std::string xml = project(
      R"(<inputVars><variable name="X"><type><BOOL/></type></variable></inputVars>
         <outputVars><variable name="Y"><type><BOOL/></type></variable></outputVars>
         <localVars><variable name="T"><type><derived name="R_TRIG"/></type></variable></localVars>)",
      // The clock is constant: what Q then is comes from memory alone, and still is the call's.
      R"(<inVariable localId="1"><connectionPointOut/><expression>TRUE</expression></inVariable>
         <block localId="2" typeName="R_TRIG" instanceName="T" executionOrderId="2"><inputVariables>
           <variable formalParameter="CLK"><connectionPointIn><connection refLocalId="1"/></connectionPointIn></variable>
         </inputVariables><inOutVariables/><outputVariables><variable formalParameter="Q"><connectionPointOut/></variable></outputVariables></block>
         <outVariable localId="3" executionOrderId="1"><connectionPointIn><connection refLocalId="2" formalParameter="Q"/></connectionPointIn><expression>Y</expression></outVariable>)");
  EXPECT_EQ(read_back(xml).find("HY_DELAY"), std::string::npos);
}

TEST(Plcopen, AVectorIsDrawnByItsElements) {
  const Program program = compile_text(R"(FUNCTION_BLOCK INNER
  VAR_INPUT V : ARRAY[0..2] OF LREAL; END_VAR
  VAR_OUTPUT W : ARRAY[0..2] OF LREAL; S : LREAL; END_VAR
  W := 2.0 * V;
  S := SUM(V);
END_FUNCTION_BLOCK
FUNCTION_BLOCK OUTER (* @ts 1ms *)
  VAR_INPUT X : ARRAY[0..2] OF LREAL; END_VAR
  VAR_OUTPUT Y : ARRAY[0..2] OF LREAL; T : LREAL; END_VAR
  VAR I : INNER; M : ARRAY[0..2] OF LREAL; OLD : HY_DELAY; END_VAR
  M := X - OLD.XOUT;
  I(V := M);
  OLD(XIN := I.S);
  Y := I.W + [1.0, 2.0, 3.0];
  T := DOT(M, X);
END_FUNCTION_BLOCK
)",
                                       {.top = "OUTER"});
  const std::string text = read_back(drawn(program));
  EXPECT_NE(text.find("X_0"), std::string::npos);
  expect_same_bits(program, compile_text(text, {.top = "OUTER"}));
}

TEST(Plcopen, WhatNoNetworkHoldsIsRefused) {
  const Program program = compile_text(R"(FUNCTION_BLOCK SLOW (* @ts 1ms *)
  VAR_INPUT X : LREAL; END_VAR
  VAR_OUTPUT Y : LREAL; END_VAR
  VAR S : HY_SAMPLE; (* @every 4 *) H : HY_HOLD; END_VAR
  S(XIN := X);
  H(XIN := S.XOUT);
  Y := H.XOUT;
END_FUNCTION_BLOCK
)");
  const Program sized = compile_text(R"(FUNCTION_BLOCK SIZED (* @ts 1ms *)
  VAR_INPUT X : ARRAY[0..1] OF LREAL; END_VAR
  VAR_OUTPUT Y : LREAL; END_VAR
  VAR G : HY_MATRIX_GAIN := (K := [1.0, 2.0], ROWS := 1); END_VAR
  G(XIN := X);
  Y := G.XOUT;
END_FUNCTION_BLOCK
)");
  for (const Program* const one : {&program, &sized}) {
    try {
      drawn(*one);
      FAIL() << "a network has no rates, and no block of a size of its own";
    } catch (const InputError& error) {
      EXPECT_EQ(error.diagnostics().all().front().number, error::no_network);
    }
  }
}

/// Without a check of units: random wires do not care.
Program unchecked(const std::string& text) {
  Diagnostics diagnostics;
  const auto source = std::make_shared<const language::SourceFile>(language::parse("read back", text, diagnostics));
  const Definitions definitions = define(source, diagnostics);
  Program program;
  program.graph = elaborate(definitions, 0, diagnostics);
  program.schedule = schedule(program.graph, diagnostics);
  if (diagnostics.has_errors()) {
    throw InputError(diagnostics);
  }
  return program;
}

TEST(Plcopen, RandomDiagramsReadBackHaveTheSameBits) {
  int compared = 0;
  for (std::uint64_t seed = 1; seed <= 150; ++seed) {
    const testing::RandomDiagram diagram(seed, "RANDOM_PLANT", 2 + static_cast<int>(seed % 9));
    const Program program = diagram.program();
    std::string xml;
    try {
      xml = drawn(program);
    } catch (const InputError& error) {  // an array, or one block that is wired in two ways
      ASSERT_EQ(error.diagnostics().all().front().number, error::no_network);
      continue;
    }
    SCOPED_TRACE(diagram.text());
    const std::string text = read_back(xml);
    SCOPED_TRACE(text);
    expect_same_bits(program, unchecked(text));
    ++compared;
    if (HasFatalFailure()) {
      return;
    }
  }
  EXPECT_GT(compared, 75);
}

TEST(Plcopen, AVariableThatIsReadBeforeItIsAssignedIsADelay) {
  const std::string xml = project(
      R"(<inputVars><variable name="X"><type><LREAL/></type></variable></inputVars>
         <outputVars><variable name="Y"><type><LREAL/></type><initialValue><simpleValue value="4.0"/></initialValue></variable></outputVars>)",
      R"(<inVariable localId="1"><connectionPointOut/><expression>X</expression></inVariable>
         <inVariable localId="2"><connectionPointOut/><expression>Y</expression></inVariable>
         <block localId="3" typeName="ADD"><inputVariables>
           <variable formalParameter="IN1"><connectionPointIn><connection refLocalId="1"/></connectionPointIn></variable>
           <variable formalParameter="IN2"><connectionPointIn><connection refLocalId="2"/></connectionPointIn></variable>
         </inputVariables><inOutVariables/><outputVariables><variable formalParameter="OUT"><connectionPointOut/></variable></outputVariables></block>
         <outVariable localId="4"><connectionPointIn><connection refLocalId="3"/></connectionPointIn><expression>Y</expression></outVariable>)");
  const Program program = compile_text(read_back(xml), {.any_order = true});
  Machine<double> machine(program, 1e-3);
  machine.set_input(0, 1.0);
  machine.step();
  EXPECT_EQ(machine.output(0), 5.0);
  machine.step();
  EXPECT_EQ(machine.output(0), 6.0);
}

/// TOTAL := TOTAL + X, of a variable that comes from outside and goes out again.
std::string adding(const std::string& total) {
  return R"(<inVariable localId="1"><connectionPointOut/><expression>X</expression></inVariable>
         <inVariable localId="2"><connectionPointOut/><expression>)" +
         total + R"(</expression></inVariable>
         <block localId="3" typeName="ADD"><inputVariables>
           <variable formalParameter="IN1"><connectionPointIn><connection refLocalId="2"/></connectionPointIn></variable>
           <variable formalParameter="IN2"><connectionPointIn><connection refLocalId="1"/></connectionPointIn></variable>
         </inputVariables><outputVariables><variable formalParameter="OUT"><connectionPointOut/></variable></outputVariables></block>
         <outVariable localId="4"><connectionPointIn><connection refLocalId="3"/></connectionPointIn><expression>)" +
         total + "</expression></outVariable>";
}

constexpr const char* lreal_variable = "<type><LREAL/></type></variable>";
const std::string input_x = std::string(R"(<inputVars><variable name="X">)") + lreal_variable + "</inputVars>";

TEST(Plcopen, AVariableOfTheProjectComesInAndGoesOut) {
  for (const std::string list : {"externalVars", "inOutVars"}) {
    const std::string xml = project(
        input_x + "<" + list + R"(><variable name="TOTAL">)" + lreal_variable + "</" + list + ">", adding("TOTAL"));
    Diagnostics warnings;
    const Program program = compile_text(import_plcopen("drawing.xml", xml, {}, warnings));
    ASSERT_EQ(warnings.all().size(), 1U);
    EXPECT_NE(warnings.all().front().cause.find("goes out by TOTAL_OUT"), std::string::npos);
    ASSERT_EQ(program.graph.outputs.size(), 1U);
    EXPECT_EQ(program.graph.outputs[0].name, "TOTAL_OUT");
    Machine<double> machine(program, 1e-3);
    for (std::size_t i = 0; i < 2; ++i) {
      machine.set_input(i, program.graph.inputs[i].name == "X" ? 1.5 : 40.0);
    }
    machine.step();
    EXPECT_EQ(machine.output(0), 41.5) << list;
  }
}

TEST(Plcopen, WhatIsAssignedAloneIsAnOutputAndWhatIsReadAloneAnInput) {
  const std::string xml =
      project(std::string(R"(<externalVars><variable name="IN1">)") + lreal_variable + R"(<variable name="OUT1">)" +
                  lreal_variable + "</externalVars>",
              R"(<inVariable localId="1"><connectionPointOut/><expression>IN1</expression></inVariable>
         <outVariable localId="4"><connectionPointIn><connection refLocalId="1"/></connectionPointIn><expression>OUT1</expression></outVariable>)");
  const Program program = compile_text(read_back(xml));
  ASSERT_EQ(program.graph.inputs.size(), 1U);
  EXPECT_EQ(program.graph.inputs[0].name, "IN1");
  ASSERT_EQ(program.graph.outputs.size(), 1U);
  EXPECT_EQ(program.graph.outputs[0].name, "OUT1_OUT");
}

/// A block that adds to what it is handed: the variable behind the pin is memory of the caller.
std::string with_inner(const std::string& pin, const std::string& more = "") {
  return R"(<project xmlns="http://www.plcopen.org/xml/tc6_0201"><types><dataTypes/><pous>
<pou name="INNER" pouType="functionBlock"><interface>)" +
         input_x + R"(<inOutVars><variable name="TOTAL">)" + lreal_variable + "</inOutVars></interface><body><FBD>" +
         adding("TOTAL") + R"(</FBD></body></pou>
<pou name="OUTER" pouType="functionBlock"><interface>)" +
         input_x + R"(<outputVars><variable name="Y">)" + lreal_variable +
         R"(</outputVars><localVars><variable name="SUM_1">)" + lreal_variable +
         R"(<variable name="I"><type><derived name="INNER"/></type></variable></localVars></interface><body><FBD>
         <inVariable localId="1"><connectionPointOut/><expression>X</expression></inVariable>
         <inOutVariable localId="2"><connectionPointOut/><expression>)" +
         pin + R"(</expression></inOutVariable>
         <block localId="3" typeName="INNER" instanceName="I" executionOrderId="1"><inputVariables>
           <variable formalParameter="X"><connectionPointIn><connection refLocalId="1"/></connectionPointIn></variable></inputVariables>
         <inOutVariables><variable formalParameter="TOTAL"><connectionPointIn><connection refLocalId="2"/></connectionPointIn></variable></inOutVariables></block>
         <inVariable localId="5"><connectionPointOut/><expression>SUM_1</expression></inVariable>
         <outVariable localId="6" executionOrderId="2"><connectionPointIn><connection refLocalId="5"/></connectionPointIn><expression>Y</expression></outVariable>)" +
         more + "</FBD></body></pou></pous></types></project>";
}

TEST(Plcopen, WhatABlockHandsBackIsAssignedToTheVariableThatItTook) {
  const Program program = compile_text(read_back(with_inner("SUM_1")), {.top = "OUTER"});
  Machine<double> machine(program, 1e-3);
  machine.set_input(0, 2.0);
  for (const double wanted : {2.0, 4.0, 6.0}) {
    machine.step();
    EXPECT_EQ(machine.output(0), wanted);
  }
}

/// One variable behind the VAR_IN_OUT of two blocks: ADDING adds X to it, SCALING multiplies it by X.
std::string handed_to_both(const std::string& order_of_adding, const std::string& order_of_scaling) {
  const auto inner = [](const std::string& name, const std::string& function) {
    std::string text = adding("TOTAL");
    text.replace(text.find("ADD"), 3, function);
    return R"(<pou name=")" + name + R"(" pouType="functionBlock"><interface>)" + input_x +
           R"(<inOutVars><variable name="TOTAL">)" + lreal_variable + "</inOutVars></interface><body><FBD>" + text +
           "</FBD></body></pou>";
  };
  const auto call = [](const std::string& id, const std::string& name, const std::string& order) {
    return R"(<block localId=")" + id + R"(" typeName=")" + name + R"(" instanceName="THE_)" + name + R"(" )" + order +
           R"(><inputVariables>
           <variable formalParameter="X"><connectionPointIn><connection refLocalId="1"/></connectionPointIn></variable></inputVariables>
         <inOutVariables><variable formalParameter="TOTAL"><connectionPointIn><connection refLocalId="2"/></connectionPointIn></variable></inOutVariables></block>)";
  };
  return R"(<project xmlns="http://www.plcopen.org/xml/tc6_0201"><types><dataTypes/><pous>)" + inner("ADDING", "ADD") +
         inner("SCALING", "MUL") + R"(<pou name="OUTER" pouType="functionBlock"><interface>)" + input_x +
         R"(<outputVars><variable name="Y">)" + lreal_variable + R"(</outputVars><localVars><variable name="SUM_1">)" +
         lreal_variable +
         R"(<variable name="THE_ADDING"><type><derived name="ADDING"/></type></variable>
            <variable name="THE_SCALING"><type><derived name="SCALING"/></type></variable></localVars></interface><body><FBD>
         <inVariable localId="1"><connectionPointOut/><expression>X</expression></inVariable>
         <inOutVariable localId="2"><connectionPointOut/><expression>SUM_1</expression></inOutVariable>)" +
         call("3", "ADDING", order_of_adding) + call("4", "SCALING", order_of_scaling) +
         R"(<inVariable localId="5"><connectionPointOut/><expression>SUM_1</expression></inVariable>
         <outVariable localId="6" executionOrderId="7"><connectionPointIn><connection refLocalId="5"/></connectionPointIn><expression>Y</expression></outVariable>
         </FBD></body></pou></pous></types></project>)";
}

TEST(Plcopen, TheOrderOfExecutionDecidesWhichBlockHasAVariableFirst) {
  struct Case {
    const char* adding;
    const char* scaling;
    std::array<double, 3> sums;
  };
  for (const auto& [adding, scaling, sums] :
       {Case{"0", "1", {4.0, 12.0, 28.0}}, Case{"1", "0", {2.0, 6.0, 14.0}}, Case{"3", "2", {2.0, 6.0, 14.0}}}) {
    const auto order = [](const std::string& text) { return "executionOrderId=\"" + text + "\""; };
    const Program program = compile_text(read_back(handed_to_both(order(adding), order(scaling))), {.top = "OUTER"});
    Machine<double> machine(program, 1e-3);
    machine.set_input(0, 2.0);
    for (const double wanted : sums) {
      machine.step();
      EXPECT_EQ(machine.output(0), wanted) << adding << " " << scaling;
    }
  }
}

TEST(Plcopen, WithoutAnOrderAVariableThatIsAssignedTwiceIsRefused) {
  // 0 on each element is what an editor writes where nobody chose.
  for (const std::string order : {"", R"(executionOrderId="0")", R"(executionOrderId="5")"}) {
    try {
      read_back(handed_to_both(order, order));
      FAIL() << order;
    } catch (const InputError& error) {
      const Diagnostic& told = error.diagnostics().all().front();
      EXPECT_EQ(told.number, error::untranslatable_element);
      EXPECT_NE(told.cause.find("assigns SUM_1, as localId"), std::string::npos) << told.cause;
      EXPECT_NE(told.mend.find("executionOrderId"), std::string::npos) << told.mend;
    }
  }
}

/// An upper block that reads a lower one.
std::string upper_reads_lower(const std::string& order_of_upper, const std::string& order_of_lower) {
  return project(
      R"(<inputVars><variable name="X"><type><LREAL/></type></variable></inputVars>
         <outputVars><variable name="Y"><type><LREAL/></type></variable></outputVars>
         <localVars><variable name="G"><type><derived name="HY_GAIN"/></type></variable></localVars>)",
      R"(<inVariable localId="1"><connectionPointOut/><expression>X</expression></inVariable>
         <block localId="2" typeName="HY_GAIN" instanceName="G" executionOrderId=")" +
          order_of_upper + R"("><position x="9" y="0"/><inputVariables>
           <variable formalParameter="XIN"><connectionPointIn><connection refLocalId="3"/></connectionPointIn></variable>
         </inputVariables><outputVariables><variable formalParameter="XOUT"/></outputVariables></block>
         <block localId="3" typeName="ADD" executionOrderId=")" +
          order_of_lower + R"("><position x="0" y="9"/><inputVariables>
           <variable formalParameter="IN1"><connectionPointIn><connection refLocalId="1"/></connectionPointIn></variable>
           <variable formalParameter="IN2"><connectionPointIn><connection refLocalId="1"/></connectionPointIn></variable>
         </inputVariables></block><outVariable localId="4"><connectionPointIn><connection refLocalId="2" formalParameter="XOUT"/></connectionPointIn><expression>Y</expression></outVariable>)");
}

TEST(Plcopen, OfEqualOrdersTheWiresDecideWithAWarning) {
  Diagnostics warnings;
  const std::string text = import_plcopen("drawing.xml", upper_reads_lower("7", "7"), {}, warnings);
  EXPECT_EQ(text.find("HY_DELAY"), std::string::npos) << text;
  ASSERT_EQ(warnings.all().size(), 1U);
  EXPECT_NE(warnings.all().front().cause.find("localId 3 of P has executionOrderId 7, as localId 2"),
            std::string::npos);
  Diagnostics none;
  EXPECT_NE(import_plcopen("drawing.xml", upper_reads_lower("7", "8"), {}, none).find("HY_DELAY"), std::string::npos);
  EXPECT_TRUE(none.all().empty());
}

TEST(Plcopen, AnOrderThatIsNoWholeNumberIsRefused) {
  EXPECT_NO_THROW(read_back(upper_reads_lower("2", "18446744073709551615")));
  for (const std::string order : {"abc", "-3", "", "1.5", "99999999999999999999"}) {
    try {
      read_back(upper_reads_lower("1", order));
      FAIL() << order;
    } catch (const InputError& error) {
      const std::string& cause = error.diagnostics().all().front().cause;
      EXPECT_NE(cause.find("executionOrderId \"" + order + "\" is no whole number"), std::string::npos) << cause;
    }
  }
}

TEST(Plcopen, WhatIsHandedOverIsAVariableOfThePou) {
  const auto cause = [](const std::string& xml) {
    try {
      read_back(xml);
      return std::string();
    } catch (const InputError& error) {
      return error.diagnostics().all().front().cause;
    }
  };
  EXPECT_NE(cause(with_inner("2.5")).find("VAR_IN_OUT TOTAL is handed no variable"), std::string::npos);
  EXPECT_NE(cause(with_inner("X")).find("VAR_IN_OUT TOTAL is handed no variable"), std::string::npos);
  EXPECT_NE(cause(with_inner("SUM_1", R"(<outVariable localId="7"><connectionPointIn><connection refLocalId="1"/>
         </connectionPointIn><expression>SUM_1</expression></outVariable>)"))
                .find("assigns SUM_1"),
            std::string::npos);
}

TEST(Plcopen, WhatADiagramCannotExpressIsNamed) {
  const std::string xml = project("<localVars/>", R"(<jump localId="17" label="END"><connectionPointIn/></jump>)");
  try {
    read_back(xml);
    FAIL() << "a jump is no wire";
  } catch (const InputError& error) {
    const Diagnostic& told = error.diagnostics().all().front();
    EXPECT_EQ(told.number, error::untranslatable_element);
    EXPECT_NE(told.cause.find("jump (localId 17)"), std::string::npos) << told.cause;
    EXPECT_EQ(told.place.line, 2U);
  }
}

TEST(Plcopen, DamagedFilesAreReadOrRefused) {
  const std::string xml = drawn(compile_text(loop, {.top = "LOOP"}));
  const std::vector<std::string> pieces{"<block localId=\"1\">",
                                        "</pou>",
                                        "refLocalId=\"99\"",
                                        "<jump/>",
                                        "&x;",
                                        "<!DOCTYPE a [<!ENTITY x SYSTEM \"/etc/passwd\">]>",
                                        "localId=\"3\"",
                                        "(*",
                                        "]]>"};
  std::mt19937 random(11);
  int refused = 0;
  for (int i = 0; i < 400; ++i) {
    try {
      const std::string text = read_back(test::mutated(xml, pieces, random));
      EXPECT_EQ(text.find("root:"), std::string::npos);
    } catch (const InputError& error) {
      const int number = error.diagnostics().all().front().number;
      EXPECT_TRUE(number == error::not_plcopen || number == error::untranslatable_element) << number;
      ++refused;
    }
  }
  EXPECT_GT(refused, 50);
}

TEST(Plcopen, DepthDoesNoHarm) {
  std::string deep = "<project><types><pous><pou name=\"A\" pouType=\"functionBlock\"><documentation>";
  for (int i = 0; i < 200'000; ++i) {
    deep += "<p>";
  }
  EXPECT_THROW(read_back(deep), InputError);
}

}  // namespace
}  // namespace hysteron
