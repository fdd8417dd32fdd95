// The trace of a task as a file: what went into the program and what came out, cycle by cycle, and where it started.
//
//   hysteron trace 1
//   program PIEZO_FF
//   layout 9f3c…
//   period 1000000
//   state 120
//   input Y_REF um
//   output U V
//   parameter HYST.C1 um/V
//   data
//
// and then records in the byte order of x86 and ARM (little-endian): length (4 bytes, of what follows the kind), kind
// (1), contents. Kinds:
//   K  state: number of the next step (8), parameters, bytes of the state
//   P  parameters from the next step on
//   Z  a reset before the next step
//   R  a step: its number (8), its period (8), fault (4), inputs, outputs as computed, outputs as they left
//   E  the end: steps recorded (8), steps dropped for want of room (8)
// From a K on, the program gives the recorded outputs again, to the bit.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/task/safe_outputs.hpp"
#include "runtime/task/step_program.hpp"

namespace hysteron::runtime {

/// `program` stands in no file: it tells the writer the head of the next one.
enum class TraceKind : char { program = 'H', state = 'K', parameters = 'P', reset = 'Z', step = 'R', end = 'E' };

struct TraceColumn {
  std::string name{};
  std::string unit{};
};

struct TraceHead {
  std::string program{};
  std::string layout{};
  std::int64_t period = 0;
  std::size_t state_size = 0;
  std::vector<TraceColumn> inputs{};
  std::vector<TraceColumn> outputs{};
  std::vector<TraceColumn> parameters{};
};

struct TraceStep {
  std::uint64_t number = 0;
  std::uint64_t period = 0;
  Fault fault = Fault::none;
  std::vector<double> inputs{};
  std::vector<double> computed{};
  std::vector<double> outputs{};
};

/// What a trace begins with, and what ends its head: each is a line.
inline constexpr std::string_view trace_first_line = "hysteron trace 1";
inline constexpr std::string_view trace_last_line_of_head = "data";

/// Before the contents of a record: their length and its kind.
inline constexpr std::size_t record_head = 5;

/// The length of the contents of a step.
[[nodiscard]] constexpr std::size_t length_of_step(std::size_t inputs, std::size_t outputs) {
  return 20 + sizeof(double) * (inputs + 2 * outputs);
}

/// Whether a file that begins so is a trace, or what a power cut left of one: its begin, or zeros.
[[nodiscard]] bool is_begin_of_trace(std::string_view bytes);

[[nodiscard]] TraceHead head_of(const StepProgram& program);
[[nodiscard]] std::string text_of(const TraceHead& head);

/// The head of a trace alone; nothing where it has none.
[[nodiscard]] std::optional<TraceHead> trace_head(std::string_view bytes);

/// What a reader of a trace is told, in order. What it does not want it leaves out.
struct TraceVisitor {
  std::function<void(std::uint64_t next, std::span<const double> parameters, std::span<const std::byte> state)> state{};
  std::function<void(std::span<const double> parameters)> parameters{};
  std::function<void()> reset{};
  std::function<void(const TraceStep& step)> step{};
  std::function<void(std::uint64_t steps, std::uint64_t dropped)> end{};
};

/// Reads a trace. Empty, or what is wrong with it and at which byte. A trace that was cut off is read up to the cut.
[[nodiscard]] std::string read_trace(std::string_view bytes, TraceHead& head,
                                     const std::function<TraceVisitor(const TraceHead&)>& visit);

struct ReplayResult {
  std::uint64_t steps = 0;
  std::uint64_t different = 0;        ///< steps with an output of other bits
  std::uint64_t first_different = 0;  ///< its number
  std::uint64_t without_state = 0;    ///< steps that no state came before: they cannot be replayed
  std::uint64_t dropped = 0;
  bool complete = false;                 ///< the end was written
  std::vector<double> difference_rms{};  ///< by output: as recorded less as replayed
  std::vector<double> limited_rms{};     ///< by output: as it left less as computed; limits and safe values
};

/// Runs the program over the recorded inputs, and compares every output with the recorded one, bit by bit. Every
/// recorded step is handed on too. Empty, or what is wrong with the trace.
[[nodiscard]] std::string replay(std::string_view bytes, StepProgram& program, ReplayResult& result,
                                 const std::function<void(const TraceStep&)>& on_step = {});

}  // namespace hysteron::runtime
