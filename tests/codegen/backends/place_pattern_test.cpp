// Texts that differ in the places of arrays alone, as one text in a loop.
#include "codegen/backends/shared/place_pattern.hpp"

#include <gtest/gtest.h>

namespace hysteron::testing {
namespace {

constexpr PlaceWords plain{.row = "i", .column = "k"};
constexpr PlaceWords careful{.row = "i", .column = "k", .number_end = "U", .brackets = true};

TEST(PlacePattern, APlaceGrowsByRowAndByColumn) {
  PlacePattern pattern("a[0] * x[0]");
  EXPECT_TRUE(pattern.takes("a[1] * x[1]", 0, 1));
  EXPECT_TRUE(pattern.takes("a[2] * x[2]", 0, 2));
  EXPECT_TRUE(pattern.takes("a[4] * x[0]", 1, 0));
  EXPECT_TRUE(pattern.takes("a[5] * x[1]", 1, 1));
  EXPECT_TRUE(pattern.takes("a[14] * x[2]", 3, 2));
  EXPECT_EQ(pattern.text(plain), "a[4 * i + k] * x[k]");
  EXPECT_EQ(pattern.text(careful), "a[(4U * i) + k] * x[k]");
}

TEST(PlacePattern, ARowOrAColumnThatIsNotCountedIsTheFirst) {
  PlacePattern pattern("a[3] * x[1]");
  ASSERT_TRUE(pattern.takes("a[4] * x[2]", 0, 1));
  ASSERT_TRUE(pattern.takes("a[8] * x[1]", 1, 0));
  EXPECT_EQ(pattern.text({.row = "i"}), "a[5 * i + 3] * x[1]");
  EXPECT_EQ(pattern.text({.column = "k"}), "a[k + 3] * x[k + 1]");
  EXPECT_EQ(pattern.text({}), "a[3] * x[1]");
}

/// Rows side by side: each is the same text, some rows further on, with a sum of its own.
TEST(PlacePattern, ALaterRowIsTheSamePatternFurtherOn) {
  PlacePattern pattern("a[3] + " + std::string(PlacePattern::sum) + " + x[0]");
  ASSERT_TRUE(pattern.takes("a[7] + " + std::string(PlacePattern::sum) + " + x[0]", 1, 0));
  EXPECT_EQ(pattern.text(careful, "total"), "a[(4U * i) + 3U] + total + x[0]");
  EXPECT_EQ(pattern.after_rows(2).text(careful, "total_3"), "a[(4U * i) + 11U] + total_3 + x[0]");
  EXPECT_EQ(pattern.after_rows(2).text({}, "s"), "a[11] + s + x[0]");
}

/// A place is counted in numbers without a sign: none between may be below 0.
TEST(PlacePattern, WhatGoesDownIsTakenOffLast) {
  PlacePattern pattern("a[6] - b[0]");
  ASSERT_TRUE(pattern.takes("a[4] - b[1]", 0, 1));
  ASSERT_TRUE(pattern.takes("a[9] - b[0]", 1, 0));
  EXPECT_EQ(pattern.text(careful), "a[(3U * i) + 6U - (2U * k)] - b[k]");
}

TEST(PlacePattern, WhatGrowsUnevenlyOrDiffersElsewhereIsNotTaken) {
  PlacePattern pattern("a[0] * x_0");
  EXPECT_FALSE(pattern.takes("a[1] * x_1", 0, 1));
  EXPECT_TRUE(pattern.takes("a[1] * x_0", 0, 1));
  EXPECT_FALSE(pattern.takes("a[3] * x_0", 0, 2));
  EXPECT_FALSE(pattern.takes("a[2] * x_0[1]", 0, 2));
  EXPECT_FALSE(pattern.takes("a[n] * x_0", 0, 2));
  EXPECT_TRUE(pattern.takes("a[2] * x_0", 0, 2));
}

/// What was not taken leaves no trace.
TEST(PlacePattern, ATextThatIsNotTakenSaysNothingOfSteps) {
  PlacePattern pattern("a[0] + b[0]");
  EXPECT_FALSE(pattern.takes("a[5] + b[0] + c", 1, 0));
  EXPECT_TRUE(pattern.takes("a[2] + b[0]", 1, 0));
  EXPECT_EQ(pattern.text(plain), "a[2 * i] + b[0]");
}

}  // namespace
}  // namespace hysteron::testing
