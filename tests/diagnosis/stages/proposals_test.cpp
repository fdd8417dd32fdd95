#include "diagnosis/stages/proposals.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace hysteron::diagnosis {
namespace {

/// A view that tells one family for sure, a search with two sets, and no effect at all.
struct Proposed {
  explicit Proposed(std::vector<double> votes) {
    runs.begins = {0, told.size()};
    runs.sets = {{.families = {"play"}}, {.families = {"lag"}}, {.families = {"creep", "lag"}}, {}};
    runs.closed = {0.9, 0.6, 0.8, 0.0};
    runs.votes = std::move(votes);
  }
  std::vector<Told> told{
      {.view = 0,
       .evidence = {.families = {{.family = "play", .probability = 1.0, .by_record = 1.0, .closed = 0.8},
                                 {.family = "lag", .probability = 0.5, .by_record = 0.5, .closed = 0.9}}}}};
  Runs runs{};
};

TEST(Proposals, WhatIsToldIsBelievedWhereItIsMoreProbableThanAllOfTheSearch) {
  EXPECT_TRUE(Proposed({0.5, 0.3, 0.2, 0.0}).runs.are_for_told());
  EXPECT_FALSE(Proposed({0.4, 0.3, 0.3, 0.0}).runs.are_for_told());
  Proposed none({0.0, 0.5, 0.5, 0.0});
  none.runs.begins = {0};
  EXPECT_FALSE(none.runs.are_for_told());
}

TEST(Proposals, WhatIsLessProbableThanNoEffectIsNotTold) {
  EXPECT_FALSE(Proposed({0.4, 0.1, 0.0, 0.5}).runs.are_for_told());
  EXPECT_TRUE(Proposed({0.5, 0.1, 0.0, 0.4}).runs.are_for_told());
}

TEST(Proposals, TheMostProbableOfEach) {
  const Proposed found({0.1, 0.2, 0.3, 0.4});
  EXPECT_EQ(found.runs.best_told(), 0U);
  EXPECT_EQ(found.runs.best_searched(), 2U);
}

TEST(Proposals, TheSetsOfAViewStandForItTogether) {
  Proposed found({0.3, 0.25, 0.35, 0.1});  // two sets of the first view, and one of another
  found.runs.begins = {0, 2, 3};
  EXPECT_DOUBLE_EQ(found.runs.votes_of(0), 0.55);
  EXPECT_EQ(found.runs.best_told(), 0U);
  EXPECT_EQ(found.runs.best_set_of(0), 0U);
  EXPECT_EQ(found.runs.best_set_of(1), 2U);
  EXPECT_TRUE(found.runs.are_for_told());
}

TEST(Proposals, AFamilyIsAsProbableAsWhatTellsIt) {
  const Proposed found({0.5, 0.3, 0.1, 0.1});
  Evidence evidence = found.told.front().evidence;
  weigh_families(found.runs, found.told, evidence);
  ASSERT_EQ(evidence.families.size(), 2U);
  EXPECT_EQ(evidence.families[0].family, "lag");  // 0.65 of 0.9 before 0.5 of 0.8
  EXPECT_NEAR(evidence.families[0].probability, 0.5 * 0.5 + 0.3 + 0.1, 1e-12);
  EXPECT_NEAR(evidence.families[1].probability, 0.5, 1e-12);
  EXPECT_NEAR(evidence.families[1].by_record, 0.5, 1e-12);
}

TEST(Proposals, AFamilyAloneIsTheBestRunWithoutAnother) {
  const Proposed found({0.5, 0.3, 0.1, 0.1});
  EXPECT_EQ(found.runs.alone("lag"), 0.6);
  EXPECT_EQ(found.runs.alone("creep"), 0.0);  // only beside another
}

TEST(Proposals, WhatIsInTheDiagramIsToldFirst) {
  const LawFinding friction{.effect = "coulomb_friction", .edge = "ACC"};
  const LawFinding resonance{.effect = "resonance", .edge = "ACC"};
  const LawFinding elsewhere{.effect = "resonance", .edge = "U"};
  const std::vector<SetFinding> sets{{.laws = {elsewhere}, .probability = 0.5},
                                     {.laws = {resonance, friction}, .probability = 0.3},
                                     {.laws = {resonance}, .probability = 0.2}};
  std::vector<SetFinding> known = sets;
  put_first({.laws = {friction, resonance}, .probability = 0.9}, known);  // in whatever order
  ASSERT_EQ(known.size(), 3U);
  EXPECT_EQ(known[0].probability, 0.3);
  EXPECT_EQ(known[1].probability, 0.5);
  EXPECT_EQ(known[2].probability, 0.2);
  std::vector<SetFinding> part = sets;
  put_first({.laws = {friction}, .probability = 0.3}, part);
  ASSERT_EQ(part.size(), 4U);
  EXPECT_EQ(part[0].laws.size(), 1U);
  EXPECT_EQ(part[1].probability, 0.5);
}

}  // namespace
}  // namespace hysteron::diagnosis
