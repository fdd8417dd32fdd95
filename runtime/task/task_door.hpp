// The points of a task, and what servers ask of it, on its way into the cyclic thread.
//
// Inputs that no device gives are written here; parameters are staged and committed; commands are counted. What the
// cyclic thread takes is always one whole set of orders, the newest, between two steps.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "runtime/point.hpp"
#include "runtime/task/exchange.hpp"
#include "runtime/task/lateness.hpp"
#include "runtime/task/safe_outputs.hpp"
#include "runtime/task/sample_tap.hpp"
#include "runtime/task/staged_parameters.hpp"
#include "runtime/task/step_program.hpp"

namespace hysteron::runtime {

/// All that is asked of the cyclic thread; the counters say what is new.
struct TaskOrders {
  std::vector<double> inputs{};
  std::vector<std::uint64_t> input_writes{};
  std::vector<double> parameters{};
  std::uint64_t commits = 0;
  std::uint64_t resets = 0;
  double heartbeat = 0.0;
};

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
  std::size_t absent = 0;  ///< devices
  bool trace_is_cut = false;
  std::uint64_t version = 1;     ///< of the diagram, since the start
  std::uint8_t last_change = 0;  ///< online, as task.online_change says it
  double heartbeat = 0.0;
  std::span<const double> field{};  ///< as the points of the field
};

struct InputSettings {
  bool from_device = false;       ///< nobody else may write it
  std::uint64_t longest_age = 0;  ///< cycles since the last write of a server; 0: never stale
  bool is_retained = false;       ///< what servers write is kept through a restart
  std::optional<double> start{};  ///< what it begins with; else the diagram's
};

/// The names of what a task says of itself: task.state, …
[[nodiscard]] std::span<const char* const> status_names();

class TaskDoor final : public PointDoor {
 public:
  /// `inputs`, by input, and `safety`, by output. `field_points`: what the field says of itself. The program must
  /// outlive the door.
  TaskDoor(const StepProgram& program, const std::vector<InputSettings>& inputs,
           const std::vector<OutputSafety>& safety, const std::vector<Point>& field_points = {});

  [[nodiscard]] std::span<const Point> points() const override { return points_; }
  void read(Snapshot& into) override;
  std::string write(std::span<const PointWrite> writes) override;
  [[nodiscard]] std::span<const Point> inner() const override { return inner_; }
  void read_live(LiveValues& into) override;
  void shortage(Shortage what, bool is_there) noexcept override;

  // For an online change, from a thread beside the cyclic one:
  /// While it is under way no set of parameters is committed, which would be judged by the version that goes.
  void hold_commits(bool held);
  /// Another version counts. Sets are judged by it from now on; `places`: by parameter of the first version, that of
  /// this one. What was staged stays so; a parameter that is no more takes no value.
  void version_changed(const StepProgram& version, std::span<const std::optional<std::size_t>> places);

  /// Before the task runs: every cycle published goes to these as well. They must outlive the run.
  void attach(std::vector<SampleTap*> taps) { taps_ = std::move(taps); }

  // For the cyclic thread alone.
  [[nodiscard]] const TaskOrders* take_orders() noexcept { return orders_.take(); }
  void publish(const StepProgram& program, std::span<const double> inputs, std::span<const double> outputs,
               const TaskStatus& status, const LoopStatistics& statistics) noexcept;

 private:
  enum class Command : std::uint8_t { commit, discard, reset, heartbeat };

  void add(Point point) { points_.push_back(std::move(point)); }
  [[nodiscard]] std::uint16_t shortages_of(const TaskStatus& status) const noexcept;
  void add_command(const char* name, WriteRight right, const char* meaning);

  std::vector<Point> points_;
  std::vector<Point> inner_;
  std::size_t first_parameter_ = 0;
  std::size_t first_command_ = 0;
  SnapshotRing snapshots_;
  std::vector<double> published_;  ///< of the cyclic thread
  std::vector<SampleTap*> taps_{};
  std::int64_t high_lateness_ = 0;
  std::atomic<std::uint16_t> shortages_{0};

  std::mutex servers_;      ///< between servers; the cyclic thread never takes it
  ProgramShape judged_by_;  ///< the parameters of the first version, as that judges them which runs
  std::vector<bool> gone_;  ///< by parameter: not in the version that runs
  bool commits_are_held_ = false;
  StagedParameters parameters_;
  TaskOrders wanted_;
  Latest<TaskOrders> orders_;
};

}  // namespace hysteron::runtime
