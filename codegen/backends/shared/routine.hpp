// A routine: the whole step of a program as expressions and assignments, in order, before any target's spelling.
//
// Each block's trace is laid into one tape, in the order of the schedule. What a target has to do is to print it.
#pragma once

#include <bitset>
#include <cstdint>
#include <string_view>
#include <vector>

#include "codegen/compile.hpp"
#include "codegen/trace/tape.hpp"

namespace hysteron {

/// A variable that lives from step to step.
struct CellInfo {
  std::string_view instance{};  ///< path of the block, in the program's graph; empty for the step counter
  Field field{};
  std::uint32_t node = 0;
  bool held = false;        ///< the last output of a slower part
  std::uint32_t place = 0;  ///< of the field among the block's states; of a held one among the node's outputs
};

struct Statement {
  enum class Kind : std::uint8_t {
    Section,    ///< what follows belongs to a node
    Define,     ///< const name = value
    SetCell,    ///< cell target := value
    StoreCell,  ///< cell target[index] := value; every element where index is no_value
    SetOutput,  ///< output target := value
    BeginRate,  ///< what follows runs in the steps of a rate
    EndRate,
    Call  ///< of a node that stays a block; only in a routine of calls
  };
  Kind kind = Kind::Define;
  bool always = false;               ///< Define: named also where it is used but once
  std::uint32_t target = 0;          ///< cell, output or node; Define: the node whose value it is
  std::uint32_t first_argument = 0;  ///< Call: in Routine::arguments
  std::uint32_t argument_count = 0;
  ValueId value = no_value;
  ValueId index = no_value;
  Rate rate{};
  std::string_view field{};  ///< Define: the output or state of the node that the value is; empty for an operation's
  std::string_view what{};   ///< Define: the next value of a state, or the place in an array
};

/// A set of operations and leaves.
using Operations = std::bitset<static_cast<std::size_t>(Op::At) + 1>;

/// A value that a call hands to a pin of a block: its inputs, and its parameters behind them.
struct CallArgument {
  std::uint32_t pin = 0;
  ValueId value = no_value;
};

/// Leaves of the tape: Op::Input, Op::Parameter and Op::Cell by their index; Op::SampleTime with the divisor as index.
struct Routine {
  Tape tape{};
  std::vector<CellInfo> cells{};
  std::vector<Statement> reset{};
  std::vector<Statement> step{};
  std::vector<CallArgument> arguments{};  ///< of calls
  std::uint32_t longest_period = 1;       ///< least common multiple of the rates; above 1, cell `counter` counts steps
  std::uint32_t counter = 0;
  std::vector<std::uint32_t> uses{};  ///< by value of the tape: in how many values and statements it stands
  Operations used_by_reset{};
  Operations used_by_step{};
  bool infinite_literals = false;  ///< infinite, or not a number
  bool reads_by_index = false;     ///< an element of an array is read at a place that is computed
  std::size_t operations = 0;      ///< arithmetic operations a step
  std::size_t function_calls = 0;  ///< of them exp, log, power, …

  [[nodiscard]] bool uses_operation(Op op) const {
    return (used_by_reset | used_by_step).test(static_cast<std::size_t>(op));
  }
};

struct RoutineOptions {
  /// By output of the diagram: it is that of the memory as it has been moved on, the value of the next step, for
  /// whoever reads it before the next call. Only for an output of a block that depends on memory alone; missing ones
  /// are FALSE.
  std::vector<bool> outputs_ahead{};
};

Routine make_routine(const Program& program, const RoutineOptions& options = {});

/// Counts what is used how often, and drops what nobody needs. Values from `first_of_step` on belong to the step.
void finish_routine(Routine& routine, ValueId first_of_step);

/// The cell that counts steps, where there are several rates.
void add_counter(Routine& routine);

/// The leaf of a literal of a type.
Op literal_op(Type type);

/// Whether a parameter begins with a value that is infinite or not a number.
bool has_infinite_parameter(const Graph& graph);

}  // namespace hysteron
