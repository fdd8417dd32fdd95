// The prior of a fleet, as it is written and as a diagnosis reads it.
#include "fleet/report/prior_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "diagnosis/prior.hpp"
#include "support/diagnostic.hpp"
#include "tests/support/scratch_folder.hpp"

namespace hysteron::fleet {
namespace {

using testing::HasSubstr;

class PriorOfAFleet : public testing::Test {
 protected:
  Row row(const std::string& machine, const std::string& group, const std::map<std::string, double>& families) {
    ++count_;
    const std::string log =
        folder.write(std::to_string(count_) + ".csv", "t,U\n0," + std::to_string(count_) + "\n");
    Row one{.unit = {.machine = machine, .group = group, .diagram = "a.st", .log = log},
            .result = {.status = Status::Done}};
    one.outcome.families = families;
    return one;
  }
  static std::string refusal(const std::vector<Row>& rows, const std::string& group) {
    try {
      return prior_json(rows, group, "fleet");
    } catch (const InputError& problem) {
      const Diagnostic& first = problem.diagnostics().all().front();
      return first.cause + " " + first.mend;
    }
  }
  test::ScratchFolder folder;
  int count_ = 0;
};

TEST_F(PriorOfAFleet, IsReadAsItWasWritten) {
  std::vector<Row> rows{row("A", "valves", {{"play", 0.8}, {"offset", not_a_number}}),
                        row("A", "valves", {{"play", 0.4}}), row("B", "valves", {}),
                        row("C", "axes", {{"dry_friction", 1.0}})};
  rows.push_back(row("D", "valves", {{"play", 1.0}}));
  rows.back().result.status = Status::Refused;  // says nothing
  rows.push_back(row("E", "valves", {{"play", 1.0}}));
  rows.back().unit.command = Command::Tune;
  const std::string file = folder.write("prior.json", prior_json(rows, "valves", "fleet"));
  const diagnosis::Prior all = diagnosis::read_prior(file, {});
  const diagnosis::Prior expected({{{"play", 0.6}}, {}});
  EXPECT_EQ(all.siblings(), 2U);
  EXPECT_NEAR(all.weight("play"), expected.weight("play"), 1e-12);
  EXPECT_NEAR(all.weight("dry_friction"), expected.weight("dry_friction"), 1e-12);
  const diagnosis::Prior others = diagnosis::read_prior(file, {rows[0].unit.log});
  EXPECT_NEAR(others.weight("play"), diagnosis::Prior({{{"play", 0.4}}, {}}).weight("play"), 1e-12);
  EXPECT_EQ(prior_json(rows, "valves", "fleet"), prior_json(rows, "valves", "other")) << "the same bytes";
}

TEST_F(PriorOfAFleet, IsOfOneGroup) {
  const std::vector<Row> rows{row("A", "valves", {}), row("C", "axes", {})};
  EXPECT_EQ(refusal(rows, ""),
            "The fleet has several groups, and a prior is of one. say --group with one of axes, valves.");
  EXPECT_EQ(refusal(rows, "pumps"), "The fleet has no group pumps. say --group with one of axes, valves.");
  EXPECT_THAT(refusal({rows[0]}, ""), HasSubstr("\"group\": \"valves\""));
  EXPECT_EQ(refusal({}, ""), "No record of the fleet was diagnosed. let `hysteron fleet` diagnose some first.");
}

}  // namespace
}  // namespace hysteron::fleet
