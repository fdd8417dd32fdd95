#include "diagnosis/report/html.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace hysteron::diagnosis::report {
namespace {

using ::testing::ElementsAre;
using ::testing::Pair;

TEST(PercentsOfAWhole, SumToAHundred) {
  EXPECT_THAT(percents_of_whole({0.307, 0.286, 0.274, 0.133}), ElementsAre("31 %", "29 %", "27 %", "13 %"));
  EXPECT_THAT(percents_of_whole({0.458, 0.327, 0.191, 0.024}), ElementsAre("46 %", "33 %", "19 %", "2 %"));
  EXPECT_THAT(percents_of_whole({0.0, 1.0, 0.0}), ElementsAre("0 %", "100 %", "0 %"));
  for (int parts = 1; parts < 9; ++parts) {
    int sum = 0;
    for (const std::string& one :
         percents_of_whole(std::vector<double>(static_cast<std::size_t>(parts), 1.0 / parts))) {
      sum += std::stoi(one);
    }
    EXPECT_EQ(sum, 100) << parts;
  }
}

TEST(PercentsOfAWhole, WhatIsThereIsNotNothing) {
  EXPECT_THAT(percents_of_whole({0.9995, 0.0, 0.0005}), ElementsAre("> 99 %", "0 %", "below 1 %"));
}

/// An interval is never printed as a point.
TEST(IntervalEnds, AreToldApart) {
  EXPECT_THAT(interval_ends(0.079996, 0.080004), Pair("0.079996", "0.080004"));
  EXPECT_THAT(interval_ends(0.07994, 0.08004), Pair("0.07994", "0.08004"));
  EXPECT_THAT(interval_ends(1.0, 2.0), Pair("1", "2"));
}

}  // namespace
}  // namespace hysteron::diagnosis::report
