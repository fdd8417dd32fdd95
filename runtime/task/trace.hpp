// The trace of a running task: every cycle goes into a ring, from there a thread of its own writes it to a file.
//
// Without a trigger everything is written. With one, so many steps before it, the step itself and so many after it; the
// recording begins at a kept state, so that it can be replayed. What the ring has no room for is counted, exactly, and
// the next state makes what follows replayable again. Where the file takes no more, the trace ends with its last whole
// record, and every step from there on is counted as dropped.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "runtime/task/byte_ring.hpp"
#include "runtime/task/trace_file.hpp"
#include "runtime/task/trace_output.hpp"

namespace hysteron::runtime {

/// Fires at the first step where the signal crosses the level: is beyond it, and was not in the step before.
struct TraceTrigger {
  enum class Signal : std::uint8_t { input, output, fault };
  Signal signal = Signal::fault;
  std::size_t index = 0;  ///< of the input or output
  bool above = true;      ///< or below
  double level = 0.0;
  std::uint64_t before = 1000;  ///< steps
  std::uint64_t after = 1000;
};

struct TraceSettings {
  std::filesystem::path file{};
  std::size_t ring_bytes = std::size_t{4} << 20;
  std::optional<TraceTrigger> trigger{};
  bool waits = false;  ///< for room in the ring: on the virtual clock, where nothing is late and nothing need be lost
};

/// Chooses which records of a stream are written. Pure: bytes in, bytes out.
class TraceSelector {
 public:
  TraceSelector(const TraceHead& head, std::optional<TraceTrigger> trigger);
  /// Whole records, in order. What is to be written is appended.
  void feed(std::span<const std::byte> records, std::string& out);
  [[nodiscard]] bool finished() const { return finished_; }
  [[nodiscard]] std::uint64_t steps_written() const { return steps_; }

 private:
  void feed_one(TraceKind kind, std::string_view record, std::string& out);
  [[nodiscard]] bool fires(std::string_view contents);

  /// Records from a state up to the next.
  struct Segment {
    std::string bytes{};
    std::uint64_t steps = 0;
  };
  std::size_t inputs_;
  std::size_t outputs_;
  std::optional<TraceTrigger> trigger_;
  std::deque<Segment> kept_{};
  bool fired_ = false;
  bool was_beyond_ = true;  ///< a signal that begins beyond the level has not crossed it
  bool finished_ = false;
  std::uint64_t left_ = 0;
  std::uint64_t steps_ = 0;
};

class Trace {
 public:
  /// Throws std::system_error where the file cannot be opened or its head not be written, as TraceOutput does.
  Trace(const TraceSettings& settings, const StepProgram& program);
  ~Trace() { finish(); }
  Trace(const Trace&) = delete;
  Trace& operator=(const Trace&) = delete;

  // From the cyclic thread. Before the step:
  void before_step(std::uint64_t number, const StepProgram& program) noexcept;
  void parameters_changed(std::span<const double> parameters) noexcept;
  void was_reset() noexcept;
  // After the step:
  void step(std::uint64_t number, std::uint64_t period, Fault fault, std::span<const double> inputs,
            std::span<const double> computed, std::span<const double> outputs) noexcept;

  [[nodiscard]] std::uint64_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }
  /// Whether it was cut short: something could not be written, and nothing was from there on.
  [[nodiscard]] bool is_cut() const noexcept { return cut_.load(std::memory_order_acquire); }
  /// Why; once it is cut.
  [[nodiscard]] const std::string& problem() const noexcept { return problem_; }
  /// Writes what is left, and the end. No step comes after it.
  void finish();

 private:
  bool push(TraceKind kind, std::span<const std::span<const std::byte>> contents) noexcept;
  void write_out(bool last);
  void write_records(std::string_view records, std::uint64_t steps);

  ByteRing ring_;
  TraceSelector selector_;
  TraceOutput file_;
  std::vector<double> parameters_;
  std::vector<std::byte> state_;
  std::uint64_t state_every_;
  std::uint64_t since_state_ = 0;
  bool needs_state_ = true;
  bool waits_;
  std::atomic<std::uint64_t> dropped_{0};
  std::uint64_t kept_ = 0;  ///< steps in the file; of the writer, as the next two
  std::string problem_{};
  std::atomic<bool> cut_{false};
  std::atomic<bool> stop_{false};
  std::thread writer_;
};

}  // namespace hysteron::runtime
