// The last hours of a point, thinned: no peak is missing where all rows are looked at, and the work is bounded.
#include "runtime/history/history_trend.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/runtime/history/history_bench.hpp"
#include "tests/support/scratch_folder.hpp"

namespace hysteron::runtime {
namespace {

using test::HistoryBench;

class Trends : public testing::Test {
 protected:
  [[nodiscard]] std::filesystem::path file() const { return folder / "history.sqlite"; }
  hysteron::test::ScratchFolder folder{};
};

TEST_F(Trends, EachRowLiesBetweenLowestAndHighestOfItsPlace) {
  HistoryBench bench(file(), 1);
  bench.start();
  for (int second = 0; second < 20; ++second) {
    bench.second();
  }
  bench.stop();
  const Trend all = trend_of(file(), "y", 3'600'000);
  EXPECT_EQ(all.unit, "um");
  EXPECT_EQ(all.rows, 20'000);
  EXPECT_EQ(all.looked_at, 20'000);
  EXPECT_LE(all.places.size(), 600U);
  EXPECT_EQ(all.places.front().low, 0.5);
  EXPECT_EQ(all.places.back().high, 10'000.0);
  for (std::size_t i = 1; i < all.places.size(); ++i) {
    EXPECT_EQ(all.places[i].low, all.places[i - 1].high + 0.5) << "no row is left out";
    EXPECT_DOUBLE_EQ(all.places[i].mean, 0.5 * (all.places[i].low + all.places[i].high));
    EXPECT_FALSE(all.places[i].begins);
  }
  const Trend last = trend_of(file(), "Y", 5'000);
  EXPECT_EQ(last.rows, 5001);
  EXPECT_EQ(trend_of(file(), "NOTHING", 5'000).places.size(), 0U);
}

TEST_F(Trends, TheWorkIsBounded) {
  HistoryBench bench(file(), 1);
  bench.start();
  for (int second = 0; second < 200; ++second) {
    bench.second();
  }
  bench.stop();
  const Trend all = trend_of(file(), "Y", 3'600'000);
  EXPECT_EQ(all.rows, 200'000);
  EXPECT_LE(all.looked_at, 600 * 200);
  EXPECT_GE(all.looked_at, 600 * 50);
}

TEST_F(Trends, AClockThatIsSetBackAndAGapAreShown) {
  HistoryBench bench(file(), 100);
  bench.start();
  bench.second();
  bench.second();
  bench.set_clock(-600 * test::one_second);
  bench.second();
  bench.skip(60'000);
  bench.second();
  bench.stop();
  const Trend all = trend_of(file(), "U", 3'600'000);
  EXPECT_NEAR(all.set_back, 600.0, 0.2);
  EXPECT_TRUE(std::ranges::is_sorted(all.places, {}, &TrendPlace::utc_ms));
  EXPECT_TRUE(all.places.front().begins);
  EXPECT_EQ(std::ranges::count_if(all.places, &TrendPlace::begins), 2);
}

}  // namespace
}  // namespace hysteron::runtime
