// Starts: the grids on which an effect is tried, from what its signal does.
#include "diagnosis/effects/starts.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "diagnosis/effects/candidates.hpp"
#include "diagnosis/effects/signals.hpp"
#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

/// The highest period of a cogging whose position makes these excursions.
double highest_period(std::vector<double> position) {
  std::string slide = test::axis();
  slide.replace(slide.find("m/s"), 3, "mm");  // a speed is commanded, a position measured
  const Variant base{.text = slide, .program = std::make_shared<const Program>(compile_text(slide, {.top = "AXIS"}))};
  const std::vector<Candidate> list = candidates_of(base, "AXIS", {.effects = {"cogging"}});
  if (list.empty()) {
    ADD_FAILURE() << "no ripple over a position";
    return 0.0;
  }
  const Extent extent = extent_of({std::move(position)}, 0.001);
  const Grids grids = grids_of(list.front(), extent, &extent, {.sample_time = 0.001, .duration = 1.0}, {});
  const std::vector<EffectParameter>& parameters = list.front().own().parameters;
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    if (parameters[j].role == Role::Period) {
      for (const double value : grids.parameters[j].values) {
        EXPECT_LE(value, grids.parameters[j].highest);
      }
      return grids.parameters[j].highest;
    }
  }
  ADD_FAILURE() << "no period";
  return 0.0;
}

TEST(Starts, APeriodRepeatsWhereThePositionUsuallyIs) {
  // A sine bends at its ends as a limit does: with one turn over all but some peaks, either would fit.
  std::vector<double> position(1000);
  for (std::size_t k = 0; k < position.size(); ++k) {
    position[k] = std::sin(0.02 * static_cast<double>(k));
  }
  const double without_peaks = highest_period(position);
  EXPECT_NEAR(without_peaks, 1.0, 0.01) << "half the range of 2";
  position[300] = 5.0;
  position[700] = -5.0;
  EXPECT_NEAR(highest_period(position), without_peaks, 0.01);
}

TEST(Starts, NoPeriodIsSoughtOverAFewLevels) {
  std::vector<double> position(1000);
  for (std::size_t k = 0; k < position.size(); ++k) {
    position[k] = static_cast<double>(k / 100 * 3 % 7);  // seven levels: some period meets each as it likes
  }
  EXPECT_EQ(highest_period(position), 0.0);
}

/// The first parameter of an effect of the axis, as the search may move it.
Unknown first_unknown(const std::string& effect) {
  const std::string axis = test::axis();
  const Variant base{.text = axis, .program = std::make_shared<const Program>(compile_text(axis, {.top = "AXIS"}))};
  const Candidate candidate = candidates_of(base, "AXIS", {.effects = {effect}}).at(0);
  const Extent extent = extent_of({{0.0, 1.0, -1.0, 0.5}}, 0.001);
  const Grids grids = grids_of(candidate, extent, nullptr, {.sample_time = 0.001, .duration = 1.0}, {});
  return unknown_of(candidate.own().parameters.front(), candidate.own().paths.front(), grids.parameters.front());
}

TEST(Starts, AGainThatMultipliesByMoreThanTenIsNoErrorOfOne) {
  const Unknown gain = first_unknown("gain_error");
  EXPECT_DOUBLE_EQ(gain.start, 1.0);
  EXPECT_DOUBLE_EQ(gain.lower, 0.1);
  EXPECT_DOUBLE_EQ(gain.upper, 10.0);
}

TEST(Starts, AClockThatIsOffByMoreThanATenthIsNone) {
  const Unknown skew = first_unknown("clock");
  EXPECT_TRUE(skew.path.ends_with("SKEW"));
  EXPECT_DOUBLE_EQ(skew.lower, -0.1);
  EXPECT_DOUBLE_EQ(skew.upper, 0.1);
}

}  // namespace
}  // namespace hysteron::diagnosis
