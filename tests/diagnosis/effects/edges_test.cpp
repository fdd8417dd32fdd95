// The edges of a diagram: each wire once, under every name that an engineer may give it.
#include "diagnosis/effects/edges.hpp"

#include <gmock/gmock.h>

#include <set>
#include <string>

#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

using test::read_text;
using testing::ElementsAre;
using testing::IsSupersetOf;
using testing::UnorderedElementsAre;

std::vector<std::string> names_of(const std::vector<Edge>& edges) {
  std::vector<std::string> names;
  for (const Edge& edge : edges) {
    names.push_back(edge.name);
  }
  return names;
}

const Edge& edge_of(const std::vector<Edge>& edges, std::string_view name) {
  const Edge* const found = find_edge(edges, name);
  if (found == nullptr) {
    throw std::runtime_error("no edge " + std::string(name));
  }
  return *found;
}

TEST(Edges, AChainHasOneForEachWire) {
  const auto read = read_text(test::stack(), "STACK");
  EXPECT_THAT(names_of(read.edges), UnorderedElementsAre("U", "AMP.XOUT", "HYST.XOUT"));
  EXPECT_THAT(edge_of(read.edges, "U").aliases, ElementsAre("AMP.XIN"));
  EXPECT_THAT(edge_of(read.edges, "AMP.XOUT").aliases, ElementsAre("HYST.XIN"));
  EXPECT_THAT(edge_of(read.edges, "HYST.XOUT").aliases, ElementsAre("Y"));
}

TEST(Edges, AreFoundByAnyNameInAnyCase) {
  const auto read = read_text(test::stack(), "stack");
  EXPECT_EQ(edge_of(read.edges, "y").name, "HYST.XOUT");
  EXPECT_EQ(edge_of(read.edges, "hyst.xin").name, "AMP.XOUT");
  EXPECT_EQ(edge_of(read.edges, "Amp.Xin").name, "U");
  EXPECT_EQ(find_edge(read.edges, "HYST"), nullptr);
  EXPECT_EQ(find_edge(read.edges, "HYST.Q"), nullptr);  // BOOL
}

/// An edit of the text at one element holds where the text names that element, and nowhere else.
TEST(Edges, OfAVectorAreThoseThatTheTextNames) {
  const auto read = read_text(R"(FUNCTION_BLOCK AXES  (* @ts 1ms *)
  VAR_INPUT U : ARRAY[0..1] OF LREAL; G : LREAL; END_VAR
  VAR_OUTPUT Y : ARRAY[0..1] OF LREAL; Z : LREAL; END_VAR
  VAR V : ARRAY[0..1] OF LREAL; A : HY_LAG; END_VAR
  V := U * G;
  A(XIN := V[0]);
  Y[0] := A.XOUT;
  Y[1] := V[1] + 1.0;
  Z := SUM(U);
END_FUNCTION_BLOCK
)",
                              "AXES");
  const auto names = names_of(read.edges);
  EXPECT_THAT(names, IsSupersetOf({"G", "V[0]", "V[1]", "A.XOUT", "Z"}));
  EXPECT_THAT(names, testing::Not(testing::Contains("U[0]")));
  EXPECT_THAT(names, testing::Not(testing::Contains("U[1]")));
  EXPECT_EQ(edge_of(read.edges, "G").reads.size(), 1U);
}

constexpr std::string_view branched = R"(FUNCTION_BLOCK PLANT  (* @ts 1ms *)
  VAR_INPUT u : LREAL; BIAS : LREAL := 0.5; (* @param *) HOT : BOOL; END_VAR
  VAR_OUTPUT y : LREAL; Z : LREAL; END_VAR
  VAR a : HY_LAG; B : HY_GAIN; S : HY_INTEGRAL; END_VAR
  a(XIN := U);
  B(XIN := u - BIAS);
  S(XIN := A.xout, R1 := HOT);
  Y := A.XOUT + b.XOUT;
  Z := S.XOUT;
END_FUNCTION_BLOCK
)";

TEST(Edges, ASignalWithSeveralReadersHasBranches) {
  const auto read = read_text(std::string(branched), "PLANT");
  EXPECT_THAT(names_of(read.edges),
              UnorderedElementsAre("U", "A.XIN", "B.XIN", "A.XOUT", "S.XIN", "B.XOUT", "Y", "S.XOUT"));
  EXPECT_EQ(edge_of(read.edges, "U").reads.size(), 2U);
  EXPECT_EQ(edge_of(read.edges, "A.XIN").reads.size(), 1U);
  EXPECT_EQ(edge_of(read.edges, "A.XIN").source, "U");
}

TEST(Edges, AMeasuredSignalThatIsReadHasABranchBehindTheMeasurement) {
  const auto read = read_text(
      "FUNCTION_BLOCK LOOP (* @ts 1ms *) VAR_INPUT REF : LREAL; END_VAR VAR_OUTPUT U : LREAL; Y : LREAL; END_VAR VAR "
      "MOTOR : HY_GAIN; AXIS : HY_LAG; LOAD : HY_GAIN; END_VAR U := 3.0 * REF; MOTOR(XIN := U); AXIS(XIN := "
      "MOTOR.XOUT); Y := AXIS.XOUT; LOAD(XIN := Y); END_FUNCTION_BLOCK\n",
      "LOOP");
  EXPECT_THAT(names_of(read.edges), IsSupersetOf({"U", "MOTOR.XIN", "AXIS.XOUT", "LOAD.XIN"}));
  EXPECT_EQ(edge_of(read.edges, "U").source, "3.0 * REF");  // the measured U with it
  EXPECT_EQ(edge_of(read.edges, "MOTOR.XIN").source, "U");  // the motor alone
  EXPECT_EQ(edge_of(read.edges, "Y").name, "AXIS.XOUT");
}

TEST(Edges, AComputedSignalIsReadWhereItIsComputed) {
  const auto read = read_text(std::string(branched), "PLANT");
  EXPECT_EQ(edge_of(read.edges, "B.XIN").source, "u - BIAS");
  EXPECT_EQ(edge_of(read.edges, "Y").source, "A.XOUT + b.XOUT");
  const Edge& sum = edge_of(read.edges, "Y");
  ASSERT_EQ(sum.reads.size(), 1U);
  EXPECT_EQ(read.source->text->substr(sum.reads.front().offset, sum.reads.front().length), "A.XOUT + b.XOUT");
}

TEST(Edges, ParametersAndSwitchesAreNone) {
  const auto read = read_text(std::string(branched), "PLANT");
  for (const char* name : {"BIAS", "HOT", "S.R1"}) {
    EXPECT_EQ(find_edge(read.edges, name), nullptr) << name;
  }
}

TEST(Edges, ASignalThatNothingReadsIsNone) {
  const auto read = read_text(
      "FUNCTION_BLOCK P (* @ts 1ms *) VAR_INPUT U : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR VAR A : HY_GAIN; B : "
      "HY_GAIN; END_VAR A(XIN := U); B(XIN := A.XOUT); Y := A.XOUT; END_FUNCTION_BLOCK",
      "P");
  EXPECT_EQ(find_edge(read.edges, "B.XOUT"), nullptr);
}

constexpr std::string_view nested = R"(FUNCTION_BLOCK DRIVE
  VAR_INPUT CURRENT : LREAL; END_VAR
  VAR_OUTPUT SPEED : LREAL; END_VAR
  VAR MOTOR : HY_GAIN; ROTOR : HY_INTEGRAL; END_VAR
  MOTOR(XIN := CURRENT);
  ROTOR(XIN := MOTOR.XOUT);
  SPEED := ROTOR.XOUT;
END_FUNCTION_BLOCK
FUNCTION_BLOCK MACHINE  (* @ts 1ms *)
  VAR_INPUT I : LREAL; END_VAR
  VAR_OUTPUT V : LREAL; END_VAR
  VAR LEFT : DRIVE; RIGHT : DRIVE; END_VAR
  LEFT(CURRENT := I);
  RIGHT(CURRENT := -I);
  V := LEFT.SPEED - RIGHT.SPEED;
END_FUNCTION_BLOCK
)";

TEST(Edges, NestedBlocksHaveTheirOwnUnderTheNameOfTheInstance) {
  const auto read = read_text(std::string(nested), "MACHINE");
  EXPECT_THAT(names_of(read.edges), IsSupersetOf({"I", "LEFT.MOTOR.XOUT", "RIGHT.MOTOR.XOUT", "V"}));
  const Edge& inner = edge_of(read.edges, "right.rotor.xin");
  EXPECT_EQ(inner.name, "RIGHT.MOTOR.XOUT");
  EXPECT_EQ(inner.prefix, "RIGHT.");
  EXPECT_EQ(inner.local, "MOTOR.XOUT");
  EXPECT_EQ(read.definitions.list[inner.definition].block->name.text, "DRIVE");
  const auto names = names_of(read.edges);
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
}

TEST(Edges, AnInputOfANestedBlockIsTheWireThatDrivesIt) {
  const auto read = read_text(std::string(nested), "MACHINE");
  int count = 0;
  for (const Edge& edge : read.edges) {
    const bool alias = std::ranges::find(edge.aliases, "LEFT.CURRENT") != edge.aliases.end();
    count += edge.name == "LEFT.CURRENT" || alias ? 1 : 0;
  }
  EXPECT_EQ(count, 1);
  EXPECT_EQ(edge_of(read.edges, "RIGHT.CURRENT").source, "-I");
}

}  // namespace
}  // namespace hysteron::diagnosis
