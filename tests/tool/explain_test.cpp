// hysteron diagnose --explain and --without: which rules decided, and a verdict without one of them.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <string>

#include "records/csv.hpp"
#include "tests/diagnosis/simulated_machine.hpp"
#include "tests/tool/workbench.hpp"

namespace hysteron {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

TEST(Explain, TellsTheRulesThatDecidedAndLeavesOneOut) {
  const test::Workbench bench;
  bench.write("plant.st", test::axis());
  bench.write("p.toml", test::axis_parameters);
  const std::string machine = test::axis({"HY_LOAD := (SIZE := 0.3, T_ON := 2.0)", "FORCE"});
  bench.write("log.csv", records::csv_text(test::measured(test::program_of(machine),
                                                          test::record_of("FORCE", test::rich_force(1200)), 0.001)));
  // The load is not among what is tried, so that something is left for the rules.
  const std::string asked =
      "hysteron diagnose plant.st --log log.csv --params p.toml --out found --effects lag --explain";
  const auto explained = bench.shell(asked);
  ASSERT_EQ(explained.code, 0) << explained.err;
  const json decisions = json::parse(bench.read("found/verdict.json"))["decisions"];
  ASSERT_FALSE(decisions.empty());
  for (const json& one : decisions) {
    const double measured = one["measured"];
    EXPECT_EQ(one["outcome"] == "above" || one["outcome"] == "held down", measured > one["threshold"]) << one;
    EXPECT_THAT(explained.out, HasSubstr(fmt::format("  rule: {}", one["rule"].get<std::string>())));
  }
  const std::string rule = decisions[0]["rule"];
  const auto without = bench.shell(asked + fmt::format(" --without \"{}\"", rule));
  ASSERT_EQ(without.code, 0) << without.err;
  for (const json& one : json::parse(bench.read("found/verdict.json"))["decisions"]) {
    EXPECT_TRUE(one["rule"] != rule || one["threshold"].is_null() || one["threshold"] == 0.0) << one;
  }
  const auto none = bench.shell(asked + " --without relevance");
  EXPECT_EQ(none.code, 2);
  EXPECT_THAT(none.err, AllOf(HasSubstr("HY730 error: There is no rule relevance"), HasSubstr("relevant")));
}

}  // namespace
}  // namespace hysteron
