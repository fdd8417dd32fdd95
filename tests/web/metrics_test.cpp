// What a Prometheus server scrapes, read by the grammar of the text format: each family once, in one piece, with its
// HELP and TYPE before its samples, and no series twice.
#include "runtime/web/metrics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <regex>
#include <sstream>

#include "runtime/task/task_door.hpp"
#include "tests/runtime/task/accumulator.hpp"

namespace hysteron::runtime::web {
namespace {

struct Scraped {
  std::map<std::string, std::string> help{};    ///< by family
  std::map<std::string, std::string> type{};    ///< by family
  std::map<std::string, std::string> values{};  ///< by series, labels as they stand
};

/// Adds a failure for whatever the format does not allow.
Scraped scrape(const std::string& text) {
  static const std::regex help(R"(# HELP ([a-zA-Z_:][a-zA-Z0-9_:]*) ((?:[^\\\n]|\\\\|\\n)*))");
  static const std::regex type(R"(# TYPE ([a-zA-Z_:][a-zA-Z0-9_:]*) (counter|gauge))");
  static const std::regex sample(
      R"re(([a-zA-Z_:][a-zA-Z0-9_:]*)(\{[a-z]+="(?:[^"\\\n]|\\\\|\\"|\\n)*"(?:,[a-z]+="(?:[^"\\\n]|\\\\|\\"|\\n)*")*\}) (NaN|[+-]Inf|-?[0-9.]+(?:e[+-][0-9]+)?))re");
  Scraped scraped;
  std::string family;
  EXPECT_TRUE(text.ends_with('\n'));
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::smatch found;
    if (std::regex_match(line, found, help)) {
      family = found[1];
      EXPECT_TRUE(scraped.help.emplace(family, found[2]).second) << "twice: " << line;
    } else if (std::regex_match(line, found, type)) {
      EXPECT_EQ(found[1], family) << "TYPE follows HELP";
      EXPECT_TRUE(scraped.type.emplace(family, found[2]).second) << "twice: " << line;
      EXPECT_EQ(family.ends_with("_total"), found[2] == "counter") << line;
    } else if (std::regex_match(line, found, sample)) {
      EXPECT_EQ(found[1], family) << "a sample stands with its family";
      EXPECT_EQ(scraped.type.count(family), 1U) << "TYPE comes before " << line;
      EXPECT_TRUE(scraped.values.emplace(found[1].str() + found[2].str(), found[3]).second) << "twice: " << line;
    } else {
      ADD_FAILURE() << "no line of the format: " << line;
    }
  }
  return scraped;
}

Scraped scrape(const std::vector<Point>& points, const std::vector<double>& values) {
  return scrape(Metrics(points).text(values));
}

Point output(std::string name, std::string unit = "1") {
  return {.name = std::move(name), .kind = PointKind::output, .unit = std::move(unit)};
}

TEST(WebMetrics, EveryPointOfATaskButItsCommands) {
  test::Accumulator program;
  program.mutable_shape().parameters[0].unit = "mm";
  TaskDoor door(program, {{}}, {{}, {}});
  LoopStatistics statistics;
  statistics.run = 42;
  statistics.skipped = 3;
  statistics.lateness.add(1'234, 7);
  door.publish(program, std::vector{0.1}, std::vector{1.0 / 3.0, -2.0}, {.state = TaskState::running}, statistics);
  LiveValues live;
  door.read_live(live);
  const Scraped scraped = scrape(Metrics(door.points()).text(live.values));
  std::size_t shown = 0;
  std::ptrdiff_t counters = 0;
  for (const Point& point : door.points()) {
    shown += point.kind != PointKind::command ? 1U : 0U;
    counters += point.counts ? 1 : 0;
    EXPECT_FALSE(point.counts && point.writable) << point.name;
  }
  EXPECT_EQ(scraped.values.size(), shown);
  EXPECT_EQ(scraped.type.size(), shown) << "no two of them are one family";
  EXPECT_EQ(std::ranges::count_if(scraped.type, [](const auto& one) { return one.second == "counter"; }), counters);
  EXPECT_EQ(scraped.values.at("hysteron_task_cycles_total{point=\"task.cycles\"}"), "42");
  EXPECT_EQ(scraped.values.at("hysteron_task_skipped_total{point=\"task.skipped\"}"), "3");
  EXPECT_EQ(scraped.values.at("hysteron_task_lateness_worst_seconds{point=\"task.lateness_worst\"}"), "1.234e-06");
  EXPECT_EQ(scraped.values.at("hysteron_task_state{point=\"task.state\"}"), "1");
  EXPECT_EQ(scraped.type.at("hysteron_task_state"), "gauge");
  EXPECT_EQ(scraped.type.at("hysteron_task_worst_cycle"), "gauge") << "which cycle, not how many";
  EXPECT_EQ(scraped.values.at("hysteron_parameter_g_a{point=\"G.A\",unit=\"mm\"}"), "1");
  EXPECT_EQ(scraped.values.at("hysteron_input_x{point=\"X\",unit=\"V\"}"), "0.1");
  EXPECT_EQ(scraped.help.at("hysteron_task_cycles_total"), "cycles that were run");
  EXPECT_EQ(scraped.help.at("hysteron_parameter_g_a"), "the parameter G.A");
}

TEST(WebMetrics, ValuesThatAreNotFinite) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const Scraped scraped = scrape({output("A"), output("B"), output("C"), output("D", "ms"), output("E")},
                                 {std::numeric_limits<double>::quiet_NaN(), infinity, -infinity, 250.0, -1e300});
  EXPECT_EQ(scraped.values.at(R"(hysteron_output_a{point="A"})"), "NaN");
  EXPECT_EQ(scraped.values.at(R"(hysteron_output_b{point="B"})"), "+Inf");
  EXPECT_EQ(scraped.values.at(R"(hysteron_output_c{point="C"})"), "-Inf");
  EXPECT_EQ(scraped.values.at(R"(hysteron_output_d_seconds{point="D"})"), "0.25");
  EXPECT_EQ(scraped.values.at(R"(hysteron_output_e{point="E"})"), "-1e+300");
}

TEST(WebMetrics, TextsOfUsersAreEscaped) {
  Point point = output("A", "\"\\\nx\xFF");
  point.meaning = "first\nsecond \\ \"quoted\" \xC3";
  const Scraped scraped = scrape({point}, {1.0});
  EXPECT_EQ(scraped.help.at("hysteron_output_a"), "first\\nsecond \\\\ \"quoted\" \xEF\xBF\xBD");
  EXPECT_EQ(scraped.values.begin()->first, "hysteron_output_a{point=\"A\",unit=\"\\\"\\\\\\nx\xEF\xBF\xBD\"}");
}

TEST(WebMetrics, NamesThatBecomeOneAreOneFamily) {
  const Scraped scraped =
      scrape({output("A.B", "V"), output("OTHER"), output("A_B", "um"), output("a-b")}, {1.0, 2.0, 3.0, 4.0});
  EXPECT_EQ(scraped.type.size(), 2U);
  EXPECT_EQ(scraped.values.at(R"(hysteron_output_a_b{point="A.B",unit="V"})"), "1");
  EXPECT_EQ(scraped.values.at(R"(hysteron_output_a_b{point="A_B",unit="um"})"), "3");
  EXPECT_EQ(scraped.values.at(R"(hysteron_output_a_b{point="a-b"})"), "4");
}

TEST(WebMetrics, ALevelIsNoCounterByItsName) {
  for (const char* const name : {"FLOW_TOTAL", "PARTS.COUNT", "LAST_SUM", "OIL_BUCKET", "BATCH_INFO", "DAY_CREATED"}) {
    const Scraped scraped = scrape({output(name)}, {1.0});
    EXPECT_EQ(scraped.type.begin()->second, "gauge");
    EXPECT_TRUE(scraped.type.begin()->first.ends_with("_value")) << scraped.type.begin()->first;
  }
}

}  // namespace
}  // namespace hysteron::runtime::web
