// The next experiment: it keeps to the limits, and it separates the rivals as far as it says.
#include "diagnosis/remedy/next_experiment.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "diagnosis/remedy/excitations.hpp"
#include "tuning/simulation.hpp"

namespace hysteron::diagnosis {
namespace {

TEST(Excitations, KeepToRangeRateAndLength) {
  const std::vector<InputLimits> all{
      {.name = "U", .unit = "V", .low = 0.0, .high = 3.6, .rate = 12.0, .sample_time = 0.005, .duration = 80.0},
      {.name = "U", .unit = "V", .low = -1.0, .high = 1.0, .rate = 400.0, .sample_time = 1e-4, .duration = 4.0},
      {.name = "U", .low = 20.0, .high = 80.0, .rate = 60.0, .start = 20.0, .sample_time = 1.0, .duration = 4000.0}};
  for (const InputLimits& limits : all) {
    const std::vector<Excitation> found = excitations(limits);
    EXPECT_GE(found.size(), 7U);
    for (const Excitation& one : found) {
      SCOPED_TRACE(one.title);
      EXPECT_LE(one.values.size(), longest_command);
      EXPECT_FALSE(one.steps.empty());
      EXPECT_EQ(one.values.front(), limits.start);
      const double allowance = 1e-9 * (limits.high - limits.low);
      double longest = 0.0;
      for (std::size_t k = 1; k < one.values.size(); ++k) {
        longest = std::max(longest, std::abs(one.values[k] - one.values[k - 1]));
      }
      EXPECT_LE(longest, limits.rate * limits.sample_time + allowance);
      EXPECT_GE(std::ranges::min(one.values), limits.low - allowance);
      EXPECT_LE(std::ranges::max(one.values), limits.high + allowance);
    }
  }
}

TEST(Excitations, NoneWithoutRoom) {
  EXPECT_TRUE(excitations({.low = 1.0, .high = 1.0, .rate = 1.0, .sample_time = 0.1, .duration = 10.0}).empty());
  EXPECT_TRUE(excitations({.low = 0.0, .high = 1.0, .rate = 0.0, .sample_time = 0.1, .duration = 10.0}).empty());
}

constexpr double sample_time = 0.005;

/// A plant of gain 10 with one block on its input.
struct Plant {
  std::string effect{};
  std::string block{};
  std::vector<Unknown> unknowns{};
  std::vector<double> values{};
};

std::string text_of(const Plant& plant) {
  return fmt::format(
      "FUNCTION_BLOCK PLANT (* @ts 5ms *) VAR_INPUT U : LREAL; (* @unit V *) END_VAR VAR_OUTPUT Y : LREAL; (* @unit um "
      "*)"
      " END_VAR VAR E : {}; G : HY_GAIN := (K := 10.0); END_VAR E(XIN := U); G(XIN := E.XOUT); Y := G.XOUT; "
      "END_FUNCTION_BLOCK",
      plant.block);
}

Explanation explanation_of(const Plant& plant) {
  Explanation result;
  result.variant.text = text_of(plant);
  result.variant.program = std::make_shared<const Program>(compile_text(result.variant.text));
  result.variant.further = plant.unknowns;
  Applied applied{.effect = plant.effect, .block = plant.block, .edge = "U", .instance = "E"};
  for (const Unknown& unknown : plant.unknowns) {
    applied.parameters.push_back({.strength = true});
    applied.paths.push_back(unknown.path);
  }
  result.variant.effects.push_back(applied);
  result.fit.x.resize(1 + std::ssize(plant.values));
  result.fit.x[0] = 10.5;
  for (std::size_t j = 0; j < plant.values.size(); ++j) {
    result.fit.x[1 + static_cast<Index>(j)] = plant.values[j];
  }
  return result;
}

Unknown unknown(const std::string& path, double lower, double upper) {
  return {
      .path = path, .start = 0.5 * (lower + upper), .lower = lower, .upper = upper, .typical = 0.1 * (upper - lower)};
}

/// A record of 20 s of a sine of 1 Hz between 0 and 3.6 V.
Task task() {
  Task result;
  records::Record record = records::Record::even(0.0, sample_time, 4000);
  std::vector<double> u(4000);
  for (std::size_t k = 0; k < u.size(); ++k) {
    u[k] = 1.8 - 1.8 * std::cos(2.0 * std::numbers::pi * sample_time * static_cast<double>(k));
  }
  record.add({.name = "U", .unit = "V", .values = u});
  record.add({.name = "Y", .unit = "um", .values = u});
  result.records = {record};
  result.outputs = {"Y"};
  result.known = {unknown("G.K", 1.0, 100.0)};
  result.scales = {0.02};
  return result;
}

const Plant lag{.effect = "lag", .block = "HY_LAG", .unknowns = {unknown("E.T1", 0.0, 1.0)}, .values = {0.02}};
const Plant delay{
    .effect = "delay", .block = "HY_DEAD_TIME", .unknowns = {unknown("E.DEAD_TIME", 0.0, 1.0)}, .values = {0.02}};
const Plant creep{.effect = "creep",
                  .block = "HY_CREEP",
                  .unknowns = {unknown("E.GAIN", -1.0, 1.0), unknown("E.T_ONSET", 0.01, 10.0)},
                  .values = {0.05, 0.1}};
const Plant drift{
    .effect = "drift", .block = "HY_DRIFT", .unknowns = {unknown("E.RATE", -1.0, 1.0)}, .values = {0.004}};
const Plant rate_limit{.effect = "rate_limit",
                       .block = "HY_RATE_LIMIT := (RISE := 9.0)",
                       .unknowns = {unknown("E.FALL", 1.0, 100.0)},
                       .values = {9.0}};
const Plant backlash{
    .effect = "backlash", .block = "HY_BACKLASH", .unknowns = {unknown("E.WIDTH", 0.0, 1.0)}, .values = {0.1}};

NextExperiment between(const Plant& a, const Plant& b) {
  const std::vector<Explanation> rivals{explanation_of(a), explanation_of(b)};
  return next_experiment(task(), rivals, {}, 0.02);
}

/// The outputs of both plants, the gain of the second refitted: RMS of what is left, over the noise.
double left_with_gain_refitted(const Plant& a, const Plant& b, const NextExperiment& next) {
  records::Record record = records::Record::even(0.0, sample_time, next.values.size());
  record.add({.name = "U", .unit = "V", .values = next.values});
  const std::vector<double> y = simulate(fitted_program(task(), explanation_of(a)), record).front();
  const std::vector<double> z = simulate(fitted_program(task(), explanation_of(b)), record).front();
  double yz = 0.0;
  double zz = 0.0;
  for (std::size_t k = 0; k < y.size(); ++k) {
    yz += y[k] * z[k];
    zz += z[k] * z[k];
  }
  double sum = 0.0;
  for (std::size_t k = 0; k < y.size(); ++k) {
    sum += std::pow(y[k] - yz / zz * z[k], 2);
  }
  return std::sqrt(sum / static_cast<double>(y.size())) / 0.02;
}

TEST(NextExperiment, FittedProgramHasTheFittedValues) {
  const Program program = fitted_program(task(), explanation_of(creep));
  const auto value = [&](std::string_view path) {
    return program.graph.parameters[static_cast<std::size_t>(find_parameter(program.graph, path))].value.front();
  };
  EXPECT_EQ(value("G.K"), 10.5);
  EXPECT_EQ(value("E.GAIN"), 0.05);
  EXPECT_EQ(value("E.T_ONSET"), 0.1);
}

TEST(NextExperiment, SeparatesAtLeastAsMuchAsItSays) {
  const std::vector<std::pair<Plant, Plant>> pairs{{lag, delay}, {creep, drift}, {rate_limit, lag}, {backlash, lag}};
  for (const auto& [a, b] : pairs) {
    SCOPED_TRACE(a.effect + " or " + b.effect);
    const NextExperiment next = between(a, b);
    EXPECT_EQ(next.input, "U");
    EXPECT_EQ(next.unit, "V");
    ASSERT_EQ(next.time.size(), next.values.size());
    EXPECT_FALSE(next.steps.empty());
    EXPECT_GT(next.separation, 1.0);
    // The gain alone absorbs no more than the gain and the effect's parameters together.
    EXPECT_GE(left_with_gain_refitted(a, b, next), 0.99 * next.separation);
    EXPECT_NE(next.reason.find(a.effect), std::string::npos) << next.reason;
    RecordProperty(a.effect + "_" + b.effect, fmt::format("{}: {:.3g}", next.title, next.separation));
  }
}

TEST(NextExperiment, ChoosesWhatThePairCallsFor) {
  EXPECT_EQ(between(lag, delay).title, "multisine");
  EXPECT_EQ(between(creep, drift).title, "staircase up and down, with short and long dwells");
}

TEST(NextExperiment, IsTheSameEachTime) {
  const NextExperiment first = between(lag, delay);
  const NextExperiment second = between(lag, delay);
  EXPECT_EQ(first.values, second.values);
  EXPECT_EQ(first.separation, second.separation);
  EXPECT_EQ(first.reason, second.reason);
}

TEST(NextExperiment, KeepsToTheLimitsOfTheUser) {
  const std::vector<Explanation> rivals{explanation_of(lag), explanation_of(delay)};
  const NextExperiment narrow = next_experiment(task(), rivals, {{"u", 1.0}, {"U.rate", 3.0}}, 0.02);
  EXPECT_LE(std::ranges::max(narrow.values), 1.0 + 1e-9);
  EXPECT_GE(std::ranges::min(narrow.values), -1e-9);
  for (std::size_t k = 1; k < narrow.values.size(); ++k) {
    ASSERT_LE(std::abs(narrow.values[k] - narrow.values[k - 1]), 3.0 * sample_time + 1e-9);
  }
  EXPECT_LT(narrow.separation, next_experiment(task(), rivals, {}, 0.02).separation);
  const NextExperiment middle = next_experiment(task(), rivals, {{"U.low", 1.0}, {"U.high", 2.0}}, 0.02);
  EXPECT_LE(std::ranges::max(middle.values), 2.0 + 1e-9);
  EXPECT_GE(std::ranges::min(middle.values), 1.0 - 1e-9);
}

TEST(NextExperiment, SharpensASingleExplanation) {
  const std::vector<Explanation> one{explanation_of(creep), explanation_of(creep)};
  const NextExperiment next = next_experiment(task(), one, {}, 0.02);
  EXPECT_NE(next.title, "");
  EXPECT_GT(next.separation, 0.0);
  EXPECT_NE(next.reason.find("shows creep best"), std::string::npos) << next.reason;
}

TEST(NextExperiment, NoneWhereNothingWouldTell) {
  Plant nothing = lag;
  nothing.values = {1e-9};
  Plant neither = delay;
  neither.values = {1e-9};
  const NextExperiment pair = between(nothing, neither);
  EXPECT_EQ(pair.title, "");
  EXPECT_TRUE(pair.values.empty());
  EXPECT_NE(pair.reason.find("would tell lag from delay"), std::string::npos) << pair.reason;
  const std::vector<Explanation> one{explanation_of(nothing)};
  const NextExperiment alone = next_experiment(task(), one, {}, 0.02);
  EXPECT_EQ(alone.title, "");
  EXPECT_NE(alone.reason.find("would show lag"), std::string::npos) << alone.reason;
}

TEST(NextExperiment, NamesTheDiagramWithoutAnEffect) {
  Plant nothing = lag;
  nothing.values = {1e-9};
  Plant neither = delay;
  neither.values = {1e-9};
  Explanation plain = explanation_of(nothing);
  plain.variant.effects.clear();
  const std::vector<Explanation> one{plain};
  const NextExperiment alone = next_experiment(task(), one, {}, 0.02);
  EXPECT_NE(alone.reason.find("shows the fitted parameters best: more than 1000 times the noise"), std::string::npos)
      << alone.reason;
  const std::vector<Explanation> two{explanation_of(neither), plain};
  const NextExperiment pair = next_experiment(task(), two, {}, 0.02);
  EXPECT_NE(pair.reason.find("would tell delay from the fitted parameters alone"), std::string::npos) << pair.reason;
}

TEST(NextExperiment, NothingWhereNoInputMoves) {
  Task still = task();
  records::Record record = records::Record::even(0.0, sample_time, 4000);
  record.add({.name = "U", .unit = "V", .values = std::vector<double>(4000, 1.0)});
  record.add({.name = "Y", .unit = "um", .values = std::vector<double>(4000, 10.0)});
  still.records = {record};
  const std::vector<Explanation> rivals{explanation_of(lag), explanation_of(delay)};
  EXPECT_EQ(next_experiment(still, rivals, {}, 0.02).title, "");
  EXPECT_EQ(next_experiment(task(), {}, {}, 0.02).title, "");
}

}  // namespace
}  // namespace hysteron::diagnosis
