// Whole numbers from text: what is none is none for every type, and limits are the type's or narrower.
#include "support/whole_number.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <string>

namespace hysteron {
namespace {

TEST(WholeNumber, TheWholeTextCountsOrNone) {
  EXPECT_EQ(whole_number<int>("42"), 42);
  EXPECT_EQ(whole_number<int>("-42"), -42);
  EXPECT_EQ(whole_number<int>("007"), 7);
  for (const char* const text : {"", "-", "+1", " 1", "1 ", "1.0", "1e3", "0x10", "1,000", "one", "--1", "1\n"}) {
    EXPECT_EQ(whole_number<int>(text), std::nullopt) << '"' << text << '"';
    EXPECT_EQ(whole_number<std::uint64_t>(text), std::nullopt) << '"' << text << '"';
  }
  EXPECT_EQ(whole_number<unsigned>("-1"), std::nullopt) << "and no number beyond 4 billion";
}

TEST(WholeNumber, ItIsWithinTheTypeAndTheLimits) {
  const std::string most = std::to_string(std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(whole_number<std::uint64_t>(most), std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(whole_number<std::uint64_t>(most + "0"), std::nullopt);
  EXPECT_EQ(whole_number<std::uint16_t>("65536"), std::nullopt);
  EXPECT_EQ(whole_number(std::to_string(std::numeric_limits<int>::min()), std::numeric_limits<int>::min()),
            std::numeric_limits<int>::min());
  EXPECT_EQ(whole_number("1", 1U, 32U), 1U);
  EXPECT_EQ(whole_number("32", 1U, 32U), 32U);
  EXPECT_EQ(whole_number("0", 1U, 32U), std::nullopt);
  EXPECT_EQ(whole_number("33", 1U, 32U), std::nullopt);
}

TEST(WholeNumber, AnotherBaseHasItsDigits) {
  EXPECT_EQ(whole_number("fF", 0U, 1000U, 16), 255U);
  EXPECT_EQ(whole_number("g", 0U, 1000U, 16), std::nullopt);
}

}  // namespace
}  // namespace hysteron
