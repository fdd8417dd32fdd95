// Names of other libraries: every row names a block that there is, the page shows the rows, and a mend uses them.
#include "codegen/graph/other_names.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <fstream>
#include <memory>
#include <set>
#include <string>

#include "codegen/compile.hpp"
#include "codegen/trace/block_type.hpp"
#include "support/errors.hpp"

namespace hysteron::testing {
namespace {

TEST(OtherNames, NameBlocksThatThereAre) {
  for (const OtherName& one : other_names()) {
    EXPECT_NE(find_block_type(one.block), nullptr) << one.name << " → " << one.block;
    const BlockType* const own = find_block_type("HY_" + std::string(one.name));
    EXPECT_TRUE(own == nullptr || own->about.name == one.block || one.name == "DELAY")
        << one.name << " is a block of the library under its own name";
  }
}

TEST(OtherNames, ThePageHasTheRows) {
  std::ifstream file(HYSTERON_SOURCE_DIR "/docs/reference/other-names.md");
  std::set<std::string> lines;
  std::size_t shown = 0;
  for (std::string line; std::getline(file, line);) {
    shown += line.find("](blocks/HY_") != std::string::npos ? 1U : 0U;
    lines.insert(line);
  }
  for (const OtherName& one : other_names()) {
    const std::string row =
        fmt::format("| {} | {} | [{}](blocks/{}.md) | {} |", one.name, one.library, one.block, one.block, one.differs);
    EXPECT_TRUE(lines.contains(row)) << row;
  }
  EXPECT_EQ(shown, other_names().size()) << "the page has rows that the table has not";
}

TEST(OtherNames, AreTakenWithoutCaseSpacesAndSigns) {
  for (const std::string_view name : {"Unit Delay", "UnitDelay", "unit_delay", "HY_UNIT_DELAY"}) {
    EXPECT_EQ(block_of_other_name(name), "HY_DELAY") << name;
  }
  EXPECT_EQ(block_of_other_name("ft_pt1"), "HY_LAG");
  EXPECT_EQ(block_of_other_name("Transfer Fcn Lead or Lag"), "HY_LEAD_LAG");
  EXPECT_EQ(block_of_other_name("NOTHING_LIKE_IT"), "");
}

TEST(OtherNames, AreWhatAnUnknownBlockMayMean) {
  Diagnostics found;
  check(std::make_shared<const language::SourceFile>(language::parse(
            "t",
            "FUNCTION_BLOCK F VAR_INPUT X : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR VAR L : FT_PT1; "
            "END_VAR L(IN := X); Y := L.OUT; END_FUNCTION_BLOCK",
            found)),
        found);
  ASSERT_FALSE(found.all().empty());
  EXPECT_EQ(found.all().front().number, error::unknown_block);
  EXPECT_THAT(found.all().front().mend, ::testing::HasSubstr("Did you mean HY_LAG?"));
}

}  // namespace
}  // namespace hysteron::testing
