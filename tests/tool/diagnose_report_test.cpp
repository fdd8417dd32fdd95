#include "tool/diagnose_report.hpp"

#include <gmock/gmock.h>

#include "diagnosis/findings/findings.hpp"

namespace hysteron::tool {
namespace {

using diagnosis::Diagnosis;
using testing::AllOf;
using testing::HasSubstr;

Diagnosis found() {
  Diagnosis result;
  result.verdict = diagnosis::Verdict::Named;
  result.gap = {
      .signal = "Y", .unit = "um", .nominal = 0.9, .calibrated = 0.8, .improved = 0.02, .floor = {.value = 0.019}};
  result.gap.closed = 0.9999;
  result.gap.closed_low = 0.9995;
  result.gap.closed_high = 1.02;
  result.gaps = {result.gap};
  result.effects = {{.id = "coulomb_friction",
                     .edge = "I",
                     .share = 0.957,
                     .parameters = {{.name = "LEVEL", .value = 0.08, .low = 0.079996, .high = 0.080004, .unit = "A"}}},
                    {.id = "creep", .edge = "Y", .share = 0.05, .around_plant = true}};
  result.split = {.plant = 0.957, .open = 0.043};
  result.budget = diagnosis::GapBudget{.at = "Y",
                                       .closed = 0.955,
                                       .kinds = {{.kind = "memory", .share = 0.307},
                                                 {.kind = "static_curve", .share = 0.306},
                                                 {.kind = "linear_dynamics", .share = 0.302},
                                                 {.kind = "periodic", .share = 0.04}}};
  result.rivals = {{.effects = {"coulomb_friction"}, .edges = {"I"}, .probability = 0.8},
                   {.effects = {"creep"}, .edges = {"Y"}, .probability = 0.2}};
  result.edges = {{.edge = "I", .share = 0.97, .group = {"KT.XOUT"}}};
  result.tracking_nominal = 0.5;
  result.tracking_improved = 0.01;
  result.summary = diagnosis::summary_of(result, false);
  return result;
}

/// Every figure has its name, and each interval two ends.
TEST(DiagnosisText, NamesItsFigures) {
  const std::string text = diagnosis_text(found());
  EXPECT_THAT(text, AllOf(HasSubstr("(Y: nominal 0.9, calibrated 0.8, improved 0.02 um RMS, floor 0.019)"),
                          HasSubstr("closed > 99.9 % (> 99.9 % to 100 %) on blocks held out"),
                          HasSubstr("(0.079996 to 0.080004)"), HasSubstr("coulomb_friction at I "),
                          HasSubstr("probability 0.20"),
                          HasSubstr("edge I                    97 % of the gap, as at KT.XOUT")));
}

/// What is one whole sums to 100 %; what is beside it says so.
TEST(DiagnosisText, PartsOfOneWholeSumToIt) {
  EXPECT_THAT(
      diagnosis_text(found()),
      AllOf(HasSubstr("gap by kind, at Y: memory of direction 31 %, a static curve 31 %, linear dynamics 30 %, "
                      "other kinds 4 %, no kind 4 %"),
            HasSubstr("of the gap: inputs and outputs 0 %, plant 96 %, open 4 %"),
            HasSubstr("creep at Y: 5 % of the gap at the outputs, around the plant, beside the 100 % of the others")));
}

/// A model that is run against itself says nothing of the machine: what the record leaves is said with it.
TEST(DiagnosisText, TheFeedforwardIsRunThroughTheDiagram) {
  EXPECT_THAT(
      diagnosis_text(found()),
      HasSubstr("feedforward, run through the improved diagram: tracking error 0.5 um RMS with the model as it was, "
                "0.01 um improved; the machine adds what this diagram leaves, 0.02 um RMS"));
}

}  // namespace
}  // namespace hysteron::tool
