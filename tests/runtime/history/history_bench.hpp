// A history without a task: clocks that the test sets, and rows that it gives.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "runtime/history/history.hpp"
#include "runtime/history/history_reader.hpp"
#include "tests/runtime/namespaces.hpp"

namespace hysteron::runtime::test {

inline constexpr std::int64_t ms = 1'000'000;
inline constexpr std::int64_t one_second = 1000 * ms;
inline constexpr std::int64_t noon = 1'795'867'200 * one_second;  ///< 2026-11-28T12:00:00Z

/// A task of 1 ms with two points, a row every `step` cycles. U is the number of the cycle, Y its half.
class HistoryBench {
 public:
  explicit HistoryBench(const std::filesystem::path& file, std::uint64_t step = 10, std::uint64_t bytes = 100'000'000)
      : settings_{.plan = {.file = file,
                           .bytes = bytes,
                           .run = {.key = file.string(), .title = "STAGE", .period = ms, .step = step},
                           .points = {{.name = "U", .kind = PointKind::input, .unit = "V"},
                                      {.name = "Y", .kind = PointKind::output, .unit = "um", .meaning = "the way"}}},
                  .keep = 30 * 86'400 * one_second} {}

  HistorySettings& settings() { return settings_; }
  /// The task starts, again with another key.
  void start(std::size_t tap_rows = 3000) {
    keeper_.reset();
    settings_.plan.run.key += "'";
    elapsed_ = 0;
    slots_ = std::make_unique<SampleTap>(std::vector<std::size_t>{0, 1}, settings_.plan.run.step, tap_rows, counter_);
    keeper_ = std::make_unique<HistoryKeeper>(
        HistorySettings{.plan = settings_.plan, .keep = settings_.keep, .virtual_time = settings_.virtual_time},
        *slots_, counter_,
        BesideClocks{.utc = [this] { return utc_; },
                     .steady = [this] { return steady_; },
                     .elapsed = [this] { return elapsed_; }});
  }
  /// Cycles of the task, and the clocks with them.
  void run(std::uint64_t cycles) {
    for (std::uint64_t i = 0; i < cycles; ++i) {
      skip(1);
      const double u = static_cast<double>(elapsed_);
      slots_->offer(elapsed_, elapsed_, std::vector<double>{u, 0.5 * u});
    }
  }
  /// Periods without a cycle.
  void skip(std::uint64_t periods) {
    elapsed_ += periods;
    pass(static_cast<std::int64_t>(periods) * ms);
  }
  void pass(std::int64_t time) {
    utc_ += time;
    steady_ += time;
  }
  void set_clock(std::int64_t step) { utc_ += step; }
  void turn(bool is_last = false) { keeper_->turn(is_last); }
  /// A second of the task, and a turn.
  void second() {
    run(1000);
    turn();
  }
  void stop() { turn(true); }

  [[nodiscard]] KeptCount count() const { return counter_.read(); }
  [[nodiscard]] HistoryKeeper& keeper() { return *keeper_; }
  [[nodiscard]] std::string said() {
    std::string text;
    for (const std::string& line : keeper_->remarks().lines()) {
      text += line + "\n";
    }
    return text;
  }
  [[nodiscard]] std::int64_t utc_ms() const { return utc_ / ms; }
  [[nodiscard]] const std::filesystem::path& file() const { return settings_.plan.file; }

 private:
  HistorySettings settings_;
  KeptCounter counter_{};
  std::unique_ptr<SampleTap> slots_;
  std::unique_ptr<HistoryKeeper> keeper_;
  std::int64_t utc_ = noon;
  std::int64_t steady_ = 1000 * one_second;
  std::uint64_t elapsed_ = 0;
};

/// All rows of a point, as they were written.
inline std::vector<double> column_of(const std::filesystem::path& file, std::size_t point) {
  HistoryReader reader(file);
  std::vector<double> all;
  for (const RecordedRun& run : reader.runs()) {
    for (const Stretch& stretch : reader.stretches({.run = run.run}).stretches) {
      const auto values = reader.values(stretch, run.points);
      all.insert(all.end(), values[point].begin(), values[point].end());
    }
  }
  return all;
}

}  // namespace hysteron::runtime::test
