// Fleets of which the truth is known: what drifts is found, what does not is not.
#include "fleet/report/analysis.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "fleet/report/fleet_data.hpp"
#include "fleet/report/fleet_page.hpp"
#include "fleet/report/words.hpp"

namespace hysteron::fleet {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr double day = 86400.0;
constexpr double begin = 1767225600.0;  // 2026-01-01

/// Friction of machines over weeks: their own value, scatter from record to record, and what `change` adds.
class MadeFleet {
 public:
  MadeFleet(std::size_t machines, std::size_t records, unsigned seed) : records_(records), random_(seed) {
    for (std::size_t i = 0; i < machines; ++i) {
      levels_.push_back(12.0 + 0.5 * normal());
    }
  }
  std::function<double(std::size_t machine, std::size_t record)> change = [](std::size_t, std::size_t) { return 0.0; };
  double scatter = 0.2;

  std::vector<Row> rows() {
    std::vector<Row> result;
    for (std::size_t i = 0; i < levels_.size(); ++i) {
      for (std::size_t k = 0; k < records_; ++k) {
        Row row{.unit = {.machine = "Axis " + std::to_string(i + 1),
                         .when = std::to_string(k),
                         .time = begin + 7.0 * day * static_cast<double>(k),
                         .group = "axes",
                         .command = Command::Tune},
                .key = std::to_string(i) + "-" + std::to_string(k),
                .result = {.status = Status::Done}};
        row.outcome.parameters.push_back({.source = "fit",
                                          .name = "FRICTION.FC",
                                          .value = levels_[i] + scatter * normal() + change(i, k),
                                          .standard_error = 0.1,
                                          .unit = "N"});
        result.push_back(std::move(row));
      }
    }
    return result;
  }

 private:
  double normal() { return distribution_(random_); }
  std::size_t records_;
  std::mt19937 random_;
  std::normal_distribution<double> distribution_;
  std::vector<double> levels_;
};

std::set<std::string> found_in(const Analysis& all) {
  std::set<std::string> machines;
  for (const Finding& one : all.findings) {
    machines.insert(one.machine);
  }
  return machines;
}

TEST(FleetAnalysis, OfAHealthyFleetHardlyAnythingIsFound) {
  std::size_t fleets_with_findings = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    MadeFleet fleet(50, 8, seed);
    const auto all = analysed(fleet.rows(), 0.05);
    EXPECT_EQ(all.tests, 100U);
    fleets_with_findings += all.findings.empty() ? 0 : 1;
  }
  // Where nothing is true, the share of false findings bounds the chance of any: 2 of 40 are expected, and 6 or fewer
  // have the probability 0.986 at that.
  EXPECT_LE(fleets_with_findings, 6U);
}

TEST(FleetAnalysis, ADriftIsFoundWithItsBeginAndItsEnds) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    MadeFleet fleet(30, 12, seed);
    fleet.change = [](std::size_t machine, std::size_t record) {
      return machine == 16 && record > 6 ? 1.2 * static_cast<double>(record - 6) : 0.0;
    };
    const auto rows = fleet.rows();
    const auto all = analysed(rows, 0.05);
    ASSERT_TRUE(found_in(all).contains("Axis 17")) << seed;
    const Finding& first = all.findings.front();
    EXPECT_EQ(first.machine, "Axis 17");
    const auto change = std::ranges::find(all.findings, Finding::What::Change, &Finding::what);
    ASSERT_NE(change, all.findings.end());
    const Trend& trend = all.tracks[change->index].trend;
    EXPECT_EQ(trend.change, Change::Ramp);
    EXPECT_NEAR(trend.since, begin + 42.0 * day, 8.0 * day);
    EXPECT_NEAR(trend.to - trend.from, 6.0, 0.8);
    EXPECT_THAT(sentence(all, *change), HasSubstr("FRICTION.FC grows since 2026-02-"));
    EXPECT_EQ(headline(all, rows).front(), std::to_string(all.machines_found) + " of 30 machines stand" +
                                               (all.machines_found == 1 ? "s" : "") + " out.");
  }
}

TEST(FleetAnalysis, AJumpIsNoRamp) {
  MadeFleet fleet(30, 12, 3);
  fleet.change = [](std::size_t machine, std::size_t record) { return machine == 4 && record >= 8 ? -3.0 : 0.0; };
  const auto all = analysed(fleet.rows(), 0.05);
  const auto change = std::ranges::find(all.findings, Finding::What::Change, &Finding::what);
  ASSERT_NE(change, all.findings.end());
  EXPECT_EQ(change->machine, "Axis 5");
  EXPECT_THAT(sentence(all, *change), HasSubstr("FRICTION.FC drops on 2026-02-26, from "));
}

TEST(FleetAnalysis, NoSingleRecordMakesAChange) {
  for (const std::size_t which : {std::size_t{0}, std::size_t{5}, std::size_t{11}}) {
    MadeFleet fleet(30, 12, 5);
    fleet.change = [&](std::size_t machine, std::size_t record) { return machine == 4 && record == which ? 8.0 : 0.0; };
    for (const Finding& one : analysed(fleet.rows(), 0.05).findings) {
      EXPECT_FALSE(one.machine == "Axis 5" && one.what == Finding::What::Change) << which;
    }
  }
}

TEST(FleetAnalysis, WhatItsIntervalsExplainIsNoChange) {
  MadeFleet fleet(30, 6, 7);
  fleet.change = [](std::size_t machine, std::size_t record) {
    return machine == 2 ? 0.8 * static_cast<double>(record) : 0.0;
  };
  auto rows = fleet.rows();
  EXPECT_TRUE(found_in(analysed(rows, 0.05)).contains("Axis 3"));
  for (Row& row : rows) {
    if (row.unit.machine == "Axis 3") {
      row.outcome.parameters[0].standard_error = 4.0;
    }
  }
  EXPECT_FALSE(found_in(analysed(rows, 0.05)).contains("Axis 3"));
}

TEST(FleetAnalysis, AMachineUnlikeItsSiblingsStandsOut) {
  MadeFleet fleet(40, 1, 9);
  fleet.change = [](std::size_t machine, std::size_t) { return machine == 20 ? 6.0 : 0.0; };
  auto rows = fleet.rows();
  const auto all = analysed(rows, 0.05);
  EXPECT_EQ(found_in(all), std::set<std::string>{"Axis 21"});
  EXPECT_THAT(sentence(all, all.findings.front()), HasSubstr("the median of 39 siblings is 1"));
  rows.resize(4);
  const auto few = analysed(rows, 0.05);
  EXPECT_EQ(few.tests, 0U) << "four have no median to stand out from";
  EXPECT_THAT(headline(few, rows).front(), HasSubstr("Nothing can be said of 4 machines yet"));
}

TEST(FleetAnalysis, AnEffectThatSiblingsDoNotHaveStandsOut) {
  std::vector<Row> rows;
  for (int machine = 0; machine < 20; ++machine) {
    for (int record = 0; record < 6; ++record) {
      Row row{.unit = {.machine = "M" + std::to_string(machine), .time = begin + day * record, .group = "g"},
              .key = "k",
              .result = {.status = Status::Done}};
      if ((machine == 7 && record >= 2) || (machine == 3 && record == 4)) {
        row.outcome.effects.push_back({.effect = "backlash", .edge = "Y", .named = true});
      }
      row.outcome.effects.push_back({.effect = "lag", .edge = "U", .named = true});
      rows.push_back(std::move(row));
    }
  }
  const auto all = analysed(rows, 0.05);
  ASSERT_EQ(found_in(all), std::set<std::string>{"M7"}) << "what all have, nobody stands out by; nor by one record";
  EXPECT_THAT(sentence(all, all.findings.front()),
              HasSubstr("backlash at Y is named in 4 of 6 records, since 2026-01-03"));
}

TEST(FleetAnalysis, ThePageEscapesNamesAndLeadsToEachRecord) {
  MadeFleet fleet(30, 12, 2);
  fleet.change = [](std::size_t machine, std::size_t record) {
    return machine == 3 ? static_cast<double>(record) : 0.0;
  };
  auto rows = fleet.rows();
  for (Row& row : rows) {
    row.unit.machine = row.unit.machine == "Axis 4" ? "<b>&\"4" : row.unit.machine;
  }
  rows[0].result = {.status = Status::Failed, .reason = "it was ended by signal 11. <script>"};
  rows[0].outcome = {};
  const auto all = analysed(rows, 0.05);
  const std::string page = fleet_page(all, rows, "../fleet");
  EXPECT_THAT(page, HasSubstr("&lt;b&gt;&amp;&quot;4"));
  EXPECT_THAT(page, Not(HasSubstr("<b>&\"4")));
  EXPECT_THAT(page, Not(HasSubstr("<script")));
  EXPECT_THAT(page, Not(HasSubstr("src=")));
  EXPECT_THAT(page, HasSubstr("<h2>Records without a result</h2>"));
  for (std::size_t i = 1; i < rows.size(); ++i) {
    EXPECT_THAT(page, HasSubstr("href=\"../fleet/units/" + rows[i].key + "/report.html\""));
  }
  const std::string csv = report_csv(all);
  EXPECT_EQ(std::ranges::count(csv, '\n'), 31);
  EXPECT_THAT(report_json(all, rows, "1"), HasSubstr("\"what\": \"change\""));
}

}  // namespace
}  // namespace hysteron::fleet
