// The points of a task, and what servers ask of it, on its way into the cyclic thread.
//
// Inputs that no device gives are written here; parameters are staged and committed; commands are counted; inputs are
// forced. What the cyclic thread takes is always one whole set of orders, the newest, between two steps.
//
// The clients of Modbus and the live page have a staged set each. A commit of one leaves what the other has staged.
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
#include "runtime/task/live_row.hpp"
#include "runtime/task/safe_outputs.hpp"
#include "runtime/task/sample_tap.hpp"
#include "runtime/task/staged_parameters.hpp"
#include "runtime/task/step_program.hpp"
#include "runtime/task/task_status.hpp"

namespace hysteron::runtime {

/// All that is asked of the cyclic thread; the counters say what is new.
struct TaskOrders {
  std::vector<double> inputs{};
  std::vector<std::uint64_t> input_writes{};
  std::vector<double> parameters{};
  std::uint64_t commits = 0;
  std::uint64_t resets = 0;
  double heartbeat = 0.0;
  std::vector<std::optional<double>> forces{};  ///< by input
  std::uint64_t forcing = 0;                    ///< sets of forces ordered, the empty one too
};

struct InputSettings {
  bool from_device = false;       ///< nobody else may write it
  std::uint64_t longest_age = 0;  ///< cycles since the last write of a server; 0: never stale
  bool is_retained = false;       ///< what servers write is kept through a restart
  std::optional<double> start{};  ///< what it begins with; else the diagram's
};

class TaskDoor final : public PointDoor {
 public:
  /// `inputs`, by input, and `safety`, by output. `field_points`: what the field says of itself. The program must
  /// outlive the door.
  TaskDoor(const StepProgram& program, const std::vector<InputSettings>& inputs,
           const std::vector<OutputSafety>& safety, const std::vector<Point>& field_points = {});

  [[nodiscard]] std::span<const Point> points() const override { return points_; }
  void read(Snapshot& into) override;
  std::string write(std::span<const PointWrite> writes) override;
  void writes_are_owned(bool are_owned) override;
  [[nodiscard]] std::shared_ptr<const LiveView> view() const override;
  void read_live(LiveValues& into) override;
  std::string write_from_page(std::span<const PointWrite> writes) override;
  std::string force(std::span<const Force> inputs) override;
  void end_forces() override;
  void shortage(Shortage what, bool is_there) noexcept override;

  /// The names of the inputs that are forced, with their values: X = 1.5.
  [[nodiscard]] std::vector<std::string> forced();

  // For an online change, from a thread beside the cyclic one:
  /// While it is under way no set of parameters is committed, which would be judged by the version that goes.
  void hold_commits(bool held);
  /// points() as a version has them, by their places: their ranges are the version's, and behind them are the
  /// parameters that came with this version or any before it. A parameter that the version has not stays as it was.
  [[nodiscard]] std::vector<Point> points_of(const RunningVersion& version) const;
  /// A row for the values of a version of the diagram, which publish() fills while it runs.
  [[nodiscard]] std::shared_ptr<LiveRow> live_row(const RunningVersion& version) const;
  /// Another version counts. Sets are judged by it from now on, and the live page sees it. What was staged stays so; a
  /// parameter that is no more takes no value.
  void version_changed(const RunningVersion& version);

  /// Before the task runs: every cycle published goes to these as well. They must outlive the run.
  void attach(std::vector<SampleTap*> taps) { taps_ = std::move(taps); }

  // For the cyclic thread alone.
  [[nodiscard]] const TaskOrders* take_orders() noexcept { return orders_.take(); }
  /// All forces up to those that were ordered as so manieth are ended by the task itself.
  void forces_ended(std::uint64_t through) noexcept { ended_forcing_.store(through, std::memory_order_relaxed); }
  /// `forces`, by input; `live`: where the version that runs is not the first.
  void publish(const StepProgram& program, std::span<const double> inputs, std::span<const double> outputs,
               const TaskStatus& status, const LoopStatistics& statistics,
               std::span<const std::optional<double>> forces = {}, const LiveVersion& live = {}) noexcept;

 private:
  enum class Command : std::uint8_t { commit, discard, reset, heartbeat };
  /// What of a row is there: nothing before the first cycle; the points alone, where a version has only just taken
  /// over.
  enum class Row : std::uint8_t { none, points, whole };

  void add(Point point) { points_.push_back(std::move(point)); }
  void add_command(const char* name, WriteRight right, const char* meaning);
  [[nodiscard]] std::string carry_out(std::span<const PointWrite> writes, StagedParameters& own,
                                      StagedParameters& others);
  [[nodiscard]] std::optional<std::size_t> parameter_at(std::size_t place) const;
  [[nodiscard]] std::size_t place_of(std::size_t parameter) const;
  /// Into row_, the newest row of the version that runs.
  [[nodiscard]] Row read_row(std::uint64_t& cycle);
  void make_view(const RunningVersion& version);
  [[nodiscard]] std::vector<std::optional<double>> forces_now() const;
  void order_forces(std::vector<std::optional<double>> forces);
  void order();

  std::vector<Point> points_;
  std::size_t inputs_ = 0;
  std::size_t first_parameter_ = 0;
  std::size_t parameter_count_ = 0;  ///< of the first version
  std::size_t first_status_ = 0;
  std::size_t first_command_ = 0;
  SnapshotRing snapshots_;
  std::vector<double> published_;  ///< of the cyclic thread
  std::vector<double> safe_;       ///< by output: what it is before the first cycle
  std::vector<SampleTap*> taps_{};
  std::int64_t high_lateness_ = 0;
  std::atomic<std::uint16_t> shortages_{0};

  std::atomic<std::uint64_t> ended_forcing_{0};
  std::atomic<bool> was_forced_{false};

  mutable std::mutex servers_;  ///< between servers; the cyclic thread never takes it
  ProgramShape judged_by_;      ///< the parameters by place, as the version judges them which runs
  std::vector<bool> gone_;      ///< by place of a parameter: not in the version that runs
  bool commits_are_held_ = false;
  bool writes_are_owned_ = false;
  StagedParameters plant_;  ///< staged by write()
  StagedParameters page_;
  std::shared_ptr<const LiveView> view_;
  std::vector<std::size_t> columns_;  ///< by point of the view: of a published row
  /// By parameter that came with an online change: the column; none where the version that runs has it not.
  std::vector<std::optional<std::size_t>> further_{};
  std::shared_ptr<LiveRow> live_{};  ///< of the version that runs; none of the first
  std::vector<double> row_;          ///< read last
  std::vector<double> newer_;        ///< the same, while it is not known to be the newer one
  TaskOrders wanted_;
  Latest<TaskOrders> orders_;
};

}  // namespace hysteron::runtime
