// Which part of the gap belongs to the wires that a record is made of, and which to the plant.
#include "diagnosis/findings.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

GapSplit split(const std::vector<EffectFinding>& effects) {
  return split_of(effects, test::read_text(test::stack(), "STACK").edges, {"U", "Y"});
}

TEST(GapSplit, ADelayOnAMeasuredWireIsOfInputAndOutput) {
  for (const char* id : {"delay", "clock", "quantization", "glitches"}) {
    const GapSplit found = split({{.id = id, .edge = "U", .share = 0.75}});
    EXPECT_DOUBLE_EQ(found.input_output, 0.75) << id;
    EXPECT_DOUBLE_EQ(found.plant, 0.0);
    EXPECT_DOUBLE_EQ(found.open, 0.25);
  }
  EXPECT_DOUBLE_EQ(split({{.id = "delay", .edge = "HYST.XOUT", .share = 0.5}}).input_output, 0.5) << "it is Y's wire";
}

TEST(GapSplit, WhatElseThereIsIsThePlants) {
  EXPECT_DOUBLE_EQ(split({{.id = "lag", .edge = "U", .share = 0.5}}).plant, 0.5);
  EXPECT_DOUBLE_EQ(split({{.id = "delay", .edge = "AMP.XOUT", .share = 0.5}}).plant, 0.5);
  const GapSplit both =
      split({{.id = "creep", .edge = "HYST.XOUT", .share = 0.6}, {.id = "delay", .edge = "U", .share = 0.3}});
  EXPECT_DOUBLE_EQ(both.plant, 0.6);
  EXPECT_DOUBLE_EQ(both.input_output, 0.3);
  EXPECT_NEAR(both.open, 0.1, 1e-15);
}

TEST(GapSplit, AnEdgeThatCannotBeToldFromAPortCountsAsOne) {
  EXPECT_DOUBLE_EQ(split({{.id = "delay", .edge = "AMP.XOUT", .same_edges = {"U"}, .share = 0.5}}).input_output, 0.5);
}

TEST(GapSplit, WithoutEffectsAllIsOpen) {
  EXPECT_DOUBLE_EQ(split({}).open, 1.0);
}

}  // namespace
}  // namespace hysteron::diagnosis
