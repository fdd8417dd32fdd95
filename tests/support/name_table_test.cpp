#include "support/name_table.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace hysteron {
namespace {

TEST(NameTable, NumbersNamesInTheOrderOfTheirComing) {
  NameTable table;
  EXPECT_EQ(table.add("B").number, 0U);
  EXPECT_EQ(table.add("A").number, 1U);
  const auto again = table.add("B");
  EXPECT_EQ(again.number, 0U);
  EXPECT_FALSE(again.is_new);
  EXPECT_TRUE(table.add("").is_new);
  EXPECT_FALSE(table.add("").is_new);
  EXPECT_EQ(table.size(), 3U);
}

TEST(NameTable, NamesStayWhereTheyAreWhileItGrows) {
  NameTable table;
  std::vector<std::string_view> views;
  constexpr std::uint32_t count = 10'000;
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto entry = table.add("NAME" + std::to_string(i));
    ASSERT_TRUE(entry.is_new);
    ASSERT_EQ(entry.number, i);
    views.push_back(table[i]);
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::string name = "NAME" + std::to_string(i);
    EXPECT_EQ(views[i], name);
    EXPECT_EQ(views[i].data(), table[i].data());
    EXPECT_EQ(table.add(name).number, i);
  }
  EXPECT_EQ(table.size(), count);
}

}  // namespace
}  // namespace hysteron
