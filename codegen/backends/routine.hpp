// A routine: the whole step of a program as expressions and assignments, in order, before any target's spelling.
//
// Each block's trace is laid into one tape, in the order of the schedule. What a target has to do is to print it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "codegen/compile.hpp"
#include "codegen/trace/tape.hpp"

namespace hysteron {

/// A variable that lives from step to step.
struct CellInfo {
  std::string instance{};  ///< path of the block; empty for the step counter
  Field field{};
  std::uint32_t node = 0;
  bool held = false;  ///< the last output of a slower part
};

struct Statement {
  enum class Kind : std::uint8_t {
    Section,    ///< what follows belongs to a node
    Define,     ///< const name = value
    SetCell,    ///< cell target := value
    StoreCell,  ///< cell target[index] := value; every element where index is no_value
    SetOutput,  ///< output target := value
    BeginRate,  ///< what follows runs in the steps of a rate
    EndRate
  };
  Kind kind = Kind::Define;
  std::uint32_t target = 0;  ///< cell, output or node
  ValueId value = no_value;
  ValueId index = no_value;
  Rate rate{};
  std::string name{};  ///< of a definition: INV.XOUT, SUM.LOST next; to be made an identifier by the target
};

/// Leaves of the tape: Op::Input, Op::Parameter and Op::Cell by their index; Op::SampleTime with the divisor as index.
struct Routine {
  Tape tape{};
  std::vector<CellInfo> cells{};
  std::vector<Statement> reset{};
  std::vector<Statement> step{};
  std::uint32_t longest_period = 1;  ///< least common multiple of the rates; above 1, cell `counter` counts steps
  std::uint32_t counter = 0;
  std::size_t operations = 0;      ///< arithmetic operations a step
  std::size_t function_calls = 0;  ///< of them exp, log, power, …
};

Routine make_routine(const Program& program);

/// The place of each value in a routine's text: values used once are written where they are used.
std::vector<std::uint32_t> count_uses(const Tape& tape, const std::vector<Statement>& statements);

}  // namespace hysteron
