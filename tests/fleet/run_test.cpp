// Units of work under every kind of end, with a program in the place of the tool that does what its record says.
#include "fleet/run.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <string>
#include <thread>

#include "fleet/claim.hpp"
#include "fleet/table.hpp"
#include "support/diagnostic.hpp"
#include "support/errors.hpp"
#include "tests/support/scratch_folder.hpp"

namespace hysteron::fleet {
namespace {

namespace fs = std::filesystem;

/// Called as the tool is: diagnose DIAGRAM --log LOG --params P --out DIR, tune DIAGRAM --log LOG --params P --out
/// TUNED
/// --report DIR, without --log for a goal, check DIAGRAM --json. The record, or a goal's parameters, is a line of the
/// shell. Each run that gets to its end leaves a letter in the file `ran`.
constexpr std::string_view program = R"(#!/bin/sh
out=$8
[ "$1$3" = tune--log ] && out=${10}
loop() {
  printf '{"status": "%s", "parameters": [{"name": "PID.KP", "value": 3, "unit": "V/mm", "at_bound": "upper"}],
    "plants": [{"before": {"error": 0.5}, "after": {"error": 0.1}}, {"before": null, "after": {"error": 0.2}}]}' "$1" \
    > "$out/report.json"
}
fit() {
  printf '{"status": "%s", "parameters": [{"name": "AMP.K", "value": 2, "standard_error": 0.5, "unit": "um/V",
    "at_bound": ""}], "initial_states": [], "outputs": [{"rmse_before": 3, "rmse_train": 1, "unit": "um"}]}' "$1" \
    > "$out/report.json"
}
verdict() {
  printf '{"verdict": "%s", "effects": [
      {"id": "lag", "edge": "U", "share": 0.5, "parameters": {"T1": {"value": 2, "low": 1, "high": 3, "unit": "s"}}},
      {"id": "creep", "edge": "Y", "share": null, "parameters": {}}], "confidence": 0.75,
    "families": [{"family": "delay", "effect": "lag", "edge": "U", "effect_probability": 0.9},
      {"family": "friction", "effect": "stiction", "edge": "X", "effect_probability": 0.1}],
    "calibration": {"AMP.K": {"value": 4, "low": null, "high": null, "unit": "um/V"}}, "gap": {"nominal_rms": 2.5, "improved_rms": null, "unit": "um"}}' "$1" > "$out/verdict.json"
}
if [ "$1" = check ]; then . "$2"; else . "$4"; fi
printf x >> "$(dirname "$0")/ran"
exit "${code:-0}"
)";

class Fleet : public ::testing::Test {
 protected:
  void SetUp() override {
    options_.program = folder_.write("program", program);
    fs::permissions(options_.program, fs::perms::owner_all);
    folder_.write("a.st", "diagram");
    folder_.write("p.toml", "");
    options_.version = "1";
    options_.output = folder_ / "out";
    options_.workers = 3;
    options_.time_limit = 20.0;
  }

  void add(const std::string& machine, const std::string& record) {
    units_.push_back({.machine = machine,
                      .diagram = folder_ / "a.st",
                      .parameters = folder_ / "p.toml",
                      .log = folder_.write(machine + ".csv", record),
                      .line = static_cast<std::uint32_t>(units_.size() + 2)});
  }

  Worked work() { return work_off(units_, "fleet.csv", options_); }
  std::vector<Row> rows() { return write_table(units_, work().keys, options_.output); }
  /// Processes that work on the same folder at once.
  std::vector<pid_t> controllers(int count) {
    std::vector<pid_t> started;
    for (int i = 0; i < count; ++i) {
      const pid_t one = fork();
      if (one == 0) {
        (void)rows();
        _exit(0);
      }
      started.push_back(one);
    }
    return started;
  }
  [[nodiscard]] std::size_t ran() const { return test::contents_of(folder_ / "ran").size(); }
  [[nodiscard]] bool nothing_left_over() const { return fs::is_empty(options_.output / "work"); }

  test::ScratchFolder folder_;
  std::vector<Unit> units_;
  RunOptions options_;
};

TEST_F(Fleet, WorksEachUnitOnceAndASecondRunDoesWhatChanged) {
  for (int i = 0; i < 7; ++i) {
    add("M" + std::to_string(i), "verdict named\n");
  }
  EXPECT_EQ(work().ran, 7U);
  const Worked again = work();
  EXPECT_EQ(again.ran, 0U);
  EXPECT_EQ(again.found, 7U);
  EXPECT_EQ(ran(), 7U);

  folder_.write("M3.csv", "verdict none\n");
  EXPECT_EQ(work().ran, 1U);
  units_[4].when = "2026-01-01";
  EXPECT_EQ(work().ran, 1U);
  folder_.write("a.st", "another diagram");
  EXPECT_EQ(work().ran, 7U);
  folder_.write("p.toml", "[fit]");
  EXPECT_EQ(work().ran, 7U);
  const std::string fmu = folder_.write("motor.fmu", "an FMU");
  options_.named_files.by_diagram = [&](const std::string&) { return std::vector{fmu}; };
  EXPECT_EQ(work().ran, 7U);
  EXPECT_EQ(work().ran, 0U);
  folder_.write("motor.fmu", "another");
  EXPECT_EQ(work().ran, 7U) << "what a diagram names decides, too";
  options_.options = {"--effort", "2"};
  EXPECT_EQ(work().ran, 7U);
  options_.version = "2";
  EXPECT_EQ(work().ran, 7U);
  options_.time_limit = 10.0;  // limits change no verdict
  EXPECT_EQ(work().ran, 0U);
  EXPECT_TRUE(nothing_left_over());
}

TEST_F(Fleet, APoisonedRecordStopsNobody) {
  options_.time_limit = 1.0;
  options_.megabytes = 200;
  add("good", "verdict named\n");
  add("crash", "kill -SEGV $$\n");
  add("killed", "verdict named; kill -KILL $$\n");
  add("endless", "sleep 1000\n");
  add("hog", "x=$(head -c 1000000000 /dev/zero | tr '\\0' a); verdict named\n");
  add("garbage", "echo 'error: no number' >&2; echo more >&2; code=2\n");
  add("silent", "true\n");
  add("refused", "verdict none; code=1\n");
  add("gone", "");
  fs::remove(units_.back().log);
  add("last", "verdict named\n");

  const auto all = rows();
  const auto status = [&](std::size_t i) { return all[i].result.status; };
  EXPECT_EQ(status(0), Status::Done);
  EXPECT_EQ(status(1), Status::Failed);
  EXPECT_THAT(all[1].result.reason, ::testing::StartsWith("it was ended by signal 11."));
  EXPECT_EQ(status(2), Status::Failed) << "a verdict of a process that was killed is none";
  EXPECT_EQ(all[2].result.exit_code, 128 + 9);
  EXPECT_EQ(all[3].result.reason, "it took longer than 1 s (--time-limit).");
  EXPECT_EQ(status(4), Status::Failed);
  EXPECT_EQ(all[5].result.reason, "error: no number");
  EXPECT_EQ(all[6].result.reason, "it ended with 0 and said nothing.");
  EXPECT_EQ(status(7), Status::Refused);
  EXPECT_EQ(status(8), Status::Failed);
  EXPECT_EQ(status(9), Status::Done);
  EXPECT_EQ(counts_of(all), (std::array<std::size_t, 4>{0, 2, 1, 7}));
  EXPECT_TRUE(nothing_left_over());

  EXPECT_EQ(work().ran, 0U) << "a failure is a result";
  folder_.write("gone.csv", "verdict named\n");
  EXPECT_EQ(work().ran, 1U) << "a record that is there now";
  options_.retry = true;
  EXPECT_EQ(work().ran, 6U);
  EXPECT_TRUE(nothing_left_over());
}

TEST_F(Fleet, TheTableSaysWhatTheFoldersSay) {
  add("a,b", "verdict named\n");
  add("c", "echo 'no \"good\"' >&2; code=2\n");
  const auto all = rows();
  const std::string csv =
      "machine,when,group,command,status,verdict,effects,confidence,nominal_rms,improved_rms,unit,reason,folder\n"
      "\"a,b\",,,diagnose,done,named,lag at U + creep at Y,0.75,2.5,,um,,units/" +
      all[0].key + "\nc,,,diagnose,failed,,,,,,,\"no \"\"good\"\"\",units/" + all[1].key + "\n";
  EXPECT_EQ(test::contents_of(folder_ / "out/results.csv"), csv);
  fs::remove(folder_ / "out/results.csv");
  (void)rows();
  EXPECT_EQ(test::contents_of(folder_ / "out/results.csv"), csv) << "derived again";
  EXPECT_EQ(ran(), 2U);

  folder_.write("out/units/" + all[0].key + "/verdict.json", "{}");
  EXPECT_EQ(rows()[0].result.status, Status::Failed) << "a verdict that someone changed";
}

TEST_F(Fleet, OneManifestMayDiagnoseTuneAndCheck) {
  add("diagnosed", "verdict named\n");
  for (const char* const record : {"fit converged\n", "fit stalled; code=1\n", "code=1\n"}) {
    add("tuned" + std::to_string(units_.size()), record);
    units_.back().command = Command::Tune;
  }
  for (const char* const diagram : {"echo '[]'\n", "echo '[1]'; code=1\n", "code=1\n"}) {
    units_.push_back({.machine = "checked",
                      .command = Command::Check,
                      .diagram = folder_.write(std::to_string(units_.size()) + ".st", diagram)});
  }
  const auto all = rows();
  std::vector<Status> found;
  for (const Row& row : all) {
    found.push_back(row.result.status);
  }
  EXPECT_EQ(found, (std::vector{Status::Done, Status::Done, Status::Refused, Status::Failed, Status::Done,
                                Status::Refused, Status::Failed}));
  EXPECT_EQ(all[1].outcome.verdict, "converged");
  EXPECT_EQ(all[1].outcome.parameters.at(0).name, "AMP.K");
  EXPECT_NEAR(all[1].outcome.parameters.at(0).high, 2.98, 0.001);
  EXPECT_EQ(all[2].result.reason, "the fit did not converge, or limits of a goal are broken; report.json says why.");
  EXPECT_EQ(all[5].result.reason, "the diagram has errors, diagnostics.json says which.");
  EXPECT_EQ(work().ran, 0U);
  units_[0].command = Command::Tune;
  EXPECT_EQ(work().ran, 1U) << "another command is another unit";
}

TEST_F(Fleet, AGoalNeedsNoRecordAndItsPlantsCount) {
  const std::string plant = folder_.write("heavy.toml", "1");
  options_.named_files.by_parameters = [&](const std::string&) { return std::vector{plant}; };
  units_.push_back({.machine = "axis",
                    .command = Command::Tune,
                    .diagram = folder_ / "a.st",
                    .parameters = folder_.write("goal.toml", "loop tuned\n")});
  const auto all = rows();
  EXPECT_EQ(all[0].result.status, Status::Done);
  EXPECT_EQ(all[0].outcome.verdict, "tuned");
  EXPECT_EQ(all[0].outcome.parameters.at(0).source, "goal");
  EXPECT_EQ(all[0].outcome.parameters.at(0).value, 3.0);
  EXPECT_EQ(all[0].outcome.improved_rms, 0.2) << "the worst plant counts";
  EXPECT_EQ(work().ran, 0U);
  folder_.write("heavy.toml", "2");
  EXPECT_EQ(work().ran, 1U) << "another plant is another unit";
}

TEST_F(Fleet, SharesAreDisjointAndComplete) {
  for (int i = 0; i < 8; ++i) {
    add("M" + std::to_string(i), "verdict named\n");
  }
  options_.shares = 3;
  std::vector<std::size_t> done;
  for (options_.share = 1; options_.share <= 3; ++options_.share) {
    done.push_back(work().ran);
  }
  EXPECT_EQ(done, (std::vector<std::size_t>{3, 3, 2}));
  options_.share = options_.shares = 1;
  EXPECT_EQ(work().ran, 0U);
  EXPECT_EQ(ran(), 8U);
}

TEST_F(Fleet, TwoLinesOfTheSameUnitAreRefused) {
  add("M", "verdict named\n");
  units_.push_back(units_.front());
  units_.back().line = 9;
  try {
    (void)work();
    ADD_FAILURE() << "accepted";
  } catch (const InputError& problem) {
    EXPECT_EQ(problem.diagnostics().all().front().number, error::bad_usage);
    EXPECT_EQ(problem.diagnostics().all().front().place.line, 9U);
  }
  EXPECT_FALSE(fs::exists(options_.output)) << "nothing runs";
}

TEST_F(Fleet, AUnitThatAnotherWorksOnIsWaitedFor) {
  add("M", "verdict named\n");
  const std::string key = Keys(options_.version, options_.options).of(units_[0]);
  fs::create_directories(options_.output / "claims");
  auto claim = Claim::on(options_.output / "claims" / key);
  ASSERT_TRUE(claim);
  ASSERT_FALSE(Claim::on(options_.output / "claims" / key));
  std::thread other([held = std::move(*claim)]() mutable {
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    const Claim gone = std::move(held);
  });
  EXPECT_EQ(work().ran, 1U);
  other.join();
}

/// Three controllers on one folder, killed again and again at moments that differ; then one goes to the end.
TEST_F(Fleet, KilledAtAnyMomentNothingIsLostOrDoneTwice) {
  constexpr std::size_t count = 40;
  for (std::size_t i = 0; i < count; ++i) {
    add("M" + std::to_string(i), "sleep 0.02; verdict named\n");
  }
  options_.workers = 2;
  std::size_t killed_in_work = 0;
  std::uint32_t random = 7;
  for (int round = 0; round < 12; ++round) {
    for (const pid_t one : controllers(3)) {
      random = random * 1664525U + 1013904223U;
      std::this_thread::sleep_for(std::chrono::milliseconds(5 + (random >> 16U) % 60U));
      ::kill(one, SIGKILL);
      int status = 0;
      waitpid(one, &status, 0);
      killed_in_work += WIFSIGNALED(status) ? 1 : 0;
    }
    // What is there is whole.
    if (fs::exists(options_.output / "units")) {
      for (const auto& entry : fs::directory_iterator(options_.output / "units")) {
        EXPECT_EQ(read_result(entry.path()).status, Status::Done);
        EXPECT_TRUE(fs::exists(entry.path() / "verdict.json"));
      }
    }
  }
  EXPECT_GT(killed_in_work, 3U) << "or nothing was tested";
  const auto all = rows();
  EXPECT_EQ(counts_of(all), (std::array<std::size_t, 4>{0, count, 0, 0}));
  EXPECT_EQ(std::distance(fs::directory_iterator(options_.output / "units"), {}), static_cast<std::ptrdiff_t>(count));
  EXPECT_TRUE(nothing_left_over());
  EXPECT_EQ(work().ran, 0U);
}

/// Without a kill, several controllers do each unit exactly once.
TEST_F(Fleet, SeveralAtOnceDoEachUnitOnce) {
  for (int i = 0; i < 30; ++i) {
    add("M" + std::to_string(i), "verdict named\n");
  }
  for (const pid_t one : controllers(3)) {
    waitpid(one, nullptr, 0);
  }
  EXPECT_EQ(ran(), 30U);
  EXPECT_EQ(counts_of(rows()), (std::array<std::size_t, 4>{0, 30, 0, 0}));
}

}  // namespace
}  // namespace hysteron::fleet
