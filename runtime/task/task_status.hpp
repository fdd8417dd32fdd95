// What a task says of itself once a cycle, and the points that show it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "runtime/point.hpp"
#include "runtime/task/lateness.hpp"
#include "runtime/task/safe_outputs.hpp"
#include "runtime/task/sample_tap.hpp"

namespace hysteron::runtime {

/// In place of the days that a certificate counts.
inline constexpr std::uint16_t no_certificate = 65'535;

enum class TaskState : std::uint8_t { starting, running, faulted, stopped };

/// What a task says of itself once a cycle.
struct TaskStatus {
  TaskState state = TaskState::starting;
  Fault fault = Fault::none;
  std::uint64_t commits = 0;  ///< sets of parameters applied, and on the disk where they are retained
  std::uint64_t retained = 0;
  std::uint64_t dropped = 0;
  std::uint64_t write_failures = 0;  ///< of the trace and of retained values
  std::uint64_t not_taken = 0;       ///< values of devices
  std::uint64_t faults = 0;          ///< that began
  Fault last_fault = Fault::none;    ///< the newest, over or not
  KeptCount history{};
  KeptCount mqtt{};
  std::uint8_t tls_fault = 0;
  std::uint16_t tls_days = no_certificate;  ///< until the server's certificate ends
  std::size_t absent = 0;                   ///< devices
  bool trace_is_cut = false;
  bool retain_fails = false;
  std::uint64_t version = 1;     ///< of the diagram, since the start
  std::uint8_t last_change = 0;  ///< online, as task.online_change says it
  std::size_t forced = 0;        ///< inputs
  std::uint64_t held_back = 0;   ///< outputs, once a cycle
  double load = 0.0;             ///< own processor time over time
  double heartbeat = 0.0;
  std::span<const double> field{};  ///< as the points of the field
};

/// The names of what a task says of itself: task.state, …
[[nodiscard]] std::span<const char* const> status_names();
/// The same as points, in the order of their values.
[[nodiscard]] std::vector<Point> status_points();

inline constexpr std::size_t status_count = 35;
/// `high_lateness`: that of 99.99 % of the cycles; `shortages`: those that servers tell, as bits.
[[nodiscard]] std::array<double, status_count> status_values(const TaskStatus& status, const LoopStatistics& statistics,
                                                             std::int64_t high_lateness,
                                                             std::uint16_t shortages) noexcept;

}  // namespace hysteron::runtime
