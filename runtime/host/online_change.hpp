// An online change: another version of the diagram takes over while the task runs, or is refused with the reason.
//
// All that takes long happens here, beside the cycle: what is carried over is decided by name, type and unit
// (runtime/task/carry.hpp); both versions are compared on a step of the running task; and only a change whose outputs
// stay within their limits is proposed to the cycle, which compares once more (runtime/task/changeable_program.hpp).
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "runtime/config/run_config.hpp"
#include "runtime/host/change_checks.hpp"
#include "runtime/host/served_map.hpp"
#include "runtime/task/changeable_program.hpp"
#include "runtime/task/task.hpp"
#include "support/diagnostic.hpp"

namespace hysteron::runtime {

/// What an output does, or would do, in the first step of the other version.
struct OutputChange {
  std::string name{};
  std::string unit{};
  Bump bump{};
  double limit = 0.0;
  std::string origin{};  ///< of the limit
};

struct ChangeReport {
  std::string program{};
  std::uint64_t version = 0;  ///< that runs now
  bool is_done = false;       ///< else it was only looked at
  std::vector<OutputChange> outputs{};
  std::size_t parameters = 0;  ///< of the other version
  std::size_t parameters_carried = 0;
  std::size_t states = 0;
  std::size_t states_carried = 0;
  std::vector<std::string> left{};          ///< what is not carried over, with the reason: there is the running version
  std::vector<std::string> other_values{};  ///< parameters carried over that the other version gives other values
  RegisterChange registers{};               ///< where they are served
  /// On the way back: what only the version before has, which goes on as it was when that was changed.
  std::vector<std::string> as_before{};
  double step_time = 0.0;     ///< of the other version, beside the task: the mean of its own CPU time, in ns
  std::size_t rehearsed = 0;  ///< of so many steps
  double load = 0.0;          ///< step_time as a part of the period
  double most_load = 1.0;     ///< the most that it may be
  bool is_retained = true;    ///< where values are retained: those of the other version are on the disk
};

class OnlineChange {
 public:
  /// Program, task and what it is begun with must outlive it. `most_load`: of the period, what a step may take.
  OnlineChange(ChangeableProgram& program, Task& task, std::vector<OutputLimit> limits, double most_load = 1.0);

  /// The task runs from now on. Each may be null.
  void begin(Retainer* retainer, const Trace* trace, ServedMap* registers = nullptr);
  /// The task ends: who waits for it is refused, and so is who comes.
  void end() noexcept { has_ended_.store(true); }

  /// What of a change is refused whatever its steps do, before the version is compiled: HY850 where its interface is
  /// another, HY730 where the wish names what it does not have.
  void require_sound(const ProgramShape& next, const ChangeWish& wish) const;
  /// Changes to another version of the diagram, as it begins. Throws InputError as require_sound, HY851 where an output
  /// would jump, HY853 where it cannot be now or its step takes too much of the period, HY855 where parameters do not
  /// go together. Then the running version goes on as if nothing had been.
  ChangeReport change_to(std::unique_ptr<StepProgram> program, const ChangeWish& asked);
  /// The report of a change to what runs already: nothing is done, and the way back stays.
  [[nodiscard]] ChangeReport nothing_to_change() const;
  /// Changes back to the version before. What it has of its own goes on as it was when it was changed; all that both
  /// have is carried back, but for parameters that were taken as given and that nobody has changed since: they are as
  /// before. A second time is forward again. Throws as change_to, HY853 too where there is none.
  ChangeReport change_back(const ChangeWish& asked);
  /// Says in task.shortages whether there is no socket yet on which a change may be asked for.
  void cannot_be_asked_for(bool now) noexcept { task_->door().shortage(Shortage::change, now); }
  /// Says on standard error, and in task.online_change, that a change was refused: here, or before it came here.
  void tell_refused(const InputError& refused) const;

 private:
  struct Plan;

  ChangeReport carry_out(const Plan& begin, const ChangeWish& wish);
  [[nodiscard]] StepImage image();
  void plan(Plan& plan, const ChangeWish& wish) const;
  void rehearse(Plan& plan, const ChangeWish& wish) const;
  /// The mean time of its steps against the period.
  void require_room(const ChangeReport& report, bool by_wish) const;
  [[nodiscard]] ChangeVerdict propose(Plan& plan);
  /// Remembers parameters that were not carried over.
  void keep_as_given(const std::vector<std::string>& names);
  /// The registers with another version; nothing where none are served.
  [[nodiscard]] std::optional<NextMap> next_map(const ProgramVersion& version) const;
  /// Servers judge and show the version that runs now.
  void tell_door(std::optional<NextMap> registers);
  /// Tells of the version that runs now, once its values are on the disk.
  void tell_changed(ChangeReport& report, ChangeOutcome outcome);
  /// Begins a change; throws where it cannot be now.
  [[nodiscard]] std::unique_lock<std::mutex> one_at_a_time();
  template <class Ready>
  [[nodiscard]] bool wait_for(const Ready& ready) const;
  /// What was asked of the cyclic thread; false where that did not begin with it in time, and it is withdrawn.
  template <class Ready, class Withdraw>
  [[nodiscard]] bool wait_or_withdraw(const Ready& ready, const Withdraw& withdraw) const;
  /// `mend` where another than to see to the cause, and to ask again.
  [[noreturn]] void refuse_for_now(const std::string& why, const std::string& mend = "") const;

  ChangeableProgram* program_;
  Task* task_;
  std::vector<OutputLimit> limits_;
  double most_load_;
  Retainer* retainer_ = nullptr;
  const Trace* trace_ = nullptr;
  ServedMap* registers_ = nullptr;
  std::map<std::string, double> as_given_{};  ///< parameters that were taken so, as the running version then had them
  std::uint64_t retained_before_ = 0;         ///< how often the version to come was retained when it was proposed
  std::mutex under_way_{};
  std::atomic<bool> has_begun_{false};
  std::atomic<bool> has_ended_{false};
};

/// For a task with [online_change]; null without it, or where the program is none whose version may change: then a line
/// says that the table has no effect.
[[nodiscard]] std::unique_ptr<OnlineChange> online_change(const RunConfig& config, ChangeableProgram* program,
                                                          Task& task);

}  // namespace hysteron::runtime
