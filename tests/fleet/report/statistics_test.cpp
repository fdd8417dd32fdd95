// Robust statistics against closed forms.
#include "fleet/report/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "support/numbers.hpp"

namespace hysteron::fleet {
namespace {

TEST(FleetStatistics, TheilSenMindsNoOutlier) {
  const std::vector<double> x{0, 1, 2, 3, 4, 5, 6};
  EXPECT_EQ(theil_sen_slope(x, std::vector<double>{1, 3, 5, 7, 9, 11, 13}), 2.0);
  EXPECT_EQ(theil_sen_slope(x, std::vector<double>{1, 3, 500, 7, 9, 11, 13}), 2.0);
  EXPECT_TRUE(std::isnan(theil_sen_slope(std::vector<double>{1, 1}, std::vector<double>{1, 2})));
}

TEST(FleetStatistics, StudentIsThatOfTheClosedForms) {
  for (const double t : {0.0, 0.3, 1.0, 4.0, 40.0}) {
    // Of one degree of freedom it is Cauchy's, of two 1 − t/√(2 + t²).
    EXPECT_NEAR(student_both_tails(t, 1.0), 1.0 - 2.0 / std::numbers::pi * std::atan(t), 1e-12);
    EXPECT_NEAR(student_both_tails(-t, 2.0), 1.0 - t / std::sqrt(2.0 + t * t), 1e-12);
  }
  EXPECT_EQ(student_both_tails(not_a_number, 3.0), 1.0);
  EXPECT_EQ(student_both_tails(9.0, 0.0), 1.0);
  EXPECT_EQ(student_both_tails(infinity, 3.0), 0.0);
}

TEST(FleetStatistics, BinomialTail) {
  EXPECT_EQ(binomial_tail(0, 5, 0.1), 1.0);
  EXPECT_NEAR(binomial_tail(5, 5, 0.1), 1e-5, 1e-15);
  EXPECT_NEAR(binomial_tail(1, 5, 0.1), 1.0 - std::pow(0.9, 5), 1e-12);
}

TEST(FleetStatistics, BenjaminiHochbergOnTheirOwnExample) {
  // Table of 15 p in Benjamini and Hochberg (1995), section 3.2: the four smallest are findings at 5 %.
  const std::vector<double> p{0.0001, 0.0004, 0.0019, 0.0095, 0.0201, 0.0278, 0.0298, 0.0344,
                              0.0459, 0.3240, 0.4262, 0.5719, 0.6528, 0.7590, 1.0};
  EXPECT_EQ(threshold_of(p, 0.05), 0.0095);
  EXPECT_LT(threshold_of({0.5, 0.9}, 0.05), 0.0);
  EXPECT_LT(threshold_of({}, 0.05), 0.0);
}

}  // namespace
}  // namespace hysteron::fleet
