// An online change of a task that runs: what is traced, retained, staged and counted follows, or nothing changes at
// all.
#include "runtime/host/online_change.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>

#include "runtime/task/staged_parameters.hpp"
#include "support/errors.hpp"
#include "tests/runtime/host/many_changes.hpp"
#include "tests/runtime/host/running_plant.hpp"
#include "tests/runtime/task/accumulator.hpp"
#include "tests/runtime/task/integrators.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/soon.hpp"

namespace hysteron::runtime {
namespace {

using hysteron::test::soon;
using test::Integrator;
using test::integrators;
using test::Plant;
using test::refusal_by;
using test::value;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

ReplayResult steps_replayed(const std::string& file, std::unique_ptr<StepProgram> program) {
  ReplayResult result;
  EXPECT_EQ(replay(hysteron::test::contents_of(file), *program, result), "");
  EXPECT_EQ(result.different, 0U) << file;
  EXPECT_EQ(result.without_state, 0U) << file;
  EXPECT_EQ(result.dropped, 0U) << file;
  EXPECT_TRUE(result.complete) << file;
  return result;
}

RetainedValues newest_kept(RetainFolder& files) {
  RetainedValues found;
  for (const std::size_t slot : {0U, 1U}) {
    if (const auto bytes = files.read(slot)) {
      const Slot read = decode_slot(*bytes);
      EXPECT_EQ(read.status, SlotStatus::whole);
      found = read.values.sequence >= found.sequence ? read.values : found;
    }
  }
  return found;
}

const std::vector<Integrator> parts_before{{"A", 0.001}, {"B", -0.001}};
const std::vector<Integrator> parts_after{{"B", 7.0}, {"NEW", 0.0}, {"A", 7.0}};

/// The trace is the oracle: each version alone gives every recorded output again, from the very step of the change on.
TEST(OnlineChange, EveryStepIsThatOfOneVersionAndNoneIsLost) {
  const hysteron::test::ScratchFolder folder;
  Plant plant(integrators(parts_before));
  plant.keep_in(folder);
  plant.start();
  const ChangeReport there = plant.change().change_to(integrators(parts_after), {});
  EXPECT_TRUE(there.is_done);
  EXPECT_EQ(there.version, 2U);
  EXPECT_EQ(there.parameters_carried, 2U);
  EXPECT_EQ(there.states_carried, 2U);
  EXPECT_THAT(there.left, ElementsAre("NEW.K (new)", "NEW.Y (new)"));
  EXPECT_THAT(there.other_values, ElementsAre("B.K = -0.001 (7 in the files)", "A.K = 0.001 (7 in the files)"));
  plant.run(50);
  EXPECT_EQ(value(plant.door(), "task.version"), 2.0);
  EXPECT_EQ(value(plant.door(), "task.online_change"), 1.0);
  const ChangeReport back = plant.change().change_back({});
  EXPECT_EQ(back.version, 3U);
  EXPECT_THAT(back.left, ElementsAre("NEW.K (gone)", "NEW.Y (gone)"));
  EXPECT_THAT(back.as_before, IsEmpty());
  plant.run(50);
  EXPECT_EQ(value(plant.door(), "task.online_change"), 3.0);
  plant.end();
  plant.finish_trace();
  const auto cycles = static_cast<std::uint64_t>(value(plant.door(), "task.cycles"));
  const std::uint64_t steps = steps_replayed(folder / "run.trace.2", integrators(parts_before)).steps +
                              steps_replayed(folder / "run.trace.1", integrators(parts_after)).steps +
                              steps_replayed(folder / "run.trace", integrators(parts_before)).steps;
  EXPECT_EQ(steps, cycles);
  EXPECT_EQ(value(plant.door(), "task.trace_dropped"), 0.0);
}

/// A crash may come at once: what is on the disk when the change is told is of the new version.
TEST(OnlineChange, WhatIsRetainedIsOfTheNewVersionBeforeItIsTold) {
  const hysteron::test::ScratchFolder folder;
  Plant plant(integrators(parts_before));
  plant.keep_in(folder);
  plant.start();
  ASSERT_EQ(plant.write({{"A.K", 0.5}, {"task.commit", 1.0}}), "");
  plant.run(5);
  EXPECT_TRUE(plant.change().change_to(integrators(parts_after), {}).is_retained);
  const RetainedValues values = newest_kept(plant.files());
  EXPECT_EQ(values.layout, integrators(parts_after)->shape().layout);
  EXPECT_THAT(values.parameters, ElementsAre(-0.001, 0.0, 0.5));
  EXPECT_TRUE(plant.change().change_back({}).is_retained);
  EXPECT_EQ(newest_kept(plant.files()).layout, integrators(parts_before)->shape().layout);
  EXPECT_THAT(newest_kept(plant.files()).parameters, ElementsAre(0.5, -0.001));
  // Twice more, so that a version goes whose values the retaining thread may still have in hand.
  (void)plant.change().change_to(integrators(parts_after), {});
  (void)plant.change().change_to(integrators(parts_before), {});
  EXPECT_EQ(newest_kept(plant.files()).layout, integrators(parts_before)->shape().layout);
}

TEST(OnlineChange, ACheckSaysTheSameAndChangesNothing) {
  Plant plant(integrators({{"A", 1.0}, {"B", 0.0}}), 1e9);
  plant.start();
  ASSERT_EQ(plant.write({{"X", 0.0}}), "");
  plant.run(5);
  const double y = value(plant.door(), "Y");
  const ChangeReport report = plant.change().change_to(integrators({{"B", 0.0}}), {.only_check = true});
  EXPECT_FALSE(report.is_done);
  EXPECT_EQ(report.version, 1U);
  EXPECT_EQ(report.outputs.at(0).bump.before, y);
  EXPECT_EQ(report.outputs.at(0).bump.after, 0.0);
  EXPECT_EQ(report.outputs.at(0).bump.size, std::min(y, 50.0));
  plant.run(5);
  EXPECT_EQ(value(plant.door(), "Y"), y);
  EXPECT_EQ(value(plant.door(), "task.version"), 1.0);
  EXPECT_EQ(value(plant.door(), "task.online_change"), 0.0);
}

TEST(OnlineChange, AnOutputThatWouldJumpRefusesItByNameAndALimitOfThisChangeAllowsIt) {
  Plant plant(integrators({{"A", 1.0}, {"B", 0.0}}), 0.25);
  plant.start();
  ASSERT_EQ(plant.write({{"X", 0.0}}), "");
  plant.run(5);
  const auto to_less = [&](const ChangeWish& wish) {
    return refusal_by([&] { return plant.change().change_to(integrators({{"B", 0.0}}), wish); });
  };
  EXPECT_THAT(to_less({}), HasSubstr("HY851: The output Y would jump by "));
  EXPECT_THAT(to_less({}), HasSubstr("; its limit is 0.25 um (a test)."));
  EXPECT_EQ(value(plant.door(), "task.version"), 1.0);
  plant.run(2);
  EXPECT_EQ(value(plant.door(), "task.online_change"), 2.0);
  EXPECT_EQ(to_less({.bumps = {{"Z", 100.0}}}), "HY730: There is no output Z whose jump could be limited.");
  EXPECT_EQ(to_less({.bumps = {{"Y", 100.0}}}), "");
  plant.run(2);
  EXPECT_EQ(value(plant.door(), "Y"), 0.0);
  // Back, Y jumps again: the limit of a change is that of this one alone. What was there is untouched by the refusal.
  EXPECT_THAT(refusal_by([&] { return plant.change().change_back({}); }), HasSubstr("HY851: The output Y would jump"));
  EXPECT_EQ(refusal_by([&] { return plant.change().change_back({.bumps = {{"Y", 100.0}}}); }), "");
  plant.run(2);
  EXPECT_GT(value(plant.door(), "Y"), 10.0);
}

TEST(OnlineChange, WhatGrowsWithoutBoundIsSeenBeforeItCounts) {
  Plant plant(integrators({{"A", 0.0}}));
  plant.start();
  const auto why = refusal_by([&] {
    return plant.change().change_to(integrators({{"A", 0.0}, {"WILD", 1e306}}), {.bumps = {{"Y", 1e307}}});
  });
  EXPECT_THAT(why, HasSubstr("HY851: The output Y would be no number "));
  EXPECT_THAT(why, HasSubstr(" steps after the change."));
}

TEST(OnlineChange, AnotherInterfaceIsRefusedByWhatIsOtherInIt) {
  Plant plant(integrators({{"A", 0.0}}));
  plant.start();
  const auto refused = [&](const std::function<void(ProgramShape&)>& edit) {
    auto next = integrators({{"A", 0.0}});
    edit(next->mutable_shape());
    return refusal_by([&] { return plant.change().change_to(std::move(next), {}); });
  };
  EXPECT_EQ(refused([](ProgramShape& shape) { shape.inputs.push_back({.name = "MORE", .unit = "V"}); }),
            "HY850: The input MORE in V is new.");
  EXPECT_EQ(refused([](ProgramShape& shape) { shape.outputs.clear(); }), "HY850: The output Y in um is gone.");
  EXPECT_EQ(refused([](ProgramShape& shape) { shape.inputs[0].name = "U"; }),
            "HY850: The input U in V stands where X in V was.");
  EXPECT_EQ(refused([](ProgramShape& shape) { shape.inputs[0].unit = "mV"; }),
            "HY850: The input X in V has another unit: mV.");
  EXPECT_THAT(refused([](ProgramShape& shape) { shape.outputs[0].type = PointType::int32; }),
              HasSubstr("HY850: The output Y has another type"));
  EXPECT_EQ(refused([](ProgramShape& shape) { shape.outputs[0].high = 10.0; }),
            "HY850: The range of the output Y was -1000000000 to 1000000000, and is -1000000000 to 10.");
  EXPECT_EQ(refused([](ProgramShape& shape) { shape.period = 2'000'000; }),
            "HY850: The sample time was 1000000 ns, and is 2000000 ns.");
}

TEST(OnlineChange, ATaskThatDoesNotStepRefusesItAndSaysWhy) {
  auto program = integrators({{"A", 0.0}});
  test::Integrators* const raw = program.get();
  Plant plant(std::move(program));
  EXPECT_EQ(refusal_by([&] { return plant.change().change_back({}); }), "HY853: The task has not begun yet.");
  std::atomic<bool> hangs{false};
  raw->in_step = [&] { plant.clock().pass(hangs ? 1'000'000'000 : 0); };
  plant.start();
  EXPECT_EQ(refusal_by([&] { return plant.change().change_back({}); }),
            "HY853: There is no version before this one: none was changed since the start.");
  hangs = true;
  plant.run(5);
  EXPECT_EQ(refusal_by([&] {
              return plant.change().change_to(integrators({{"A", 0.0}}), {});
            }),
            "HY853: The diagram is not stepped; the last fault of the task was: hang.");
  hangs = false;
  ASSERT_EQ(plant.write({{"task.reset", 1.0}}), "");
  EXPECT_EQ(refusal_by([&] { return plant.change().change_to(integrators({{"A", 0.0}}), {}); }), "");
  plant.end();
  EXPECT_EQ(refusal_by([&] { return plant.change().change_back({}); }), "HY853: The task ends.");
}

/// Outputs that are safe meanwhile are no obstacle: the diagram steps.
TEST(OnlineChange, ALostClientIsNoObstacle) {
  Plant plant(integrators(parts_before));
  plant.start();
  plant.task().client_lost(true);
  ASSERT_TRUE(soon([&] { return value(plant.door(), "task.state") == 2.0; }));
  EXPECT_EQ(refusal_by([&] { return plant.change().change_to(integrators(parts_after), {}); }), "");
  EXPECT_EQ(value(plant.door(), "Y"), 0.0);
}

TEST(OnlineChange, WhatIsStagedStaysSoAndIsJudgedByTheVersionThatRuns) {
  Plant plant(integrators({{"A", 0.0}, {"GONE", 0.0}, {"B", 0.0}}));
  plant.start();
  ASSERT_EQ(plant.write({{"A.K", 5.0}, {"GONE.K", 6.0}}), "");
  auto next = integrators({{"B", 0.0}, {"A", 0.0}});
  next->mutable_shape().parameters[1].high = 3.0;
  EXPECT_THAT(plant.change().change_to(std::move(next), {}).left, ElementsAre("GONE.K (gone)", "GONE.Y (gone)"));
  EXPECT_EQ(plant.write({{"task.commit", 1.0}}), "A.K must be at most 3.");
  EXPECT_EQ(plant.write({{"GONE.K", 1.0}}),
            "GONE.K is not in the version of the diagram that runs since an online change.");
  EXPECT_EQ(plant.write({{"A.K", 2.5}, {"B.K", 1.5}, {"task.commit", 1.0}}), "");
  EXPECT_TRUE(soon([&] { return value(plant.door(), "A.K") == 2.5 && value(plant.door(), "B.K") == 1.5; }));
  EXPECT_EQ(value(plant.door(), "GONE.K"), 0.0);
  // What came while it ran goes back with it.
  EXPECT_EQ(refusal_by([&] { return plant.change().change_back({}); }), "");
  EXPECT_EQ(plant.write({{"GONE.K", 1.0}, {"task.commit", 1.0}}), "");
  EXPECT_TRUE(soon([&] { return value(plant.door(), "GONE.K") == 1.0; }));
  EXPECT_EQ(value(plant.door(), "A.K"), 2.5);
}

TEST(OnlineChange, AParameterIsTakenAsGivenWhereThatIsAskedForOrItsLimitsWantIt) {
  Plant plant(integrators({{"A", 0.001}, {"B", 0.002}, {"C", 30.0}}));
  plant.start();
  ASSERT_EQ(plant.write({{"X", 0.0}}), "");
  auto next = integrators({{"A", 0.1}, {"B", 0.2}, {"C", 0.3}});
  next->mutable_shape().parameters[2].high = 1.0;
  EXPECT_THAT(plant.change().change_to(std::move(next), {.as_given = {"B.K"}}).left,
              ElementsAre("C.K (30 is outside of its limits)", "B.K (as given)"));
  plant.run(2);
  EXPECT_EQ(value(plant.door(), "A.K"), 0.001);
  EXPECT_EQ(value(plant.door(), "B.K"), 0.2);
  EXPECT_EQ(value(plant.door(), "C.K"), 0.3);
  // The set that a client commits next is of these values, not of those before.
  ASSERT_EQ(plant.write({{"A.K", 0.5}, {"task.commit", 1.0}}), "");
  EXPECT_TRUE(soon([&] { return value(plant.door(), "A.K") == 0.5; }));
  EXPECT_EQ(value(plant.door(), "B.K"), 0.2);
  // Back, what was taken as given is as before, and what a client has committed stays; forward again, the same.
  EXPECT_THAT(plant.change().change_back({}).left, ElementsAre("B.K (as given)"));
  plant.run(2);
  EXPECT_EQ(value(plant.door(), "A.K"), 0.5);
  EXPECT_EQ(value(plant.door(), "B.K"), 0.002);
  (void)plant.change().change_back({});
  plant.run(2);
  EXPECT_EQ(value(plant.door(), "B.K"), 0.2);
  ASSERT_EQ(plant.write({{"B.K", 0.7}, {"task.commit", 1.0}}), "");
  EXPECT_TRUE(soon([&] { return value(plant.door(), "B.K") == 0.7; }));
  EXPECT_THAT(plant.change().change_back({}).left, IsEmpty());
  plant.run(2);
  EXPECT_EQ(value(plant.door(), "B.K"), 0.7);
  EXPECT_EQ(refusal_by([&] {
              return plant.change().change_to(integrators({{"A", 0.1}}), {.as_given = {"B.K"}});
            }),
            "HY730: The new version has no parameter B.K.");
}

TEST(OnlineChange, ParametersThatDoNotGoTogetherInTheNewVersionRefuseIt) {
  Plant plant(integrators({{"LOW", 3.0}, {"HIGH", 4.0}}));
  plant.start();
  ASSERT_EQ(plant.write({{"X", 0.0}, {"HIGH.K", 2.0}, {"task.commit", 1.0}}), "");
  plant.run(5);
  const auto next = [] {
    auto program = integrators({{"LOW", 3.0}, {"HIGH", 4.0}, {"NEW", 2.5}});
    program->mutable_shape().relations = {{.numbers = {{.parameter = 0}, {.parameter = 1}}},
                                          {.numbers = {{.parameter = 2}, {.parameter = 1}}}};
    return program;
  };
  EXPECT_THAT(refusal_by([&] { return plant.change().change_to(next(), {}); }),
              HasSubstr("HY855: The parameters carried over cannot be beside those of the new version: HIGH.K = 2 must "
                        "be at least LOW.K = 3."));
  EXPECT_EQ(refusal_by([&] { return plant.change().change_to(next(), {.as_given = {"HIGH.K"}}); }), "");
  // NEW is none of the first version's points: beside it, HIGH is judged all the same.
  EXPECT_EQ(plant.write({{"LOW.K", 1.0}, {"HIGH.K", 2.0}, {"task.commit", 1.0}}),
            "HIGH.K = 2 must be at least NEW.K = 2.5.");
  EXPECT_EQ(plant.write({{"LOW.K", 1.0}, {"HIGH.K", 2.75}, {"task.commit", 1.0}}), "");
}

/// By the names that the live page shows.
std::map<std::string, double> values_of_page(TaskDoor& door) {
  LiveValues live;
  door.read_live(live);
  const auto view = door.view();
  EXPECT_EQ(view->version, live.version);
  std::map<std::string, double> values;
  for (std::size_t i = 0; i < live.values.size(); ++i) {
    values[view->points[i].name] = live.values[i];
  }
  for (std::size_t i = 0; i < live.inner.size(); ++i) {
    values["inner " + view->inner[i].name] = live.inner[i];
  }
  return values;
}

std::string write_from_page(TaskDoor& door, const std::string& name, double value) {
  const auto view = door.view();
  for (std::size_t i = 0; i < view->points.size(); ++i) {
    if (view->points[i].name == name) {
      return door.write_from_page(std::vector<PointWrite>{{view->places[i], value}});
    }
  }
  return "not shown";
}

/// Picture, points and inner signals are those of the version that runs; places stay.
TEST(OnlineChange, TheLivePageSeesTheVersionThatRunsAndReachesItsNewParameters) {
  const auto drawn = [](std::vector<Integrator> parts, const char* picture) {
    auto program = integrators(std::move(parts));
    program->mutable_shape().picture = picture;
    return program;
  };
  Plant plant(drawn({{"A", 0.5}, {"GONE", 0.0}}, "first"), 1e9);
  plant.start();
  TaskDoor& door = plant.door();
  const std::size_t first_points = door.points().size();
  ASSERT_EQ(plant.write({{"X", 0.0}}), "");
  EXPECT_EQ(door.view()->picture, "first");
  (void)plant.change().change_to(drawn({{"NEW", 3.0}, {"A", 9.0}}, "second"), {});
  plant.run(5);
  EXPECT_EQ(door.view()->picture, "second");
  EXPECT_EQ(door.view()->version, 2U);
  auto values = values_of_page(door);
  EXPECT_EQ(values.at("A.K"), 0.5);
  EXPECT_EQ(values.at("NEW.K"), 3.0);
  EXPECT_EQ(values.at("task.version"), 2.0);
  EXPECT_FALSE(values.contains("GONE.K"));
  EXPECT_EQ(values.at("inner A.Y"), values.at("Y"));
  EXPECT_EQ(values.at("inner NEW.Y"), 0.0);
  EXPECT_FALSE(values.contains("inner GONE.Y"));
  EXPECT_EQ(door.points().size(), first_points);

  EXPECT_EQ(write_from_page(door, "NEW.K", 500.0), "") << "a set may be out of range while it is being entered";
  EXPECT_EQ(write_from_page(door, "task.commit", 1.0), "NEW.K must be at most 100.");
  EXPECT_EQ(write_from_page(door, "NEW.K", 2.0), "");
  LiveValues live;
  door.read_live(live);
  ASSERT_EQ(live.staged.size(), 1U);
  EXPECT_EQ(door.view()->points[live.staged[0].point].name, "NEW.K");
  EXPECT_EQ(plant.write({{"A.K", 0.25}, {"task.commit", 1.0}}), "") << "Modbus commits its own";
  EXPECT_TRUE(soon([&] { return values_of_page(door).at("A.K") == 0.25; }));
  EXPECT_EQ(values_of_page(door).at("NEW.K"), 3.0);
  EXPECT_EQ(write_from_page(door, "task.commit", 1.0), "");
  EXPECT_TRUE(soon([&] { return values_of_page(door).at("NEW.K") == 2.0; }));
  EXPECT_EQ(values_of_page(door).at("A.K"), 0.25);

  // A third version: NEW keeps its place, and OTHER gets one that nobody had.
  (void)plant.change().change_to(drawn({{"OTHER", -1.0}, {"NEW", 9.0}}, "third"), {});
  plant.run(5);
  values = values_of_page(door);
  EXPECT_EQ(values.at("NEW.K"), 2.0);
  EXPECT_EQ(values.at("OTHER.K"), -1.0);
  EXPECT_FALSE(values.contains("A.K"));
  EXPECT_EQ(write_from_page(door, "OTHER.K", 4.0), "");
  EXPECT_EQ(write_from_page(door, "task.commit", 1.0), "");
  EXPECT_TRUE(soon([&] { return values_of_page(door).at("OTHER.K") == 4.0; }));
  EXPECT_EQ(values_of_page(door).at("NEW.K"), 2.0);

  (void)plant.change().change_back({});
  plant.run(5);
  EXPECT_EQ(door.view()->picture, "second");
  values = values_of_page(door);
  EXPECT_EQ(values.at("NEW.K"), 2.0);
  EXPECT_EQ(values.at("A.K"), 0.25);
  EXPECT_FALSE(values.contains("OTHER.K"));
}

TEST(OnlineChange, AForcedInputStaysSoThroughIt) {
  Plant plant(integrators(parts_before));
  plant.start();
  ASSERT_EQ(plant.door().force(std::vector<Force>{{.point = 0, .value = 0.0}}), "");
  plant.run(5);
  EXPECT_TRUE(plant.change().change_to(integrators(parts_after), {}).is_done);
  plant.run(5);
  LiveValues live;
  plant.door().read_live(live);
  EXPECT_EQ(live.version, 2U);
  EXPECT_THAT(live.forced, ElementsAre(0U));
  EXPECT_EQ(live.values[0], 0.0);
}

TEST(OnlineChange, NobodyCommitsWhileItIsUnderWay) {
  Plant plant(integrators(parts_before));
  plant.door().hold_commits(true);
  EXPECT_EQ(plant.write({{"A.K", 1.0}, {"task.commit", 1.0}}),
            "An online change is under way: commit again in a second.");
  EXPECT_EQ(plant.write({{"A.K", 2.0}}), "");
  plant.door().hold_commits(false);
  EXPECT_EQ(plant.write({{"task.commit", 1.0}}), "");
}

TEST(OnlineChange, NoCommittedSetIsLostAmongChanges) {
  const auto result = test::change_many_times(20);
  EXPECT_EQ(result.changed, 20U);
  EXPECT_EQ(result.version, 21U);
  EXPECT_GT(result.committed, 0U);
  EXPECT_TRUE(result.last_counts);
}

TEST(OnlineChange, AProgramOfOneVersionHasNoneAndSaysSo) {
  test::Accumulator program;
  Task task(program, {.inputs = {{}}, .outputs = {{}, {}}});
  EXPECT_EQ(online_change({}, nullptr, task), nullptr);
  RunConfig config;
  config.online_change = ChangeConfig{.socket = "online-change.socket"};
  testing::internal::CaptureStderr();
  EXPECT_EQ(online_change(config, nullptr, task), nullptr);
  EXPECT_THAT(testing::internal::GetCapturedStderr(),
              HasSubstr("[online_change] has no effect here: only `hysteron serve` can compile a new version."));
}

TEST(OnlineChange, TheLimitOfAnOutputIsThatOfTheRunFileOrAPartOfItsRange) {
  ProgramShape shape{.outputs = {{.name = "Y", .low = 0.0, .high = 40.0},
                                 {.name = "Z"},
                                 {.name = "ON", .type = PointType::boolean, .low = 0.0, .high = 1.0},
                                 {.name = "U", .low = 0.0, .high = 40.0}}};
  RunConfig config;
  config.task.outputs = {{.low = 10.0, .high = 30.0}, {}, {}, {}};
  config.bumps = {{3, 0.125}};
  const auto limits = bump_limits(config, shape);
  EXPECT_DOUBLE_EQ(limits[0].limit.most, 0.2);
  EXPECT_EQ(limits[0].origin, "1 % of 10 to 30");
  EXPECT_EQ(limits[1].limit.most, 0.0);
  EXPECT_EQ(limits[1].origin, "it has no low and high");
  EXPECT_EQ(limits[2].limit.most, 0.0);
  EXPECT_EQ(limits[3].limit.most, 0.125);
}

}  // namespace
}  // namespace hysteron::runtime
