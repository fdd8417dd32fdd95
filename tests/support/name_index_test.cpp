#include "support/name_index.hpp"

#include <gtest/gtest.h>

#include <string>
#include <utility>

namespace hysteron {
namespace {

TEST(NameIndex, FindsNamesInAnyCase) {
  NameIndex index;
  EXPECT_TRUE(index.add("Lag1", 7));
  EXPECT_FALSE(index.add("LAG1", 8));
  ASSERT_NE(index.find("lag1"), nullptr);
  EXPECT_EQ(*index.find("lag1"), 7U);
  EXPECT_EQ(index.at("LAG1"), 7U);
  EXPECT_FALSE(index.contains("LAG"));
  EXPECT_FALSE(index.contains("LAG10"));
  EXPECT_FALSE(index.contains(""));
  EXPECT_TRUE(index.add("", 9));
  EXPECT_EQ(index.at(""), 9U);
  EXPECT_EQ(index.size(), 2U);
}

// The hash sets a bit that tells small letters from capitals, and so takes these for the same.
TEST(NameIndex, TellsCharactersApartThatDifferByThatBitAlone) {
  NameIndex index;
  EXPECT_TRUE(index.add("A[1", 1));
  EXPECT_TRUE(index.add("A{1", 2));
  EXPECT_TRUE(index.add("A\x10", 3));
  EXPECT_TRUE(index.add("A0", 4));
  EXPECT_EQ(index.at("a[1"), 1U);
  EXPECT_EQ(index.at("a{1"), 2U);
  EXPECT_EQ(index.at("a\x10"), 3U);
  EXPECT_EQ(index.at("a0"), 4U);
}

TEST(NameIndex, KeepsItsNamesWhileItGrowsAndMoves) {
  NameIndex index;
  constexpr std::uint32_t count = 10'000;
  index.reserve(100);
  for (std::uint32_t i = 0; i < count; ++i) {
    ASSERT_TRUE(index.add("INSTANCE_OF_A_LONG_NAME_" + std::to_string(i), 3 * i));
  }
  const NameIndex copy = index;
  const NameIndex moved = std::move(index);
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::string name = "instance_of_a_long_name_" + std::to_string(i);
    EXPECT_EQ(copy.at(name), 3 * i);
    EXPECT_EQ(moved.at(name), 3 * i);
  }
  EXPECT_FALSE(copy.contains("INSTANCE_OF_A_LONG_NAME_10000"));
}

}  // namespace
}  // namespace hysteron
