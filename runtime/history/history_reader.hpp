// Reading a history, beside the task that writes it or when it is over. A reader has its own connection and never makes
// the writer wait.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "database/sqlite.hpp"

namespace hysteron::runtime {

struct RecordedPoint {
  std::string column{};
  std::string name{};
  std::string unit{};
  std::string meaning{};
};

/// One start of a task.
struct RecordedRun {
  std::int64_t run = 0;
  std::string title{};
  std::int64_t begun_ms = 0;
  std::int64_t period = 0;  ///< of a cycle, in ns
  std::int64_t step = 1;    ///< periods from row to row
  std::vector<RecordedPoint> points{};

  [[nodiscard]] double sample_time() const { return static_cast<double>(period * step) / 1e9; }
};

/// What is asked for. Both times are UTC in milliseconds, and belong to it.
struct HistorySpan {
  std::optional<std::int64_t> from_ms{};
  std::optional<std::int64_t> to_ms{};
  std::optional<std::int64_t> run{};
};

/// Rows that follow each other on the even grid of their run, without a gap.
struct Stretch {
  std::int64_t run = 0;
  std::int64_t first = 0;  ///< by number of the row
  std::int64_t last = 0;
  std::int64_t rows = 0;
  std::int64_t first_slot = 0;  ///< on the grid of its run
  std::int64_t first_ms = 0;
  std::int64_t last_ms = 0;
  std::int64_t late = 0;  ///< rows that were taken after their time, since cycles were skipped
};

/// A step of the wall clock within a run, against the periods of the task.
struct ClockStep {
  std::int64_t at_ms = 0;  ///< of the row behind it
  double seconds = 0.0;
};

struct StretchList {
  std::vector<Stretch> stretches{};  ///< as they were written
  std::vector<ClockStep> clock_steps{};
};

class HistoryReader {
 public:
  /// Throws InputError HY818 where the file is no history of this version, or cannot be read.
  explicit HistoryReader(const std::filesystem::path& file);

  /// All runs of which there are rows.
  [[nodiscard]] std::vector<RecordedRun> runs();
  /// UTC of the newest row, in milliseconds; nothing in a history without rows.
  [[nodiscard]] std::optional<std::int64_t> newest_ms();
  [[nodiscard]] StretchList stretches(const HistorySpan& span);
  /// The values of a stretch, a vector for each column.
  [[nodiscard]] std::vector<std::vector<double>> values(const Stretch& stretch, std::span<const RecordedPoint> points);

  /// From here on all answers are of this moment. Not for long: the writer's log grows meanwhile.
  void hold_still() { database_.run("BEGIN"); }
  [[nodiscard]] database::Database& database() { return database_; }

 private:
  database::Database database_;
};

/// As 2026-11-28T07:05:00.250Z.
[[nodiscard]] std::string utc_text(std::int64_t ms);

}  // namespace hysteron::runtime
