#include "records/time/time_grid.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "support/numbers.hpp"

namespace hysteron::records {
namespace {

struct Printed {
  std::vector<double> time{};
  PrintedResolution resolution{};
};

/// Times as a logger prints them: through text, by a format such as "{:.7f}".
Printed print(const std::vector<double>& exact, const std::string& format) {
  Printed result;
  for (const double time : exact) {
    const auto text = format.empty() ? number_text(time) : fmt::format(fmt::runtime(format), time);
    result.time.push_back(parse_number(text).value);
    result.resolution.take(text);
  }
  return result;
}

std::vector<double> even(double start, double sample_time, std::size_t rows) {
  std::vector<double> time(rows);
  for (std::size_t k = 0; k < rows; ++k) {
    time[k] = start + static_cast<double>(k) * sample_time;
  }
  return time;
}

TimeGrid grid_of(const Printed& printed) {
  return find_time_grid(printed.time, printed.resolution);
}

TEST(TimeGrid, FindsTheExactSampleTimeBehindRounding) {
  struct Case {
    double sample_time;
    std::size_t rows;
    const char* format;
  };
  const Case cases[] = {
      {1.0 / 6400.0, 16384, "{:.7f}"},  // fast steering mirror
      {16384e-7, 131072, "{:.6f}"},     // silverbox, 10^7/2^14 Hz
      {0.005, 14155, "{:.3f}"},         // piezo stack
      {4.0, 1024, "{:.0f}"},            // tanks
      {50e-6, 20000, "{:.7g}"},         // seven significant digits
      {1e-3, 10000, "{:.6e}"},          // the same, as of an old plotter
      {1.0 / 300.0, 3000, "{:.4f}"},    // no finite decimal
      {1.0 / 3.0, 100, ""},             // all digits
      {1e-6, 1000, "{:.9f}"},
      {0.1, 1000, ""},
      {0.1, 2, ""},
      {3600.0, 48, "{:.1f}"},
  };
  for (const auto& [sample_time, rows, format] : cases) {
    for (const double start : {0.0, 10.0, -5.0}) {
      const auto grid = grid_of(print(even(start, sample_time, rows), format));
      EXPECT_FALSE(grid.fault) << sample_time << " " << format << " from " << start << " row " << grid.fault->row;
      EXPECT_DOUBLE_EQ(grid.sample_time, sample_time) << format << " from " << start;
    }
  }
}

TEST(TimeGrid, TruncatedAndAccumulatedTimesPass) {
  auto time = even(0.0, 1.0 / 6400.0, 10000);
  for (double& t : time) {
    t = std::floor(t * 1e7) / 1e7;
  }
  const auto truncated = grid_of(print(time, "{:.7f}"));
  EXPECT_FALSE(truncated.fault);
  EXPECT_DOUBLE_EQ(truncated.sample_time, 1.0 / 6400.0);

  double sum = 0.0;
  for (double& t : time) {
    t = sum;
    sum += 0.001;
  }
  const auto accumulated = grid_of(print(time, ""));
  EXPECT_FALSE(accumulated.fault);
  EXPECT_DOUBLE_EQ(accumulated.sample_time, 0.001);

  float single = 0.0F;
  for (std::size_t k = 0; k < time.size(); ++k) {
    single = static_cast<float>(k) * 0.001F;
    time[k] = static_cast<double>(single);
  }
  const auto in_single = grid_of(print(time, ""));
  EXPECT_FALSE(in_single.fault);
  EXPECT_NEAR(in_single.sample_time, 0.001, 1e-9);
}

TEST(TimeGrid, SmallJitterPassesAndIsAveraged) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> jitter(-0.005, 0.005);
  auto time = even(0.0, 0.01, 5000);
  for (double& t : time) {
    t += 0.01 * jitter(random);
  }
  const auto grid = grid_of(print(time, "{:.9f}"));
  EXPECT_FALSE(grid.fault);
  EXPECT_NEAR(grid.sample_time, 0.01, 1e-9);
}

TEST(TimeGrid, AMissingRowIsFoundWhereItIs) {
  for (const auto& [sample_time, format] : {std::pair(1.0 / 6400.0, "{:.7f}"), std::pair(0.005, "{:.3f}"),
                                            std::pair(1.0, "{:.0f}"), std::pair(1.0 / 300.0, "{:.3f}")}) {
    for (const std::size_t lost : {1U, 500U, 998U}) {
      auto time = even(0.0, sample_time, 1000);
      time.erase(time.begin() + static_cast<std::ptrdiff_t>(lost));
      const auto grid = grid_of(print(time, format));
      ASSERT_TRUE(grid.fault) << format << " " << lost;
      EXPECT_EQ(grid.fault->row, lost) << format;
      EXPECT_NEAR(grid.fault->step, 2.0 * sample_time, 1.1e-3) << format;
      EXPECT_FALSE(grid.fault->reversed);
    }
  }
}

TEST(TimeGrid, AChangeOfRateAndALargeJitterAreFaults) {
  auto time = even(0.0, 0.01, 500);
  for (const double t : even(5.0, 0.012, 500)) {
    time.push_back(t);
  }
  EXPECT_TRUE(grid_of(print(time, "{:.6f}")).fault);

  std::mt19937 random(4);
  std::uniform_real_distribution<double> jitter(-0.1, 0.1);
  time = even(0.0, 0.01, 500);
  for (double& t : time) {
    t += 0.01 * jitter(random);
  }
  EXPECT_TRUE(grid_of(print(time, "{:.6f}")).fault);
}

/// 0, 1, 3 s may be three rows of an uneven record or of one with 1.5 s: with so few rows nobody can tell.
TEST(TimeGrid, AFewRowsInCoarseTimesAreFaultsUnlessTheyAreEven) {
  for (const std::vector<double>& time : {std::vector{0.0, 1.0, 3.0}, {0.0, 2.0, 3.0, 5.0}, {0.0, 1.0, 2.0, 4.0}}) {
    EXPECT_TRUE(grid_of(print(time, "{:.0f}")).fault) << time.back();
  }
  EXPECT_EQ(grid_of(print({0.0, 1.0, 2.0}, "{:.0f}")).sample_time, 1.0);
  const auto rounded = grid_of(print(even(0.0, 5.0 / 3.0, 30), "{:.0f}"));
  EXPECT_FALSE(rounded.fault) << "many rows tell";
}

TEST(TimeGrid, TimesThatRepeatOrRunBack) {
  auto time = even(0.0, 0.01, 100);
  time[50] = time[49];
  auto grid = grid_of(print(time, ""));
  ASSERT_TRUE(grid.fault);
  EXPECT_EQ(grid.fault->row, 50U);
  EXPECT_TRUE(grid.fault->reversed);

  grid = grid_of(print(even(0.0, 1.0 / 6400.0, 100), "{:.3f}"));
  ASSERT_TRUE(grid.fault) << "printed too coarsely";
  EXPECT_EQ(grid.fault->row, 1U);
  EXPECT_TRUE(grid.fault->reversed);
  EXPECT_TRUE(grid.fault->coarse);
}

TEST(TimeGrid, ExtremeTimesEndInAGridOrAFault) {
  for (const auto& text : {std::vector<std::string>{"-1e308", "1e308"},
                           {"0", "1e308", "1.5e308"},
                           {"0", "5e-324"},
                           {"0", "5e-324", "1e-323", "1.5e-323"},
                           {"1e300", "1e-300"},
                           {"0e-2147483648", "1e-300"},
                           {"-1e308", "0", "1e308"}}) {
    PrintedResolution resolution;
    std::vector<double> time;
    for (const auto& number : text) {
      time.push_back(parse_number(number).value);
      resolution.take(number);
    }
    const auto grid = find_time_grid(time, resolution);
    EXPECT_TRUE(grid.fault || (grid.sample_time > 0.0 && std::isfinite(grid.sample_time))) << text.front();
  }
}

}  // namespace
}  // namespace hysteron::records
