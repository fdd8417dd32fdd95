// A cyclic task: a program, its outputs made safe, and all that watches, keeps and records it.
//
// One cycle: take what servers ordered; read devices; put forced inputs in their place; step; limit the outputs; tell
// the guard; write devices; trace, retain, publish. The thread allocates nothing, takes no lock and calls nothing of
// the system but sleep and clock.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <vector>

#include "runtime/task/changeable_program.hpp"
#include "runtime/task/cyclic_loop.hpp"
#include "runtime/task/fault_log.hpp"
#include "runtime/task/field_io.hpp"
#include "runtime/task/guard.hpp"
#include "runtime/task/load.hpp"
#include "runtime/task/retain.hpp"
#include "runtime/task/safe_outputs.hpp"
#include "runtime/task/sound_state.hpp"
#include "runtime/task/step_program.hpp"
#include "runtime/task/task_door.hpp"
#include "runtime/task/trace.hpp"
#include "runtime/task/watchdog.hpp"

namespace hysteron::runtime {

struct TaskSettings {
  LoopSettings loop{};
  WatchdogSettings watchdog{};
  std::vector<InputSettings> inputs{};
  std::vector<OutputSafety> outputs{};
  std::uint64_t retain_every = 1000;               ///< cycles
  std::int64_t longest_delivery = 10'000'000'000;  ///< at the end: for devices to take the safe values, once reached
  /// After a lost client the outputs stay safe until task.reset, not only until it is back.
  bool reset_after_lost_client = false;
  double most_load = 0.8;             ///< of the time, what the cyclic thread may compute
  bool overload_is_a_fault = false;   ///< else it is told of
  std::vector<Point> field_points{};  ///< what the field says of itself (FieldIo::count)
};

/// Each may be null.
struct TaskAttachments {
  FieldIo* field = nullptr;
  Guard* guard = nullptr;
  Retainer* retainer = nullptr;
  Trace* trace = nullptr;
  const KeptCounter* history = nullptr;
  const KeptCounter* mqtt = nullptr;
  ChangeableProgram* changes = nullptr;  ///< the program itself, where its version may change
};

class Task final : private CycleBody {
 public:
  /// The loop's period is the program's. Throws std::invalid_argument where settings do not fit the program.
  Task(StepProgram& program, const TaskSettings& settings, TaskAttachments attachments = {});

  /// Runs until it is stopped or ends by itself, and then brings the outputs to their safe values, for as long as their
  /// holds and ramps take. In the calling thread, whose scheduling is the caller's care.
  LoopEnd run(Clock& clock, const std::atomic<bool>& stop);

  [[nodiscard]] TaskDoor& door() noexcept { return door_; }
  /// From a server's thread: the client that has to be heard is lost, or is back. Counts from the next cycle on.
  void client_lost(bool lost) noexcept;
  /// From a thread beside the cyclic one: the guard's process died. The task ends after this cycle, with safe outputs:
  /// nobody would make them safe if it hung or died.
  void guard_lost() noexcept;
  /// From a thread beside the cyclic one: what keeps clients of TLS away, as task.tls_fault says it. No fault of the
  /// task: the control goes on.
  void tls_fault(std::uint8_t fault) noexcept { tls_fault_.store(fault, std::memory_order_relaxed); }
  /// The same of how many days its certificate still counts.
  void tls_days(std::uint16_t days) noexcept { tls_days_.store(days, std::memory_order_relaxed); }
  /// Not while it runs; then, points() of the door say the same.
  [[nodiscard]] const LoopStatistics& statistics() const noexcept { return statistics_; }
  /// After run(): what ended it, or what was wrong at its end; stop where nothing was.
  [[nodiscard]] Fault fault() const noexcept { return status_.fault; }
  /// From any thread.
  [[nodiscard]] FaultReport faults() const noexcept { return faults_.report(); }
  /// From any thread.
  [[nodiscard]] LoadReport load() const noexcept { return load_.report(); }
  /// From any thread: moves for as long as the cycles go on, those on the way to the safe values too.
  [[nodiscard]] std::uint64_t beats() const noexcept { return beats_.load(std::memory_order_relaxed); }
  [[nodiscard]] std::span<const double> outputs() const noexcept { return safe_.values(); }
  /// For a guard, before run(): where the outputs begin, and how they become safe.
  [[nodiscard]] const SafeOutputs& safe_outputs() const noexcept { return safe_; }
  /// Before run(): what is opened last, since a start that is refused must leave devices and files alone.
  void attach(TaskAttachments attachments) noexcept { attachments_ = attachments; }

 private:
  bool cycle(const CycleMoment& moment) noexcept override;
  bool finished(const LoopStatistics& statistics, std::int64_t duration, Verdict verdict) noexcept override;

  void take_orders() noexcept;
  void follow_change(std::uint64_t cycle) noexcept;
  /// After a step, once it is written and traced: a state with a number that is not finite would stay so, and the
  /// outputs safe.
  void keep_sound() noexcept;
  [[nodiscard]] Fault read_inputs() noexcept;
  [[nodiscard]] bool write_outputs() noexcept;
  void beat() noexcept { beats_.store(beats_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed); }
  void count_writes() noexcept;
  void publish(const LoopStatistics& statistics) noexcept;
  /// What is kept and traced: the version that runs, with all its parameters.
  [[nodiscard]] const StepProgram& running() const noexcept {
    return attachments_.changes == nullptr ? *program_ : attachments_.changes->running().program();
  }
  void settle(Clock& clock, Fault fault);
  /// Until the live page forces anew.
  void end_forces() noexcept;

  StepProgram* program_;
  TaskSettings settings_;
  TaskAttachments attachments_;
  TaskDoor door_;
  SafeOutputs safe_;
  SoundState first_sound_;
  SoundState* sound_ = &first_sound_;  ///< of the version that runs
  Watchdog watchdog_;
  LoadWatch load_;
  LoopStatistics statistics_{};
  std::uint64_t applied_commits_ = 0;
  std::uint64_t offered_commits_ = 0;  ///< to be retained
  bool has_changed_ = false;           ///< the version, in this cycle
  TaskStatus status_{};
  FaultLog faults_{};
  std::size_t faulty_port_ = no_port;  ///< of what read_inputs() found
  bool is_awaited_ = false;            ///< what it found: no fault yet, for the first exchange still has time
  std::vector<double> field_counts_;
  std::vector<double> given_;   ///< inputs as servers and devices give them
  std::vector<double> inputs_;  ///< as the program takes them: with those that are forced
  std::vector<std::optional<double>> forces_;
  std::uint64_t forcing_seen_ = 0;
  std::vector<double> last_good_;
  std::vector<double> computed_;
  std::vector<std::uint64_t> writes_seen_;
  std::vector<std::uint64_t> ages_;
  std::uint64_t resets_seen_ = 0;
  std::atomic<std::uint64_t> beats_{0};
  std::atomic<bool> client_is_lost_{false};
  std::atomic<bool> client_was_lost_{false};  ///< and no reset came since; only where one is asked for
  std::atomic<bool> guard_is_lost_{false};
  std::atomic<std::uint8_t> tls_fault_{0};
  std::atomic<std::uint16_t> tls_days_{no_certificate};
  bool tripped_ = false;
  bool guard_took_over_ = false;
};

}  // namespace hysteron::runtime
