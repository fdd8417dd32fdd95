// hysteron blocks: the catalogue, printed from the descriptions.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "codegen/trace/sized_block.hpp"
#include "tests/tool/workbench.hpp"

namespace hysteron {
namespace {

using testing::AllOf;
using testing::HasSubstr;

TEST(Blocks, ListNamesEveryBlockOnce) {
  const test::Workbench bench;
  const auto outcome = bench.shell("hysteron blocks");
  EXPECT_EQ(outcome.code, 0);
  for (const BlockType* const block : documented_blocks()) {
    const auto line = "\n  " + std::string(block->about.name) + " ";
    const auto first = outcome.out.find(line);
    ASSERT_NE(first, std::string::npos) << line;
    EXPECT_EQ(outcome.out.find(line, first + 1), std::string::npos) << line;
  }
}

/// A word that names no block is looked for: in names and titles first, then in what the blocks mean.
TEST(Blocks, AWordIsLookedFor) {
  const test::Workbench bench;
  const auto outcome = bench.shell("hysteron blocks friction");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("  HY_COULOMB_FRICTION "), HasSubstr("  HY_DAHL_FRICTION "),
                                 testing::Not(HasSubstr("HY_GAIN "))));
  const auto slip = bench.shell("hysteron blocks stick-slip");
  EXPECT_THAT(slip.out, HasSubstr("HY_STRIBECK_FRICTION"));
  EXPECT_EQ(nlohmann::json::parse(bench.shell("hysteron blocks dahl --json").out).at(0).at("name"), "HY_DAHL_FRICTION");
  EXPECT_EQ(bench.shell("hysteron blocks xyzzy").code, 2);
  EXPECT_EQ(bench.shell("hysteron blocks dead time").out, bench.shell("hysteron blocks HY_DEAD_TIME").out);
  EXPECT_EQ(bench.shell("hysteron blocks dead xyzzy").code, 2);
}

TEST(Blocks, CardOfOneBlock) {
  const test::Workbench bench;
  const auto outcome = bench.shell("hysteron blocks hy_lag");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("HY_LAG: "), HasSubstr("\nparameters\n"), HasSubstr("  T1 "),
                                 HasSubstr("must be connected"), HasSubstr("\nfeedthrough")));
  EXPECT_EQ(outcome.out, bench.shell("hysteron blocks lag").out);
}

/// Who looks for hysteresis finds the standard's switch first; the card leads on to the models.
TEST(Blocks, ACardNamesTheBlocksThatAreNamedAfterIt) {
  const test::Workbench bench;
  EXPECT_THAT(bench.shell("hysteron blocks hysteresis").out,
              AllOf(HasSubstr("HY_HYSTERESIS: "), HasSubstr("\nfurther blocks of the name\n"),
                    HasSubstr("  HY_HYSTERESIS_RO ")));
  EXPECT_THAT(bench.shell("hysteron blocks HY_CREEP").out, testing::Not(HasSubstr("further blocks")));
}

TEST(Blocks, FeedthroughIsByPairOfPins) {
  const test::Workbench bench;
  const auto integral = nlohmann::json::parse(bench.shell("hysteron blocks HY_INTEGRAL --json").out);
  EXPECT_EQ(integral["feedthrough"]["XOUT"], nlohmann::json({"XIN", "RUN", "R1", "X0"}));
  EXPECT_EQ(integral["feedthrough"]["Q"], nlohmann::json({"R1"}));
  EXPECT_EQ(integral["inputs"][1]["default"], 1.0);
  EXPECT_FALSE(integral["inputs"][0].contains("default"));
  const auto delay = nlohmann::json::parse(bench.shell("hysteron blocks HY_DELAY --json").out);
  EXPECT_FALSE(testing::Value(delay["feedthrough"]["XOUT"], testing::Contains("XIN")));
}

TEST(Blocks, JsonHoldsTheCatalogue) {
  const test::Workbench bench;
  const auto list = nlohmann::json::parse(bench.shell("hysteron blocks --json").out);
  std::set<std::string> names;
  for (const auto& block : list) {
    names.insert(block["name"]);
    EXPECT_NE(block["equation"], "");
    EXPECT_NE(block["meaning"], "");
  }
  EXPECT_EQ(names.size(), documented_blocks().size());
}

TEST(Blocks, MarkdownHasASectionForEach) {
  const test::Workbench bench;
  const auto text = bench.shell("hysteron blocks --markdown").out;
  for (const BlockType* const block : documented_blocks()) {
    EXPECT_THAT(text, HasSubstr("\n### " + std::string(block->about.name) + ": "));
  }
}

TEST(Blocks, MistypedNames) {
  const test::Workbench bench;
  const auto outcome = bench.shell("hysteron blocks HY_GIAN");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.err,
            "HY201 error: There is no block HY_GIAN in the library.\nmend: did you mean HY_GAIN?\n\n1 error\n");
  EXPECT_THAT(bench.shell("hysteron blocks zzzzzzzz").err, HasSubstr("`hysteron blocks` lists them."));
}

}  // namespace
}  // namespace hysteron
