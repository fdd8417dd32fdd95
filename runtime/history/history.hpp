// The history of a task: chosen points, kept for days in a file of SQLite, in a thread of its own. The cyclic thread
// lays rows into a tap and goes on, whatever becomes of the file.
//
// A write that fails is tried again, after 1 s at first and after a minute at last. Rows wait in the tap meanwhile, and
// are lost, and counted, where it has no more room. A file that was moved or deleted is followed by another.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "runtime/history/history_file.hpp"
#include "runtime/task/remarks.hpp"
#include "runtime/task/sample_tap.hpp"
#include "runtime/task/task_time.hpp"

namespace hysteron::runtime {

/// As point task.history_fault says it.
enum class HistoryFault : std::uint16_t { None, Full, Unreachable, Damaged, Held };

struct HistorySettings {
  HistoryPlan plan{};
  std::optional<HistoryLock> lock{};  ///< where it is held already
  std::int64_t keep = 0;              ///< ns
  bool virtual_time = false;          ///< rows then have the time that the virtual clock says
};

/// What the thread does, a turn after the other; it may be called from one thread at a time.
class HistoryKeeper {
 public:
  HistoryKeeper(HistorySettings settings, SampleTap& tap, KeptCounter& counter, BesideClocks clocks);

  /// Writes what is in the tap. `is_last`: tries it also where it would wait, and counts what cannot be written.
  void turn(bool is_last = false);
  [[nodiscard]] Remarks& remarks() { return remarks_; }

 private:
  void open();
  void write(std::int64_t now);
  void trim(std::int64_t now);
  void failed(const database::DatabaseError& problem);
  void is_well();
  void watch_clock();

  HistorySettings settings_;
  SampleTap* tap_;
  KeptCounter* counter_;
  TaskTime time_;
  std::optional<HistoryFile> file_{};
  bool is_damaged_ = false;
  std::vector<Sample> waiting_{};            ///< taken from the tap, and not yet on the disk
  std::optional<std::int64_t> newest_ms_{};  ///< of the rows on the disk
  std::int64_t judges_age_from_ = 0;
  std::int64_t retry_at_ = 0;
  std::int64_t pause_ = 0;
  Remarks remarks_{};
};

class History {
 public:
  History(HistorySettings settings, SampleTap& tap, KeptCounter& counter, BesideClocks clocks);
  History(const History&) = delete;
  History& operator=(const History&) = delete;
  History(History&&) = delete;
  History& operator=(History&&) = delete;
  ~History();

  /// After the task has ended: writes the rest, and ends the thread.
  void finish();
  [[nodiscard]] HistoryKeeper& keeper() { return keeper_; }

 private:
  void run();

  std::chrono::milliseconds interval_;
  HistoryKeeper keeper_;
  std::mutex mutex_;
  std::condition_variable asked_;
  bool is_over_ = false;
  std::thread thread_;
};

}  // namespace hysteron::runtime
