// The memory that the tool and the worker process of an FMU share: who has the turn, what is to be done, the values.
//
// All values are doubles, whatever the type of the variable: a double holds every value of every type that is taken.
// A lane is an instance of the FMU; lane 0 is the FMU itself, the others run beside it for derivatives.
#pragma once

#include <linux/futex.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <ctime>

namespace hysteron::cosimulation {

enum class Turn : std::uint32_t { Caller, Worker };

enum class Command : std::uint32_t {
  Begin,  ///< new instances with the given parameters and inputs, initialised; gives the outputs at time 0
  Step    ///< the given inputs, one communication step of all instances; gives the outputs behind it
};

/// How a variable is accessed: by which functions of FMI.
enum class Access : std::uint32_t { Float64, Float32, Int8, UInt8, Int16, UInt16, Int32, Int64, Boolean };
inline constexpr std::size_t access_count = 9;

struct ChannelVariable {
  std::uint32_t reference = 0;
  Access access = Access::Float64;
  bool goes_on = false;  ///< the next element of the array that the variable before belongs to
};

inline constexpr std::size_t longest_path = 4096;

/// The front of the shared memory. The caller fills it once, before the worker starts; then each side writes where it
/// has the turn.
struct ChannelHead {
  std::atomic<std::uint32_t> turn{static_cast<std::uint32_t>(Turn::Caller)};
  Command command = Command::Begin;
  std::uint32_t version = 2;  ///< of FMI
  std::uint32_t lanes = 1;    ///< in use; memory is there for all of them
  std::uint32_t most_lanes = 1;
  std::uint32_t inputs = 0;
  std::uint32_t parameters = 0;
  std::uint32_t outputs = 0;
  std::uint32_t refused = 0;  ///< 1: the FMU, or the system, refused; `message` says what
  double step = 0.0;          ///< communication step in seconds
  char library[longest_path] = {};
  char resources[longest_path] = {};
  char token[longest_path] = {};
  char message[longest_path] = {};  ///< what was refused
  char log[longest_path] = {};      ///< the last messages of the FMU, one a line, since the command was given
};
static_assert(std::atomic<std::uint32_t>::is_always_lock_free);

/// Where what stands in the memory.
class ChannelView {
 public:
  ChannelView() = default;
  explicit ChannelView(void* memory) : memory_(static_cast<std::byte*>(memory)) {}

  [[nodiscard]] static std::size_t size(std::size_t variables, std::size_t lanes) {
    return first_variable() + variables * (sizeof(ChannelVariable) + lanes * sizeof(double));
  }
  [[nodiscard]] ChannelHead& head() const { return *reinterpret_cast<ChannelHead*>(memory_); }
  /// Inputs, then parameters, then outputs.
  [[nodiscard]] ChannelVariable* variables() const {
    return reinterpret_cast<ChannelVariable*>(memory_ + first_variable());
  }
  [[nodiscard]] double* values(std::size_t lane) const {
    return reinterpret_cast<double*>(memory_ + first_variable() + count() * sizeof(ChannelVariable)) + lane * count();
  }
  [[nodiscard]] double* inputs(std::size_t lane) const { return values(lane); }
  [[nodiscard]] double* parameters(std::size_t lane) const { return values(lane) + head().inputs; }
  [[nodiscard]] double* outputs(std::size_t lane) const { return parameters(lane) + head().parameters; }

 private:
  static constexpr std::size_t first_variable() { return (sizeof(ChannelHead) + 63) / 64 * 64; }
  [[nodiscard]] std::size_t count() const { return head().inputs + head().parameters + head().outputs; }
  std::byte* memory_ = nullptr;
};

/// How long a side looks again and again before it goes to sleep. Waking another core takes about as long as it looks
/// at most; where processors are scarce, the one that looks keeps the other from working, and so it learns to look for
/// less.
class Patience {
 public:
  /// With one processor there is nothing to look for.
  explicit Patience(bool several_processors) : microseconds_(several_processors ? most : 0) {}
  [[nodiscard]] std::chrono::microseconds time() const { return std::chrono::microseconds(microseconds_); }
  void learn(std::chrono::nanoseconds waited) {
    const bool worth_it = waited <= std::chrono::microseconds(most);
    microseconds_ = static_cast<std::uint8_t>(microseconds_ <= 1 && !worth_it ? microseconds_
                                              : !worth_it                     ? microseconds_ / 2
                                              : microseconds_ < most          ? microseconds_ * 2
                                                                              : most);
  }

 private:
  static constexpr std::uint8_t most = 32;
  std::uint8_t microseconds_;
};

/// Waits until the turn is no longer `other`, `most` at longest. Says whether it came.
inline bool wait_for_turn(const std::atomic<std::uint32_t>& turn, Turn other, std::chrono::nanoseconds most,
                          Patience& patience) {
  const auto waits_for = static_cast<std::uint32_t>(other);
  const auto is_free = [&] { return turn.load(std::memory_order_acquire) != waits_for; };
  if (is_free()) {
    return true;
  }
  const auto begun = std::chrono::steady_clock::now();
  while (!is_free() && std::chrono::steady_clock::now() - begun < patience.time()) {
    for (int i = 0; i < 16 && !is_free(); ++i) {
#if defined(__x86_64__)
      __builtin_ia32_pause();
#endif
    }
  }
  if (!is_free()) {
    const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(most);
    const timespec timeout{.tv_sec = static_cast<std::time_t>(seconds.count()),
                           .tv_nsec = static_cast<long>((most - seconds).count())};
    syscall(SYS_futex, &turn, FUTEX_WAIT, waits_for, &timeout, nullptr, 0);
  }
  patience.learn(std::chrono::steady_clock::now() - begun);
  return is_free();
}

/// Gives the turn to the other side.
inline void give_turn(std::atomic<std::uint32_t>& turn, Turn to) {
  turn.store(static_cast<std::uint32_t>(to), std::memory_order_release);
  syscall(SYS_futex, &turn, FUTEX_WAKE, 1, nullptr, nullptr, 0);
}

/// Where the worker finds the memory, and the pipe whose end tells that the tool is gone.
inline constexpr int memory_descriptor = 3;
inline constexpr int lifeline_descriptor = 4;

}  // namespace hysteron::cosimulation
