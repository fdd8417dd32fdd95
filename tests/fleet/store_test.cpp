// The database of a fleet: derived from the folders of the units, at any time, whatever happens to its writer.
#include "fleet/store.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "database/sqlite.hpp"
#include "fleet/run_record.hpp"
#include "support/atomic_file.hpp"
#include "tests/support/scratch_folder.hpp"

namespace hysteron::fleet {
namespace {

namespace fs = std::filesystem;

class FleetStore : public ::testing::Test {
 protected:
  /// A unit that was diagnosed, as its command leaves it.
  void add(const std::string& machine, const std::string& when, double k) {
    Unit unit{.machine = machine, .when = when, .group = "axes", .diagram = "a.st", .line = 2};
    const std::string key = std::string(60, 'a') + std::to_string(1000 + units_.size());
    write_result(folder_of(output_, key), unit, "1", {.status = Status::Done, .seconds = 0.5});
    write_file_atomically(
        folder_of(output_, key) / "verdict.json",
        R"({"verdict": "named", "confidence": 0.8, "effects": [{"id": "lag", "edge": "U", "share": 0.5,
      "parameters": {"T1": {"value": 2, "low": 1, "high": 3, "unit": "s"}}}], "families": [
      {"family": "delay", "effect": "lag", "edge": "U", "effect_probability": 0.9},
      {"family": "friction", "effect": "stiction", "edge": "X", "effect_probability": 0.1}],
      "gap": {"nominal_rms": 2, "improved_rms": 1, "unit": "um"}, "calibration": {"AMP.K": {"value": )" +
            std::to_string(k) + R"(, "low": null, "high": null, "unit": "um/V"}}})");
    units_.push_back(unit);
    keys_.push_back(key);
  }
  void record() {
    fs::create_directories(output_ / "claims");
    write_run(output_,
              {.manifest = "fleet.csv", .version = "1", .options = {"--effort", "1"}, .units = units_, .keys = keys_});
  }
  [[nodiscard]] fs::path file() const { return output_ / "fleet.sqlite"; }

  /// All rows of all tables, as text.
  [[nodiscard]] std::string dump() const {
    database::Database database(file(), database::Database::Mode::Read);
    std::string text;
    for (const auto& [table, columns] : std::vector<std::pair<std::string, int>>{
             {"runs", 6}, {"units", 20}, {"run_units", 3}, {"effects", 7}, {"parameters", 9}}) {
      auto rows = database.prepared("SELECT * FROM " + table + " ORDER BY 1, 2, 3");
      while (rows.step()) {
        text += table;
        for (int i = 0; i < columns; ++i) {
          text += "|" + rows.text(i);
        }
        text += "\n";
      }
    }
    return text;
  }
  [[nodiscard]] double ask(const std::string& question) const {
    database::Database database(file(), database::Database::Mode::Read);
    auto row = database.prepared(question);
    return row.step() ? row.number(0) : not_a_number;
  }

  test::ScratchFolder folder_;
  fs::path output_ = folder_.path() / "out";
  std::vector<Unit> units_;
  std::vector<std::string> keys_;
};

TEST_F(FleetStore, HoldsWhatTheUnitsFound) {
  add("Axis 1", "2026-05-01", 4.0);
  add("Axis 1", "2026-05-02", 5.0);
  record();
  (void)write_table(units_, keys_, output_);
  EXPECT_EQ(ask("PRAGMA user_version"), store_version);
  EXPECT_EQ(ask("SELECT count(*) FROM current_units WHERE machine = 'Axis 1' AND status = 'done'"), 2.0);
  EXPECT_EQ(ask("SELECT max(value) FROM parameters WHERE name = 'AMP.K' AND source = 'calibration'"), 5.0);
  EXPECT_NEAR(ask("SELECT standard_error FROM parameters WHERE name = 'lag at U: T1'"), 1.0 / 1.96, 1e-4);
  EXPECT_EQ(ask("SELECT probability FROM effects WHERE effect = 'lag' AND is_named"), 0.9);
  EXPECT_EQ(ask("SELECT count(*) FROM effects WHERE NOT is_named AND effect = 'stiction'"), 2.0);
  EXPECT_FALSE(fs::exists(file().string() + "-wal"));
  EXPECT_EQ(ask("SELECT count(*) FROM pragma_journal_mode WHERE journal_mode = 'delete'"), 1.0)
      << "a single file, for a folder that nobody may write";
}

TEST_F(FleetStore, KeepsWhatEarlierManifestsNamed) {
  add("Axis 1", "2026-05-01", 4.0);
  record();
  add("Axis 2", "2026-05-01", 5.0);
  units_.erase(units_.begin());
  keys_.erase(keys_.begin());
  record();
  (void)write_table(units_, keys_, output_);
  EXPECT_EQ(ask("SELECT count(*) FROM units"), 2.0);
  EXPECT_EQ(ask("SELECT count(*) FROM current_units"), 1.0);
  EXPECT_EQ(ask("SELECT count(*) FROM current_units WHERE machine = 'Axis 2'"), 1.0);
}

TEST_F(FleetStore, WhatAKilledWriterOfARunLeftIsNoRun) {
  add("Axis 1", "2026-05-01", 4.0);
  record();
  const auto runs = read_runs(output_);
  ASSERT_EQ(runs.size(), 1U);
  fs::copy_file(output_ / "runs" / (runs[0].id + ".json"), output_ / "runs" / (runs[0].id + ".json.x1y2z3"));
  write_file_atomically(output_ / "runs" / "notes.json", "{}");
  EXPECT_EQ(read_runs(output_).size(), 1U);
  record();
  EXPECT_EQ(read_runs(output_).size(), 1U) << "the same units are the same run";
  EXPECT_GT(read_runs(output_)[0].last, runs[0].last);
}

TEST_F(FleetStore, AWriterThatIsKilledAtAnyMomentLosesNothing) {
  for (int i = 0; i < 60; ++i) {
    add("Axis " + std::to_string(i % 7), "2026-05-01", i);
  }
  record();
  (void)write_table(units_, keys_, output_);
  const std::string all = dump();
  ASSERT_GT(all.size(), 10000U);
  std::size_t killed = 0;
  std::uint32_t random = 11;
  for (int round = 0; round < 40; ++round) {
    const pid_t writer = fork();
    if (writer == 0) {
      for (;;) {
        (void)write_table(units_, keys_, output_);
      }
    }
    random = random * 1664525U + 1013904223U;
    std::this_thread::sleep_for(std::chrono::microseconds(500 + (random >> 8U) % 30000U));
    ::kill(writer, SIGKILL);
    int status = 0;
    waitpid(writer, &status, 0);
    killed += WIFSIGNALED(status) ? 1 : 0;
    EXPECT_EQ(dump(), all) << "the one before is whole";
  }
  EXPECT_EQ(killed, 40U);
  fs::remove(file());
  (void)write_table(units_, keys_, output_);
  EXPECT_EQ(dump(), all) << "derived again";
  EXPECT_TRUE(fs::is_empty(output_ / "work"));
}

}  // namespace
}  // namespace hysteron::fleet
