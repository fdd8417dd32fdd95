// What of a sample is published: qualities, and changes.
#include "runtime/mqtt/row_maker.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>

namespace hysteron::runtime {
namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

/// Points X, on a device whose quality is column 4, Y, and the parameter P; column 3 is task.fault.
RowPlan row_plan(bool on_change = false) {
  return {.points = {{.name = "X", .unit = "V", .is_port = true, .dead_band = 0.5, .quality_column = 4},
                     {.name = "Y", .unit = "um", .is_port = true},
                     {.name = "P", .unit = "1"}},
          .fault_column = 3,
          .on_change = on_change,
          .refresh = 100};
}

Sample sample_at(std::uint64_t elapsed, double x, double y, double p, double fault = 0.0, double told = 1.0) {
  return {.cycle = elapsed, .elapsed = elapsed, .values = {x, y, p, fault, told}};
}

std::string qualities(const MqttRow& row) {
  std::string text;
  for (const MqttValue& value : row.values) {
    text += "gub"[static_cast<std::size_t>(value.quality)];
  }
  return text;
}

std::string changed(const std::optional<MqttRow>& row) {
  std::string text;
  for (const MqttValue& value : row ? row->values : std::vector<MqttValue>{}) {
    text += "XYP"[value.point];
  }
  return text;
}

/// What follows from an input that nobody measured is no measurement either.
TEST(Rows, ArePortsInDoubtWhileAnInputIsForced) {
  RowPlan plan = row_plan();
  plan.forced_column = 5;
  const RowMaker maker(plan);
  Sample sample = sample_at(7, 1.5, -2.0, 3.0);
  sample.values.push_back(0.0);
  EXPECT_EQ(qualities(maker.whole(sample, 0)), "ggg");
  sample.values.back() = 1.0;
  EXPECT_EQ(qualities(maker.whole(sample, 0)), "uug");
}

TEST(Rows, HaveTheirValuesTimesAndQualities) {
  const RowMaker maker(row_plan());
  const MqttRow row = maker.whole(sample_at(7, 1.5, -2.0, 3.0), 1234);
  EXPECT_EQ(row.utc_ms, 1234);
  EXPECT_EQ(row.cycle, 7U);
  EXPECT_EQ(row.values.at(1).value, -2.0);
  EXPECT_EQ(qualities(row), "ggg");
  EXPECT_EQ(qualities(maker.whole(sample_at(7, 1.5, no_number, 3.0), 0)), "gbg");
  EXPECT_EQ(qualities(maker.whole(sample_at(7, 1.5, 1.0, 1.0 / 0.0), 0)), "ggb");
  EXPECT_EQ(qualities(maker.whole(sample_at(7, 1.5, 1.0, 3.0, 5.0), 0)), "uug") << "a parameter is as it is";
  // never, good, old, refused, lost
  for (const auto& [told, letter] : {std::pair(0.0, 'b'), {1.0, 'g'}, {2.0, 'u'}, {3.0, 'b'}, {4.0, 'b'}}) {
    EXPECT_EQ(qualities(maker.whole(sample_at(7, 1.5, 1.0, 3.0, 0.0, told), 0)), std::string(1, letter) + "gg");
  }
}

TEST(Rows, OfChangesHaveWhatLeftItsDeadBand) {
  RowMaker maker(row_plan(true));
  const auto at = [&](std::uint64_t elapsed, double x, double y, double fault = 0.0) {
    return changed(maker.row(sample_at(elapsed, x, y, 3.0, fault), 0));
  };
  EXPECT_EQ(at(1, 0.0, 0.0), "XYP") << "the first is whole";
  EXPECT_EQ(at(2, 0.0, 0.0), "");
  EXPECT_EQ(at(3, 0.4, 0.0), "");
  EXPECT_EQ(at(4, 0.5, 0.0), "") << "up to the band";
  EXPECT_EQ(at(5, 0.6, 0.0), "X") << "by small steps as by a large one";
  EXPECT_EQ(at(6, 0.2, 1e-9), "Y") << "without a band, any change";
  EXPECT_EQ(at(7, 0.2, no_number), "Y");
  EXPECT_EQ(at(8, 0.2, no_number), "") << "still no number";
  EXPECT_EQ(at(9, 0.2, 1e-9), "Y");
  EXPECT_EQ(at(10, 0.2, 1e-9, 4.0), "XY") << "a fault begins";
  EXPECT_EQ(at(11, 0.2, 1e-9, 5.0), "");
  EXPECT_EQ(at(12, 0.2, 1e-9), "XY");
  EXPECT_EQ(at(100, 0.2, 1e-9), "");
  EXPECT_EQ(at(101, 0.2, 1e-9), "P") << "it has not been published for refresh";
  EXPECT_EQ(at(102, 0.2, 1e-9), "");
  maker.forget();
  EXPECT_EQ(at(103, 0.2, 1e-9), "XYP");
}

/// Whoever keeps what was published last knows each value to its band.
TEST(Rows, OfChangesLeaveNobodyFurtherOffThanTheBand) {
  std::mt19937 random(3);
  std::normal_distribution<double> step(0.0, 0.3);
  RowMaker maker(row_plan(true));
  double x = 0.0;
  double known = no_number;
  int published = 0;
  for (std::uint64_t elapsed = 1; elapsed < 20'000; ++elapsed) {
    x += step(random);
    const auto row = maker.row(sample_at(elapsed, x, 0.0, 0.0), 0);
    for (const MqttValue& value : row ? row->values : std::vector<MqttValue>{}) {
      known = value.point == 0 ? value.value : known;
      published += value.point == 0 ? 1 : 0;
    }
    ASSERT_LE(std::abs(x - known), 0.5);
  }
  EXPECT_LT(published, 10'000);
}

}  // namespace
}  // namespace hysteron::runtime
