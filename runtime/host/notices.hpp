// Lines on standard error while a task runs: what went wrong beside the cycle, and that it is well again.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/config/run_config.hpp"
#include "runtime/task/fault_log.hpp"
#include "runtime/task/remarks.hpp"
#include "runtime/task/retain.hpp"
#include "runtime/task/task.hpp"
#include "runtime/task/trace.hpp"

namespace hysteron::runtime {

/// How much a line matters: a priority of the journal, where it goes there (syslog(3)).
enum class Weight : std::uint8_t {
  error = 3,    ///< outputs may be at their safe values
  warning = 4,  ///< something has to be seen to
  notice = 5,   ///< what was wrong is well again, or was asked for
};

/// Lines for standard error; where systemd takes them into its journal, each with its priority.
[[nodiscard]] std::string weighted(std::string_view lines, Weight weight);

/// Where standard error takes a line at once: nobody who reads it is waited for.
void tell(std::string_view from, const std::string& line, Weight weight = Weight::warning);

/// What could not be written, each once until it is well again.
class WriteNotices {
 public:
  /// Each may be null.
  WriteNotices(Retainer* retainer, Trace* trace) : retainer_(retainer), trace_(trace) {}

  /// To be called as time goes by.
  void look();
  /// What is to be told beside that, of files that somebody deleted.
  void tell_remarks();
  /// For the status line at the end, each beginning with a semicolon; empty where all is on the disk. After both are
  /// finished.
  [[nodiscard]] std::string at_the_end() const;

 private:
  Retainer* retainer_;
  Trace* trace_;
  bool told_retain_ = false;
  bool told_trace_ = false;
};

/// Of each kind of news a line is told this often at the most.
inline constexpr std::chrono::seconds pace_of_lines{1};

/// What was told last of something that changes, and when.
template <class Told>
class PacedNews {
 public:
  using Clock = std::chrono::steady_clock;

  /// Whether `newest` is to be told at this time; it counts as told then.
  [[nodiscard]] bool take(const Told& newest, Clock::time_point now) {
    if (newest == told_ || now < next_) {
      return false;
    }
    next_ = now + pace_of_lines;
    told_ = newest;
    return true;
  }

 private:
  Told told_{};
  Clock::time_point next_{};
};

/// The faults of the task, a line a second at the most: those that come and go faster are counted in the next.
class FaultNotices {
 public:
  using Clock = std::chrono::steady_clock;

  FaultNotices(const RunConfig& config, const ProgramShape& shape);

  /// What is to be said at this time; empty where nothing changed since it was last called, or the second is not over.
  [[nodiscard]] std::string line(const FaultReport& report, Clock::time_point now);
  /// The newest fault, and what it is of: lost link, Y on stage (127.0.0.1:502).
  [[nodiscard]] std::string last_of(const FaultReport& report) const;

 private:
  std::vector<std::string> ports_{};  ///< inputs, outputs
  PacedNews<FaultReport> news_{};
};

/// Devices that have never answered, and that the task goes on without: told once they have had some time, and told
/// again where one answers.
class AbsenceNotices {
 public:
  using Clock = std::chrono::steady_clock;

  explicit AbsenceNotices(Clock::time_point start) : start_(start) {}
  /// What is to be said; `absent`: as FieldIo::absent_devices gives them.
  [[nodiscard]] std::vector<std::string> lines(const std::vector<std::string>& absent, Clock::time_point now);

 private:
  Clock::time_point start_;
  std::vector<std::string> told_{};
};

/// A cyclic thread that computes for too much of the time, and periods that pass without a cycle: told where it begins,
/// and once ten stretches in a row were well.
class LoadNotices {
 public:
  /// `most`: the load above which it is too much.
  explicit LoadNotices(double most) : most_(most) {}
  /// What is to be said; empty where this stretch was seen before, or nothing changed.
  [[nodiscard]] std::string line(const LoadReport& report);
  /// Whether the last line said that something is wrong.
  [[nodiscard]] bool is_told() const { return told_; }

 private:
  double most_;
  std::uint64_t seen_ = 0;
  std::uint64_t well_ = 0;  ///< stretches in a row
  bool told_ = false;
};

/// Inputs that are forced: a line where that changed, one a second at the most.
class ForceNotices {
 public:
  using Clock = std::chrono::steady_clock;

  /// What is to be said; `forced`: as TaskDoor::forced gives them. Empty where nothing changed, or the last line is not
  /// as old as `pace_of_lines`.
  [[nodiscard]] std::string line(const std::vector<std::string>& forced, Clock::time_point now);

 private:
  PacedNews<std::vector<std::string>> news_{};
};

/// A line for each device that no input and no output of the task lies on.
void tell_of_unused_devices(const RunConfig& config);

/// What was retained and is not taken over, each with its reason; nothing where all is.
void tell_of_what_is_left(const std::vector<std::string>& left);

/// All that is said while a task runs.
class RunNotices {
 public:
  /// `beside`: what else has something to say, by the name that its lines begin with.
  RunNotices(const RunConfig& config, const ProgramShape& shape, Task& task, const TaskAttachments& attachments,
             std::map<std::string, Remarks*> beside);

  /// To be called as time goes by, from a thread that is not the task's.
  void look();
  /// Once, when all that writes is finished: what happened last, with what was not told yet because a line a second is
  /// told at the most.
  void last_look();
  /// For the status line at the end, each part beginning with a semicolon. Once all that writes is finished.
  [[nodiscard]] std::string at_the_end() const;
  [[nodiscard]] bool all_is_written() const { return not_written().empty(); }

 private:
  void look_at_forces(ForceNotices::Clock::time_point now);
  void look_beside();
  [[nodiscard]] std::string not_written() const;

  Task* task_;
  bool may_force_;
  const Guard* guard_;
  const FieldIo* field_;
  AbsenceNotices absences_{AbsenceNotices::Clock::now()};
  std::map<std::string, Remarks*> beside_;
  WriteNotices writes_;
  FaultNotices faults_;
  LoadNotices load_;
  ForceNotices forces_{};
  ForceNotices::Clock::time_point next_look_at_forces_{};
};

}  // namespace hysteron::runtime
