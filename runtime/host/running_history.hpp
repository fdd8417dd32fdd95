// The history of a run, from the refusals before it to the last row.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "runtime/config/run_config.hpp"
#include "runtime/history/history.hpp"
#include "runtime/task/sample_tap.hpp"
#include "runtime/task/task.hpp"

namespace hysteron::runtime {

/// Those of the machine; `door` tells how many periods have passed.
[[nodiscard]] BesideClocks clocks_beside(PointDoor& door);

/// Points by their names, which are there, as indices into those of the door.
[[nodiscard]] std::vector<std::size_t> points_named(const std::vector<std::string>& names,
                                                    std::span<const Point> points);

/// How many rows wait for a disk that is slow or gone: those of half a minute, as far as memory for them is sensible.
[[nodiscard]] std::size_t waiting_rows(std::int64_t period, std::uint64_t step, std::size_t points);

class RunningHistory {
 public:
  /// Writes nothing but the lock. Throws InputError HY815 where another task writes the file, HY817 where the file is
  /// of something else. A disk that is missing or full refuses no start: control goes on without a history.
  RunningHistory(const HistoryConfig& config, const ProgramShape& shape, Task& task, bool virtual_time);

  [[nodiscard]] SampleTap& tap() { return tap_; }
  [[nodiscard]] const KeptCounter& counter() const { return counter_; }

  /// Begins to write.
  void start();
  [[nodiscard]] Remarks& remarks() { return history_->keeper().remarks(); }
  /// After the task has ended.
  void finish() { history_->finish(); }

 private:
  HistorySettings settings_;
  PointDoor* door_;
  KeptCounter counter_{};
  SampleTap tap_;
  std::unique_ptr<History> history_;
};

}  // namespace hysteron::runtime
