// The trace of a running task: every cycle goes into a ring, from there a thread of its own writes it to a file.
//
// Without a trigger everything is written. With one, so many steps before it, the step itself and so many after it; the
// recording begins at a kept state, so that it can be replayed. Armed again, it waits for the next state; each capture
// begins another file. What the ring has no room for is counted, exactly, and
// the next state makes what follows replayable again. Where the file takes no more, the trace ends with its last whole
// record, and every step from there on is counted as dropped; now and then another file is tried, and begun where it
// can be. A state comes at least for each eighth of a file, so that a file keeps its size however far its writer is
// behind. A file that has grown to its size is followed by another, which begins at a state, so that each can be
// replayed by itself; the oldest goes. So is one that somebody has moved, and one that somebody has deleted: what was
// in that is told, and counted as dropped.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "runtime/task/byte_ring.hpp"
#include "runtime/task/remarks.hpp"
#include "runtime/task/trace_file.hpp"
#include "runtime/task/trace_output.hpp"

namespace hysteron::runtime {

/// Fires at the first step where the signal crosses the level: is beyond it, and was not in the step before. Before the
/// first step there is no fault, and the signal is unknown: beyond the level from the start, it has to come back first.
struct TraceTrigger {
  enum class Signal : std::uint8_t { input, output, fault };
  Signal signal = Signal::fault;
  std::size_t index = 0;  ///< of the input or output
  bool above = true;      ///< or below
  double level = 0.0;
  std::uint64_t before = 1000;  ///< steps
  std::uint64_t after = 1000;
  std::uint64_t captures = 1;  ///< it fires so often at the most: it is armed again once a capture is whole
};

/// The memory that steps before the trigger take at most: they are kept from state to state, so up to twice as many.
[[nodiscard]] std::uint64_t memory_before(const TraceTrigger& trigger, std::size_t inputs, std::size_t outputs);

struct TraceSettings {
  std::filesystem::path file{};
  std::size_t ring_bytes = std::size_t{4} << 20;
  std::optional<TraceTrigger> trigger{};
  std::uint64_t file_bytes = 128'000'000;  ///< from which size on another file is begun
  std::size_t files = 8;                   ///< that are there at most, the newest among them
  bool waits = false;  ///< for room in the ring: on the virtual clock, where nothing is late and nothing need be lost
};

/// Chooses which records of a stream are written. Pure: bytes in, bytes out.
class TraceSelector {
 public:
  TraceSelector(const TraceHead& head, std::optional<TraceTrigger> trigger);
  /// Whole records, in order. What is to be written is appended.
  void feed(std::span<const std::byte> records, std::string& out);
  [[nodiscard]] bool finished() const { return finished_; }
  /// Whether it waits for the trigger, and writes nothing until that fires.
  [[nodiscard]] bool waits() const { return trigger_ && !fired_; }

 private:
  void feed_one(TraceKind kind, std::string_view record, std::string& out);
  void keep(TraceKind kind, std::string_view record);
  /// The trigger has fired with the newest kept step.
  void begin_capture(std::string& out);
  void end_capture();
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
  bool was_beyond_;  ///< a signal that begins beyond the level has not crossed it; a fault at the start has begun
  bool finished_ = false;
  std::uint64_t left_ = 0;
  std::uint64_t captures_ = 0;    ///< that were begun
  std::string program_record_{};  ///< of the program that is recorded: before it, another file begins
};

/// What a trace needs for a program: its head, and room for parameters and state.
struct TraceProgram {
  explicit TraceProgram(const StepProgram& program);
  std::string head;
  std::vector<double> parameters;
  std::vector<std::byte> state;
};

class Trace {
 public:
  /// Throws std::system_error where no trace can ever be at that name, as TraceOutput does. Where it cannot be begun
  /// for another reason, it is cut from the begin.
  Trace(const TraceSettings& settings, const StepProgram& program);
  ~Trace() { finish(); }
  Trace(const Trace&) = delete;
  Trace& operator=(const Trace&) = delete;

  // From the cyclic thread. Before the step:
  void before_step(std::uint64_t number, const StepProgram& program) noexcept;
  void parameters_changed(const StepProgram& program) noexcept;
  void was_reset() noexcept;
  /// The next step begins with another state than the one before ended with.
  void was_restored() noexcept { needs_state_ = true; }
  // After the step:
  /// That step, which step() tells next, was of another program, and began with these bytes as its state. It begins
  /// another file. What stood in `next` is exchanged for what is no longer needed.
  void program_changed(std::uint64_t number, const StepProgram& program, std::span<const std::byte> state,
                       TraceProgram& next) noexcept;
  void step(std::uint64_t number, std::uint64_t period, Fault fault, std::span<const double> inputs,
            std::span<const double> computed, std::span<const double> outputs) noexcept;

  [[nodiscard]] std::uint64_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }
  /// Whether it is cut short: something could not be written, and nothing has been from there on.
  [[nodiscard]] bool is_cut() const noexcept { return cut_.load(std::memory_order_acquire); }
  /// Why it was last cut; empty where it never was.
  [[nodiscard]] std::string problem() const;
  /// What somebody can do who reads of it, as way_out() says it.
  [[nodiscard]] std::string mend() const;
  /// What is to be told of the file beside that, as that somebody deleted it.
  [[nodiscard]] Remarks& remarks() noexcept { return remarks_; }
  /// Whether the next step begins another file.
  [[nodiscard]] bool wants_next() const noexcept { return wants_state_.load(std::memory_order_relaxed); }
  /// Writes what is left, and the end. No step comes after it.
  void finish();

 private:
  bool push(TraceKind kind, std::span<const std::span<const std::byte>> contents) noexcept;
  void push_state(std::uint64_t number, const StepProgram& program) noexcept;
  void begin_first();
  void write_out(bool last);
  void write_records(std::string_view records);
  /// Records up to the next state, or from one up to the next.
  void write_part(std::string_view records);
  [[nodiscard]] bool needs_next() const;
  bool begin_next();
  /// The steps of a file that somebody deleted, counted as dropped.
  std::uint64_t lose_deleted();
  void write_end();
  void cut(std::uint64_t lost, const std::string& problem);

  TraceProgram program_;  ///< of the cyclic thread
  std::string head_;      ///< of the writer
  ByteRing ring_;
  TraceSelector selector_;
  TraceOutput file_;
  std::uint64_t state_every_;
  std::uint64_t since_state_ = 0;
  bool needs_state_ = true;
  bool needs_head_ = false;
  bool waits_;
  std::atomic<std::uint64_t> dropped_{0};
  std::uint64_t file_bytes_;
  std::uint64_t segment_bytes_;       ///< from a state up to the next, at the most
  std::uint64_t kept_ = 0;            ///< steps in the file; of the writer, as the next
  bool is_other_ = false;             ///< what follows is of another program than the file
  std::uint64_t dropped_before_ = 0;  ///< when the file was begun
  std::chrono::steady_clock::time_point next_try_{};
  std::atomic<bool> wants_state_{false};  ///< the next file begins at one
  mutable std::mutex mutex_;              ///< never taken by the cyclic thread
  std::string problem_{};
  int reason_ = 0;
  Remarks remarks_{};
  std::atomic<bool> cut_{false};
  std::atomic<bool> stop_{false};
  std::thread writer_;
};

}  // namespace hysteron::runtime
