// Glitches: samples that were put there are found, and nothing else is.
#include "diagnosis/noise/glitches.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "tests/diagnosis/faults/logged.hpp"

namespace hysteron::diagnosis {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::IsSupersetOf;
using testing::Not;

std::vector<double> smooth(std::uint64_t seed) {
  auto values = test::Noise(seed).white(2000, 0.1);
  for (std::size_t k = 0; k < values.size(); ++k) {
    values[k] += 20.0 * std::sin(0.01 * static_cast<double>(k));
  }
  return values;
}

TEST(Glitches, AreFoundWithTheirSize) {
  auto values = smooth(1);
  values[300] += 5.0;
  values[1200] -= 8.0;
  const Glitches found = find_glitches(test::experiments_of(values), 0);
  EXPECT_THAT(found.rows, ElementsAre(300U, 1200U));
  EXPECT_NEAR(found.largest, 8.0, 0.5);
  EXPECT_NEAR(found.rms, std::sqrt((25.0 + 64.0) / 2000.0), 0.02);
}

TEST(Glitches, LargeOnesHideNoSmallerOnes) {
  auto values = test::Noise(1).white(2000, 0.05);
  for (std::size_t k = 100; k < values.size(); k += 200) {
    values[k] += 120.0;
  }
  values[555] += 40.0;
  EXPECT_EQ(find_glitches(test::experiments_of(values), 0).rows.size(), 11U);
}

TEST(Glitches, ThatDieAwayWithinThreeSamplesAreTakenWhole) {
  auto values = smooth(4);
  for (std::size_t k = 0; k < 3; ++k) {
    values[700 + k] += 9.0 * std::pow(0.4, static_cast<double>(k));
  }
  EXPECT_THAT(find_glitches(test::experiments_of(values), 0).rows, ElementsAre(700U, 701U, 702U));
  for (std::size_t k = 0; k < 6; ++k) {
    values[900 + k] += 9.0;  // no glitch any more
  }
  EXPECT_THAT(find_glitches(test::experiments_of(values), 0).rows, ElementsAre(700U, 701U, 702U));
}

TEST(Glitches, NoiseAndCornersAreNone) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    EXPECT_THAT(find_glitches(test::experiments_of(smooth(seed)), 0).rows, IsEmpty()) << seed;
  }
  auto steps = test::Noise(2).white(2000, 0.1);
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const std::size_t tread = k / 200;
    steps[k] += 10.0 * static_cast<double>(tread);
  }
  EXPECT_THAT(find_glitches(test::experiments_of(steps), 0).rows, IsEmpty());
  auto teeth = test::Noise(3).white(2000, 0.001);  // slow, with a sharp peak now and then
  for (std::size_t k = 0; k < teeth.size(); ++k) {
    const double from_peak = std::abs(static_cast<double>(k % 200) - 100.0);
    teeth[k] += 0.01 * from_peak + std::max(0.0, 4.0 - from_peak);
  }
  EXPECT_THAT(find_glitches(test::experiments_of(teeth), 0).rows, IsEmpty());
}

/// Ten samples a turn: its neighbours hide what a sample does by itself.
std::vector<double> fast() {
  std::vector<double> values(2000);
  for (std::size_t k = 0; k < values.size(); ++k) {
    const auto t = static_cast<double>(k);
    values[k] = std::sin(0.63 * t) * (1.0 + std::sin(0.011 * t));
  }
  return values;
}

TEST(Glitches, OfAFastSignalShowBesideItsModel) {
  const std::vector<double> model = fast();
  std::vector<double> values = test::noisy(model, 0.01, 6);
  // Three where the signal is small: they count by themselves, and then so do those that its motion could be.
  for (const std::size_t row : {428U, 999U, 1570U}) {
    values[row] += 2.0;
  }
  values[700] += 1.5;
  values[1300] -= 1.5;
  const Glitches alone = find_glitches(test::experiments_of(values), 0);
  EXPECT_LT(alone.rows.size(), 5U);
  EXPECT_THAT(with_model(alone, test::experiments_of(values), 0, model).rows,
              ElementsAre(428U, 700U, 999U, 1300U, 1570U));
}

/// A still signal with three clear glitches, beside which others count.
std::vector<double> with_clear_ones() {
  auto values = test::Noise(8).white(2000, 0.1);
  for (const std::size_t row : {1200U, 1500U, 1800U}) {
    values[row] += 9.0;
  }
  return values;
}

TEST(Glitches, BesideAModelTheirTailsAreTakenToo) {
  std::vector<double> values = with_clear_ones();
  for (std::size_t k = 0; k < 10; ++k) {
    values[500 + k] += 9.0 * std::pow(0.55, static_cast<double>(k));
  }
  const Glitches found = with_model({}, test::experiments_of(values), 0, std::vector<double>(values.size(), 0.0));
  EXPECT_THAT(found.rows, IsSupersetOf({500U, 501U, 502U, 503U, 504U}));
  EXPECT_EQ(std::ranges::count_if(found.rows, [](std::size_t row) { return row > 510; }), 3) << "noise is no tail";
}

TEST(Glitches, NewOnesAreMeasuredByThemselves) {
  std::vector<double> values = with_clear_ones();
  const std::vector<double> still(values.size(), 0.0);
  const Glitches first = with_model({}, test::experiments_of(values), 0, still);
  EXPECT_EQ(first.new_rms, first.rms);
  values[500] += 5.0;
  const Glitches second = with_model(first, test::experiments_of(values), 0, still);
  EXPECT_EQ(second.rows.size(), first.rows.size() + 1);
  EXPECT_NEAR(second.new_rms, 5.0 / std::sqrt(2000.0), 0.01);
  EXPECT_GT(second.rms, 2.0 * second.new_rms);
}

TEST(Glitches, BesideAModelOneMayComeUponAnother) {
  std::vector<double> values = with_clear_ones();
  values[500] += 9.0;
  values[502] -= 9.0;
  EXPECT_THAT(find_glitches(test::experiments_of(values), 0).rows, Not(Contains(500U)));
  EXPECT_THAT(with_model({}, test::experiments_of(values), 0, std::vector<double>(values.size(), 0.0)).rows,
              IsSupersetOf({500U, 501U, 502U}));
}

TEST(Glitches, AModelThatIsLateShowsNone) {
  std::vector<double> steps(2000);
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const std::size_t tread = k / 130;
    steps[k] = static_cast<double>(tread * 7 % 5);
  }
  std::vector<double> late(steps.size(), 0.0);
  std::copy(steps.begin(), steps.end() - 1, late.begin() + 1);
  EXPECT_THAT(with_model({}, test::experiments_of(test::noisy(late, 0.01, 6)), 0, steps).rows, IsEmpty());
}

TEST(Glitches, AMissedSampleIsNone) {
  const std::vector<double> model = fast();
  std::vector<double> values = test::noisy(model, 0.01, 6);
  for (const std::size_t row : {300U, 710U, 1111U, 1500U}) {
    values[row] = values[row - 1];
  }
  EXPECT_THAT(with_model({}, test::experiments_of(values), 0, model).rows, IsEmpty());
}

}  // namespace
}  // namespace hysteron::diagnosis
