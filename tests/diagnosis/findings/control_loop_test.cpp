// What the swing of a control loop says of its valve: loops with a valve that sticks, and with a disturbance from
// outside.
#include "diagnosis/findings/control_loop.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "diagnosis/stages/proposals.hpp"
#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

using ::testing::HasSubstr;

/// A PI controller, a valve that moves once the controller has gone on by `band`, a lag; sampled each second.
struct Loop {
  double gain = 0.6;
  double reset = 8.0;    ///< s
  double lag = 6.0;      ///< s
  double band = 0.0;     ///< of the valve, % of its stroke
  double swing = 0.0;    ///< of a disturbance from outside at the output
  double period = 60.0;  ///< s, of that one
  double begin = 50.0;   ///< of the output
  double noise = 0.01;
  std::uint64_t seed = 1;
};

struct Logged {
  std::vector<double> op{};
  std::vector<double> pv{};
};

Logged logged(const Loop& loop, std::size_t samples = 1500) {
  test::Noise noise(loop.seed);
  Logged result;
  double integral = 0.0;
  double valve = 50.0;
  double level = loop.begin;
  double op = 50.0;
  for (std::size_t k = 0; k < samples; ++k) {
    valve = std::abs(op - valve) > loop.band ? op : valve;
    level += (valve - level) / loop.lag;
    const double pv =
        level + loop.swing * std::sin(test::two_pi * static_cast<double>(k) / loop.period) + loop.noise * noise();
    const double error = 50.3 - pv;
    integral += error / loop.reset;
    op = 50.0 + loop.gain * (error + integral);
    result.op.push_back(op);
    result.pv.push_back(pv);
  }
  return result;
}

double oddness_of(const Loop& loop, std::size_t samples = 1500) {
  const Logged log = logged(loop, samples);
  return oddness(log.op, log.pv);
}

TEST(ControlLoop, AStickingValveSwingsOddly) {
  for (const double band : {1.0, 2.0, 5.0}) {
    for (const double gain : {0.1, 0.3}) {
      EXPECT_GT(oddness_of({.gain = gain, .band = band}, 6000), 2.0 / 3.0) << band << ' ' << gain;
    }
  }
}

/// 1/(1 + (ω T_i)²), and so above one half where it is slower than the corner of the controller.
TEST(ControlLoop, ADisturbanceFromOutsideSwingsAsTheControllerTurnsIt) {
  for (const double period : {15.0, 30.0, 60.0, 120.0, 300.0}) {
    const double corner = test::two_pi / period * 8.0;
    EXPECT_NEAR(oddness_of({.swing = 2.0, .period = period, .noise = 1e-4}), 1.0 / (1.0 + corner * corner), 0.05)
        << period;
  }
}

TEST(ControlLoop, ATightTuningSwingsEvenly) {
  EXPECT_LT(oddness_of({.gain = 2.5, .noise = 0.1}), 0.1);
}

TEST(ControlLoop, WhatAControllerSetsFollowsTheOutput) {
  const Logged log = logged({.band = 2.0});
  EXPECT_GT(feedback_share(log.op, log.pv), 0.9);
  test::Noise noise(3);
  std::vector<double> driven(log.op.size());
  std::vector<double> followed(log.op.size());
  double state = 0.0;
  for (std::size_t k = 0; k < driven.size(); ++k) {
    driven[k] = noise() > 0.0 ? 1.0 : -1.0;
    state += ((k > 0 ? driven[k - 1] : 0.0) - state) / 6.0;
    followed[k] = state + 0.01 * noise();
  }
  EXPECT_LT(feedback_share(driven, followed), 0.05);
}

/// In other units, about another level, turned round, cut in two, with a start that is no swing.
TEST(ControlLoop, WhatASignalIsMeasuredInChangesNothing) {
  const Logged log = logged({.gain = 0.3, .band = 2.0});
  const double before = oddness(log.op, log.pv);
  const double fed = feedback_share(log.op, log.pv);
  Logged other = log;
  std::ranges::transform(other.op, other.op.begin(), [](double v) { return -1e-3 * v + 4.0; });
  std::ranges::transform(other.pv, other.pv.begin(), [](double v) { return 1e4 * v - 3.0; });
  EXPECT_NEAR(oddness(other.op, other.pv), before, 1e-6);
  EXPECT_NEAR(feedback_share(other.op, other.pv), fed, 1e-6);
  std::ranges::reverse(other.op);
  std::ranges::reverse(other.pv);
  EXPECT_NEAR(oddness(other.op, other.pv), before, 1e-6);
  EXPECT_NEAR(oddness(log.pv, log.op), before, 1e-9);
  const std::span<const double> op(log.op);
  const std::span<const double> pv(log.pv);
  EXPECT_NEAR(oddness(op.first(700), pv.first(700)), before, 0.1);
  EXPECT_NEAR(oddness(op.subspan(333), pv.subspan(333)), before, 0.1);
  EXPECT_NEAR(oddness_of({.gain = 0.3, .band = 2.0, .begin = 30.0}), before, 0.15);
}

TEST(ControlLoop, WhatDoesNotMoveTellsNothing) {
  const Logged log = logged({.band = 2.0}, 60);
  const std::vector<double> still(60, 5.0);
  EXPECT_EQ(oddness(still, log.pv), 0.5);
  EXPECT_EQ(oddness(log.op, still), 0.5);
  EXPECT_EQ(feedback_share(still, log.pv), 0.0);
  EXPECT_EQ(feedback_share(log.op, still), 0.0);
  EXPECT_EQ(oddness({}, {}), 0.5);
  EXPECT_EQ(feedback_share({}, {}), 0.0);
  const std::vector<double> few{1.0, 2.0};
  EXPECT_EQ(oddness(few, few), 0.5);
  std::vector<double> ramp(60);
  for (std::size_t k = 0; k < ramp.size(); ++k) {
    ramp[k] = 0.1 * static_cast<double>(k);
  }
  EXPECT_EQ(oddness(ramp, log.pv), 0.5);
  EXPECT_EQ(feedback_share(ramp, log.pv), 0.0);
  EXPECT_NEAR(oddness(log.pv, log.pv), 0.0, 1e-12);  // a signal with itself is even
}

constexpr auto flow =
    "FUNCTION_BLOCK LOOP (* @ts 1s *)\n  VAR_INPUT\n    OP : LREAL;\n    Q : LREAL := 0.0;\n  END_VAR\n"
    "  VAR_OUTPUT\n    PV : LREAL;\n  END_VAR\n  VAR\n    PROC : HY_LAG := (T1 := 6.0);\n  END_VAR\n"
    "  PROC(XIN := OP + Q);\n  PV := PROC.XOUT + 20.0;\nEND_FUNCTION_BLOCK\n";

records::Record record_of(const Logged& log) {
  records::Record record = test::record_of("OP", log.op, 1.0);
  record.add({.name = "PV", .values = log.pv});
  return record;
}

std::optional<LoopFinding> found_in_all(const std::string& text, std::vector<records::Record> list,
                                        const std::vector<std::string>& without = {}) {
  const Program program = test::program_of(text);
  const Task task{.records = std::move(list), .outputs = {"PV"}};
  Rules rules(without);
  return control_loop(task, program, rules);
}
std::optional<LoopFinding> found_in(const std::string& text, records::Record record,
                                    const std::vector<std::string>& without = {}) {
  return found_in_all(text, {std::move(record)}, without);
}

TEST(ControlLoop, IsFoundWhereAControllerSetsTheOnlyInput) {
  const records::Record sticking = record_of(logged({.gain = 0.3, .band = 2.0}));
  const auto found = found_in(flow, sticking);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->input, "OP");
  EXPECT_EQ(found->output, "PV");
  EXPECT_GT(found->feedback, 0.9);
  EXPECT_THAT(sentence_of(*found), AllOf(HasSubstr("OP follows PV, as"), HasSubstr("more slowly than"),
                                         HasSubstr(": as where a valve sticks")));
  EXPECT_FALSE(found_in(flow, sticking, {"fed back"}));

  const auto tight = found_in(flow, record_of(logged({.gain = 2.5, .noise = 0.1})));
  ASSERT_TRUE(tight);
  EXPECT_THAT(sentence_of(*tight), HasSubstr("hardly as where a valve sticks"));
}

/// A plant that answers at once follows its input in the same sample, as the input would follow it: of a rough input
/// and little noise, all of it can be worked out of the output.
TEST(ControlLoop, IsNoneWhereThePlantAnswersAtOnce) {
  test::Noise noise(5);
  Logged log;
  double level = 0.0;
  for (std::size_t k = 0; k < 1500; ++k) {
    log.op.push_back(noise());
    level += (log.op.back() - level) / 6.0;
    log.pv.push_back(level + 1e-4 * noise());
  }
  EXPECT_GT(feedback_share(log.op, log.pv), 0.9);
  EXPECT_FALSE(found_in(flow, record_of(log)));
}

/// One step is a motion of the input that the output tells, in one sample of all.
TEST(ControlLoop, AStepIsNoController) {
  test::Noise noise(2);
  Logged log{.op = std::vector<double>(400, 0.0), .pv = noise.white(400, 0.001)};
  for (std::size_t k = 200; k < 400; ++k) {
    log.op[k] = 1.0;
    log.pv[k] += 1.0 - std::exp(-static_cast<double>(k - 199) / 6.0);
  }
  EXPECT_EQ(feedback_share(log.op, log.pv), 0.0);
}

TEST(ControlLoop, IsNoneWhereAnotherInputMoves) {
  records::Record record = record_of(logged({.band = 2.0}));
  std::vector<double> other(record.size(), 0.0);
  record.add({.name = "Q", .values = other});
  EXPECT_TRUE(found_in(flow, record));  // it rests
  other.back() = 1.0;
  record.replace("Q", other);
  EXPECT_FALSE(found_in(flow, record));
  record = record_of(logged({.band = 2.0}));
  record.replace("OP", std::vector<double>(record.size(), 30.0));
  EXPECT_FALSE(found_in(flow, record));
}

TEST(ControlLoop, IsLookedForInAllRecords) {
  const records::Record sticking = record_of(logged({.gain = 0.3, .band = 2.0}));
  const auto one = found_in(flow, sticking);
  const auto two = found_in_all(flow, {sticking, sticking});
  ASSERT_TRUE(one && two);
  EXPECT_NEAR(two->feedback, one->feedback, 1e-12);
  EXPECT_NEAR(two->oddness, one->oddness, 1e-12);
  EXPECT_NEAR(one->oddness, oddness(sticking.column("OP").values, sticking.column("PV").values), 1e-12);

  records::Record resting = test::record_of("PV", test::Noise(4).white(800, 0.01), 1.0);
  EXPECT_FALSE(found_in_all(flow, {sticking, resting})) << "a record without the input, which has a default";
  resting.add({.name = "OP", .values = std::vector<double>(800, 30.0)});
  const auto first_rests = found_in_all(flow, {resting, sticking});
  ASSERT_TRUE(first_rests);
  EXPECT_LT(first_rests->feedback, one->feedback);
  std::vector<double> other(800, 0.0);
  other.back() = 1.0;
  resting.add({.name = "Q", .values = other});
  EXPECT_FALSE(found_in_all(flow, {sticking, resting})) << "another input moves in the second record";
}

TEST(ControlLoop, GivesItsOddsToWhatSticks) {
  const LoopFinding slow{.oddness = 0.8};
  EXPECT_NEAR(with_loop(slow, 0.5, true), 0.8, 1e-12);
  EXPECT_NEAR(with_loop(slow, 0.5, false), 0.2, 1e-12);
  EXPECT_NEAR(with_loop(slow, 0.2, true), 0.5, 1e-12);
  EXPECT_EQ(with_loop(slow, 0.0, true), 0.0);
  EXPECT_EQ(with_loop(slow, 1.0, false), 1.0);
  EXPECT_EQ(with_loop({.oddness = 0.5}, 0.3, true), 0.3);
  EXPECT_EQ(with_loop({.oddness = 0.0}, 1.0, true), 1.0);  // nothing else is left
}

TEST(ControlLoop, TheRunsHaveTheOddsOfTheSwing) {
  Runs runs;
  runs.begins = {0};
  runs.sets = {{.families = {"dry_friction"}}, {.families = {"linear_dynamics"}}, {.families = {"lag", "play"}}, {}};
  runs.votes = {0.1, 0.5, 0.1, 0.3};
  weigh_by_loop({.oddness = 0.8}, runs);
  EXPECT_NEAR(runs.votes[0], 0.25, 1e-12);  // odds of 1 : 4, times 4
  EXPECT_NEAR(runs.votes[1], 0.3125, 1e-12);
  EXPECT_NEAR(runs.votes[2], 0.25, 1e-12);
  EXPECT_NEAR(runs.votes[3], 0.1875, 1e-12);
}

}  // namespace
}  // namespace hysteron::diagnosis
