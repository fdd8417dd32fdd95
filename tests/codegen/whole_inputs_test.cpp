// What the inputs of a sequential body take, by the types that its text declares.
#include "codegen/graph/body/whole_inputs.hpp"

#include <gtest/gtest.h>

#include "codegen/compile.hpp"

namespace hysteron::testing {
namespace {

TEST(WholeInputs, AreThoseOfTheDeclaredType) {
  const Program program = compile_text(R"(FUNCTION_BLOCK WHOLE (* @ts 1ms @body *)
  VAR_INPUT A : INT; B : BYTE; C : USINT; D : DINT; E : UDINT; F : LREAL; G : BOOL; END_VAR
  VAR_OUTPUT Y : DINT; END_VAR
  IF G THEN Y := A; ELSE Y := D; END_IF;
END_FUNCTION_BLOCK
)");
  const auto wholes = bodies::whole_inputs(program.graph);
  ASSERT_EQ(wholes.size(), 7U);
  for (const std::size_t carrier : {3U, 5U, 6U}) {
    EXPECT_FALSE(wholes[carrier]) << program.graph.inputs[carrier].name;
  }
  EXPECT_EQ(bodies::whole_fault(*wholes[0], -32768.0), "");
  EXPECT_EQ(bodies::whole_fault(*wholes[0], 70000.0), "takes whole numbers from -32768 to 32767") << "it was 4464";
  EXPECT_EQ(bodies::whole_fault(*wholes[1], 255.0), "");
  EXPECT_EQ(bodies::whole_fault(*wholes[1], 300.0), "takes whole numbers from 0 to 255") << "it was 44";
  EXPECT_EQ(bodies::whole_fault(*wholes[2], -5.0), "takes whole numbers from 0 to 255") << "it was 251";
  EXPECT_EQ(bodies::whole_fault(*wholes[2], 0.5), "takes whole numbers from 0 to 255");
  EXPECT_EQ(bodies::whole_fault(*wholes[4], 4294967296.0), "takes whole numbers from 0 to 4294967295");
  EXPECT_EQ(bodies::whole_fault(*wholes[4], 4000000000.0), "");
  EXPECT_EQ(bodies::carried(*wholes[4], 4000000000.0), 4000000000.0 - 4294967296.0) << "the DINT of the same bits";
  EXPECT_EQ(bodies::carried(*wholes[0], 5.0), 5.0);
}

TEST(WholeInputs, OfADiagramSayTheirTypesThemselves) {
  const Program program = compile_text(R"(FUNCTION_BLOCK PLAIN (* @ts 1ms *)
  VAR_INPUT N : DINT; END_VAR
  VAR_OUTPUT M : DINT; END_VAR
  M := N;
END_FUNCTION_BLOCK
)");
  EXPECT_FALSE(bodies::whole_inputs(program.graph).at(0));
}

}  // namespace
}  // namespace hysteron::testing
