#include "support/names.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace hysteron {
namespace {

/// Damerau's distance by its recursive definition, to check the table against.
std::size_t distance_by_definition(std::string_view a, std::string_view b) {
  if (a.empty() || b.empty()) {
    return a.size() + b.size();
  }
  const auto shorter = [](std::string_view text, std::size_t by) { return text.substr(0, text.size() - by); };
  std::size_t best =
      std::min({distance_by_definition(shorter(a, 1), b) + 1, distance_by_definition(a, shorter(b, 1)) + 1,
                distance_by_definition(shorter(a, 1), shorter(b, 1)) + (a.back() == b.back() ? 0 : 1)});
  if (a.size() > 1 && b.size() > 1 && a.back() == b[b.size() - 2] && a[a.size() - 2] == b.back()) {
    best = std::min(best, distance_by_definition(shorter(a, 2), shorter(b, 2)) + 1);
  }
  return best;
}

TEST(Names, EditDistanceFollowsItsDefinition) {
  std::mt19937 random(2);
  for (int i = 0; i < 2000; ++i) {
    const auto word = [&] {
      std::string text(random() % 6, 'A');
      std::generate(text.begin(), text.end(), [&] { return static_cast<char>('A' + random() % 3); });
      return text;
    };
    const auto a = word();
    const auto b = word();
    const auto expected = distance_by_definition(a, b);
    EXPECT_EQ(edit_distance(a, b, 10), expected) << a << " " << b;
    EXPECT_EQ(edit_distance(a, b, 2), std::min<std::size_t>(expected, 3)) << a << " " << b;
  }
}

TEST(Names, CaseDoesNotMatter) {
  EXPECT_EQ(edit_distance("hy_gain", "HY_GAIN", 3), 0U);
  EXPECT_TRUE(equal_ignoring_case("Inv", "INV"));
  EXPECT_FALSE(equal_ignoring_case("INV", "INW"));
  EXPECT_FALSE(equal_ignoring_case("INV", "INVE"));
  EXPECT_EQ(in_capitals("y_ref2é"), "Y_REF2é");
}

TEST(Names, NearestNameIsNearOrNone) {
  const std::vector<std::string> names{"HY_GAIN", "HY_LAG", "HY_LEAD_LAG", "HY_INTEGRAL", "C1", "C2"};
  EXPECT_EQ(nearest_name("HY_GAIM", names), "HY_GAIN");
  EXPECT_EQ(nearest_name("hy_integarl", names), "HY_INTEGRAL");
  EXPECT_EQ(nearest_name("HY_LEADLAG", names), "HY_LEAD_LAG");
  EXPECT_EQ(nearest_name("MOTOR", names), "");
  EXPECT_EQ(nearest_name("C3", names), "") << "both C1 and C2 would be a guess";
  EXPECT_EQ(nearest_name("", names), "");
}

}  // namespace
}  // namespace hysteron
