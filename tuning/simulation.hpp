// Signals over the steps of a run: inputs taken from a record, outputs computed by the interpreter.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "codegen/compile.hpp"
#include "codegen/graph/body/whole_inputs.hpp"
#include "records/record.hpp"
#include "support/diagnostic.hpp"

namespace hysteron {

/// One value for each step, or one for all of them.
using Signal = std::vector<double>;

[[nodiscard]] inline double at_step(const Signal& signal, std::size_t step) {
  return signal[signal.size() == 1 ? 0 : step];
}

/// What a run is driven by.
struct Drive {
  std::vector<Signal> inputs{};  ///< by input of the diagram
  std::size_t steps = 0;
  double sample_time = 0.0;  ///< in seconds; of use where the diagram states none
};

/// The columns of a record as inputs, by name without regard to case; an input without a column keeps its default.
/// Reports HY502 for an input with neither, HY707 for a value that its type cannot take, and, as a warning, HY705
/// for values outside of its range. `given`, by input, are signals that stand for columns; empty ones do not.
[[nodiscard]] Drive drive_from(const records::Record& record, const Program& program, std::vector<Signal> given,
                               Diagnostics& diagnostics);

/// Why an input cannot take a value, as `takes 0 or 1`; empty where it can. `whole`: the type that a sequential body
/// declares, where that is narrower.
[[nodiscard]] std::string input_fault(const Port& input, const std::optional<bodies::WholeInput>& whole, double value);

/// Holds the sample time of a record against that of a diagram, allowing for what printing took from the times.
/// Where the diagram states none, it takes the record's. Reports HY704.
void settle_sample_time(const records::Record& record, Program& program, Diagnostics& diagnostics);

/// Runs a program by the interpreter, in LREAL; the values of the wires watched, each over all steps.
[[nodiscard]] std::vector<Signal> interpret(const Program& program, const Drive& drive,
                                            const std::vector<Wire>& watched,
                                            const std::function<void(double)>& progress = {});

/// The wires of a diagram's outputs.
[[nodiscard]] std::vector<Wire> output_wires(const Graph& graph);

/// Runs a program over a record from its reset: the outputs, each over all steps. Throws InputError where the record
/// does not fit, as reported by the functions above; values that leave the range of an input are taken as they are.
[[nodiscard]] std::vector<Signal> simulate(Program program, const records::Record& record);

}  // namespace hysteron
