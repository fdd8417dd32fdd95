// What is told of the evidence: effects in the units of their edge, and the sentence that an engineer would say.
#include "diagnosis/findings/evidence_findings.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <string>

#include "diagnosis/diagnosis.hpp"

namespace hysteron::diagnosis {
namespace {

Evidence of_friction(const std::string& unit) {
  Evidence evidence;
  evidence.families = {{.family = "dry_friction",
                        .probability = 0.98,
                        .closed = 0.8,
                        .alone = 0.8,
                        .effect = "asymmetric_friction",
                        .edge = "SPEED.XIN"},
                       {.family = "play", .probability = 0.1, .closed = 0.3, .alone = 0.54, .edge = "V"},
                       {.family = "offset", .probability = 0.1, .closed = 0.1, .alone = 0.2, .edge = "V"}};
  evidence.sets = {{.laws = {{.effect = "asymmetric_friction",
                              .family = "dry_friction",
                              .edge = "SPEED.XIN",
                              .values = {{.name = "UP", .value = 19.0, .error = 1.0, .unit = "'x"},
                                         {.name = "DOWN", .value = 21.04, .error = 1.0, .unit = "'x"},
                                         {.name = "PRESLIDE", .value = 0.001, .error = 1e-4, .unit = "'v*s"}},
                              .closed = 0.8}},
                    .probability = 0.98,
                    .closed = 0.8}};
  evidence.picture = {.edge = "SPEED.XIN", .unit = unit, .over = "V", .over_unit = "m/s"};
  return evidence;
}

Diagnosis told(const std::string& unit) {
  Diagnosis found;
  found.evidence = of_friction(unit);
  tell(found.evidence, {}, found);
  return found;
}

TEST(EvidenceFindings, ParametersAreInTheUnitsOfTheirEdgeAndDriver) {
  const Diagnosis found = told("N");
  ASSERT_EQ(found.effects.size(), 1U);
  ASSERT_EQ(found.effects[0].parameters.size(), 3U);
  EXPECT_EQ(found.effects[0].parameters[0].unit, "N");
  EXPECT_EQ(found.effects[0].parameters[2].unit, "m");
}

TEST(EvidenceFindings, AUnitThatTheDiagramDoesNotSayIsLeftOut) {
  const Diagnosis found = told("");
  EXPECT_EQ(found.effects.at(0).parameters.at(0).unit, "");
  EXPECT_THAT(sentence_of(found, {}), testing::StartsWith("Dry friction at SPEED.XIN closes 80 %"));
}

TEST(EvidenceFindings, TheSentenceHasSizesShareNextBestAndRest) {
  EXPECT_EQ(sentence_of(told("N"), {}),
            "Dry friction at SPEED.XIN, UP 19, DOWN 21 N, closes 80 % of the gap by itself, on stretches not fitted "
            "(probability 0.98; next best play, 54 %). The rest, 20 %, no effect of the library explains.");
}

TEST(EvidenceFindings, WhatClosesMoreAndIsLessProbableIsNoNextBest) {
  Diagnosis found = told("N");
  found.evidence.families[1].alone = 0.9;
  EXPECT_THAT(sentence_of(found, {}), testing::HasSubstr("(probability 0.98; play closes more by itself, 90 %, and is "
                                                         "less probable, 0.10)."));
}

/// One idea a sentence: what is beside it has one of its own.
TEST(EvidenceFindings, WhatIsBesideItHasASentence) {
  Diagnosis found = told("N");
  found.evidence.sets.front().closed = 0.9;
  found.evidence.families.push_back({.family = "play", .probability = 0.9, .closed = 0.1, .alone = 0.2, .edge = "V"});
  EXPECT_THAT(sentence_of(found, {}),
              testing::HasSubstr("). With play at V (probability 0.90) it closes 90 %. The rest, "
                                 "10 %, no effect of the library explains."));
}

/// Of a set that is not the one in `improved.st` no run is kept: what it would leave is not known, and is not 0.
TEST(EvidenceFindings, WhatASetLeavesIsKnownOfTheOneThatIsKept) {
  Diagnosis found;
  found.gap.improved = 0.2;
  found.evidence = of_friction("N");
  found.evidence.sets.push_back({.laws = {{.effect = "backlash", .family = "play", .edge = "V"}}, .probability = 0.1});
  tell(found.evidence, {}, found);
  ASSERT_EQ(found.rivals.size(), 2U);
  EXPECT_EQ(found.rivals[0].improved_rms, 0.2);
  EXPECT_EQ(found.rivals[0].parameters, 3U);
  EXPECT_TRUE(std::isnan(found.rivals[1].improved_rms));
}

TEST(EvidenceFindings, ConfidenceIsTheProbabilityTimesTheCorrelationWithWhatIsMissing) {
  EXPECT_NEAR(told("N").confidence, 0.98 * std::sqrt(0.8), 1e-12);
}

}  // namespace
}  // namespace hysteron::diagnosis
