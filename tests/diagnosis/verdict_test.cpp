// The verdict: sets are weighed as finely as the data are worth, and no finer than formulas are true.
#include "diagnosis/verdict.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "diagnosis/diagnosis.hpp"
#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

using testing::Contains;
using testing::ElementsAre;

std::vector<std::vector<std::string>> sets_of(const std::vector<Rival>& rivals) {
  std::vector<std::vector<std::string>> sets;
  for (const Rival& rival : rivals) {
    sets.push_back(rival.effects);
  }
  return sets;
}

/// An axis with a dry friction, in twenty steps a sample: it stands where the force is too small, and the force goes
/// straight from sample to sample.
std::vector<double> speeds_in_fine_steps(const std::vector<double>& force, double friction) {
  constexpr int fine = 20;
  constexpr double step = 0.005 / fine;
  std::vector<double> speeds{0.0};
  double v = 0.0;
  for (std::size_t k = 1; k < force.size(); ++k) {
    for (int s = 0; s < fine; ++s) {
      const double f = std::lerp(force[k - 1], force[k], (s + 0.5) / fine);
      const double opposed = v != 0.0 ? v : f;
      const bool stands = v == 0.0 && std::abs(f) <= friction;
      const double next = stands ? 0.0 : v + 0.5 * step * (f - std::copysign(friction, opposed));
      v = v * next < 0.0 ? 0.0 : next;
    }
    speeds.push_back(v);
  }
  return speeds;
}

TEST(Verdict, AnotherDiscretisationIsNoEvidence) {
  // A falling part of 10 % or so brings the product's steps nearer to finer ones than a friction without.
  const std::vector<double> force = test::rich_force();
  std::vector<double> speeds = speeds_in_fine_steps(force, 0.6);
  test::Noise noise(3);
  for (double& speed : speeds) {
    speed += 0.01 * noise();
  }
  records::Record record = test::record_of("FORCE", force);
  record.add({.name = "V", .values = std::move(speeds)});
  const Diagnosis found = diagnose(test::input_of(test::axis(), test::axis_parameters, {record}),
                                   {.effects = {"coulomb_friction", "stribeck_friction", "viscous_friction"}});
  ASSERT_EQ(found.effects.size(), 1U) << found.summary;
  EXPECT_EQ(found.effects[0].id, "coulomb_friction") << found.summary;
}

TEST(Verdict, WhatClosesLittleBesideAnotherMayBeItsFormula) {
  // Two lags for one: a delay beside the longer one stands in for the shorter.
  constexpr std::string_view machine =
      "FUNCTION_BLOCK STACK (* @ts 5ms *) VAR_INPUT U : LREAL; (* @unit V *) END_VAR VAR_OUTPUT Y : LREAL; (* @unit um "
      "*) END_VAR VAR AMP : HY_LAG := (T1 := 0.02); HYST : HY_HYSTERESIS_RO := (C1 := 5.0, C2 := 4.0, C3 := 0.8); "
      "ONE : HY_LAG := (T1 := 0.1); OTHER : HY_LAG := (T1 := 0.012); END_VAR AMP(XIN := U); HYST(XIN := AMP.XOUT); "
      "ONE(XIN := HYST.XOUT); OTHER(XIN := ONE.XOUT); Y := OTHER.XOUT; END_FUNCTION_BLOCK";
  const records::Record record =
      test::measured(test::program_of(std::string(machine)), test::record_of("U", test::rich_voltage()), 0.02);
  const Diagnosis found = diagnose(test::input_of(test::stack(), test::stack_parameters, {record}),
                                   {.effects = {"lag", "delay", "drift", "offset"}});
  ASSERT_FALSE(found.effects.empty()) << found.summary;
  EXPECT_EQ(found.effects[0].id, "lag") << found.summary;
  EXPECT_THAT(sets_of(found.rivals), Contains(ElementsAre("lag"))) << found.summary;
  // Ruled out by their likelihood alone, and said to be something else than equal.
  const auto whole = std::ranges::find(found.rivals, std::vector<std::string>{"lag"}, &Rival::effects);
  EXPECT_EQ(whole->support<-rival_within, found.effects.size()> 1);
}

}  // namespace
}  // namespace hysteron::diagnosis
