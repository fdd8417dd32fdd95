// The guard: a process of its own that watches the task and holds the outputs safe when the task hangs or dies.
//
// It is forked before the task has threads. Between them is one page of shared memory: the task says there when a cycle
// begins and ends and what the outputs are; the guard answers with a word that it has taken over. From then on the
// task may not write to devices: it looks at that word before each write. A write that was under way is overwritten,
// since the guard writes in every one of its own cycles. A process that died is seen at once, by its file descriptor;
// one that hangs or is stopped, when its cycle is longer than the watchdog allows, or when no cycle began in time.
// Before the first cycle there is nothing to make safe: the guard of a task whose start fails ends quietly.
#pragma once

#include <sys/types.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "runtime/task/output_device.hpp"
#include "runtime/task/safe_outputs.hpp"
#include "runtime/task/watchdog.hpp"

namespace hysteron::runtime {

struct GuardSettings {
  WatchdogSettings watchdog{};
  std::int64_t period = 1'000'000;    ///< of the task, and of the guard's own cycles
  std::int64_t silence = 50'000'000;  ///< without a cycle for so long, the task counts as stopped
};

enum class GuardWord : std::uint32_t { starting, running, goodbye, taken };

/// The page between task and guard. Plain memory and lock-free words: it is valid in both processes.
struct GuardPage {
  static constexpr std::size_t most_outputs = 256;
  std::atomic<GuardWord> word{GuardWord::starting};
  std::atomic<Fault> fault{Fault::none};  ///< why the guard took over
  std::atomic<std::int64_t> began{0};     ///< when the newest cycle began
  std::atomic<std::int64_t> taken_at{0};  ///< when the guard took over
  std::atomic<std::int64_t> safe_at{0};   ///< when it had written the safe values for the first time
  std::atomic<bool> in_step{false};
  std::array<std::atomic<double>, most_outputs> outputs{};  ///< as last written
};
static_assert(std::atomic<double>::is_always_lock_free && std::atomic<std::int64_t>::is_always_lock_free);

/// What a heartbeat means at a time; none while all is well. A pure function, for the guard and its tests.
[[nodiscard]] Fault heartbeat_fault(const GuardSettings& settings, std::int64_t began, bool in_step,
                                    std::int64_t now) noexcept;

/// The task's side. Forks the guard; the device is opened in the guard by its own open().
class Guard {
 public:
  /// Throws std::system_error where the system gives no process or memory, std::invalid_argument for too many outputs.
  Guard(const GuardSettings& settings, const SafeOutputs& outputs, OutputDevice& device);
  /// Without a goodbye, what happens to a dead task happens; before the first cycle, the guard ends and writes nothing.
  ~Guard();
  Guard(const Guard&) = delete;
  Guard& operator=(const Guard&) = delete;

  void cycle_begins(std::int64_t now) noexcept {
    page_->began.store(now, std::memory_order_relaxed);
    page_->in_step.store(true, std::memory_order_release);
    if (page_->word.load(std::memory_order_relaxed) == GuardWord::starting) {
      GuardWord expected = GuardWord::starting;
      page_->word.compare_exchange_strong(expected, GuardWord::running);
    }
  }
  /// Tells the outputs as they are about to be written.
  void cycle_ends(std::span<const double> outputs) noexcept;
  /// Whether the task may still write.
  [[nodiscard]] bool may_write() const noexcept {
    return page_->word.load(std::memory_order_acquire) != GuardWord::taken;
  }
  /// The devices have taken the safe values from the task itself; the guard ends. False where it had taken over before.
  bool goodbye() noexcept;

  /// Whether its process lives on until devices have the safe values. Once the task is at its end.
  [[nodiscard]] bool holds_on() const noexcept {
    const GuardWord word = page_->word.load();
    const bool is_at_work = word == GuardWord::running || (word == GuardWord::taken && page_->safe_at.load() == 0);
    return is_at_work && !is_reaped_;
  }
  /// What ended the guard's process before its work was done, said once; empty else. Waits for nothing.
  [[nodiscard]] std::string death();

  [[nodiscard]] Fault fault() const noexcept { return page_->fault.load(); }
  [[nodiscard]] pid_t process() const noexcept { return process_; }

 private:
  GuardPage* page_ = nullptr;
  pid_t process_ = -1;
  bool is_reaped_ = false;
};

}  // namespace hysteron::runtime
