#include "support/root_mean_square.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "support/numbers.hpp"

namespace hysteron {
namespace {

double rms_of_all(const std::vector<double>& values) {
  RootMeanSquare rms;
  for (const double value : values) {
    rms.add(value);
  }
  return rms.value();
}

TEST(RootMeanSquare, IsTheTextbooksOnNumbersOfEverySize) {
  for (const double size : {1.0, 1e-12, 1e200, 1e-200, 1e300, 1e-300}) {
    EXPECT_NEAR(rms_of_all({3.0 * size, -4.0 * size}) / size, std::sqrt(12.5), 1e-14) << size;
    EXPECT_NEAR(rms_of_all({0.0, -4.0 * size, 3.0 * size, 0.0}) / size, 2.5, 1e-14) << size;
  }
  EXPECT_NEAR(rms_of_all({1e-200, 1e200}), 1e200 / std::sqrt(2.0), 1e185);
}

TEST(RootMeanSquare, OfZerosOfNoneAndOfWhatIsNoNumber) {
  EXPECT_EQ(rms_of_all({0.0, 0.0}), 0.0);
  EXPECT_TRUE(std::isnan(rms_of_all({})));
  EXPECT_TRUE(std::isnan(rms_of_all({1.0, not_a_number, 2.0})));
  EXPECT_FALSE(std::isfinite(rms_of_all({1.0, infinity, 2.0})));
}

}  // namespace
}  // namespace hysteron
