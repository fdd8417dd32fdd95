#include "tuning/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "codegen/graph/defaults.hpp"
#include "records/time/time_grid.hpp"
#include "records/time/time_unit.hpp"
#include "support/errors.hpp"
#include "support/numbers.hpp"
#include "support/option_words.hpp"
#include "support/rounded_text.hpp"
#include "tuning/interpreted_run.hpp"

namespace hysteron {
namespace {

/// Sample times that differ by less, relatively, are those of two clocks, not of two settings.
constexpr double clock_tolerance = 1e-6;

std::string number_of_values(std::size_t count) {
  return count == 1 ? "1 value" : fmt::format("{} values", count);
}

void check_values(const Port& input, const std::optional<bodies::WholeInput>& whole, const Signal& values,
                  const records::Record& record, Diagnostics& diagnostics) {
  std::size_t outside = 0;
  std::size_t first = 0;
  double most_beyond = 0.0;
  double farthest = 0.0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    const auto fault = input_fault(input, whole, values[k]);
    if (!fault.empty()) {
      diagnostics.error(error::unfit_value, record.place(input.name, k),
                        fmt::format("The column {} is {} at t = {} s, but the input {}.", input.name,
                                    number_text(values[k]), number_text(record.time()[k]), fault),
                        "correct the record, or declare the input as LREAL.");
      return;
    }
    const double beyond = std::max(input.minimum - values[k], values[k] - input.maximum);
    if (beyond > 0.0) {
      first = outside == 0 ? k : first;
      ++outside;
    }
    if (beyond > most_beyond) {
      most_beyond = beyond;
      farthest = values[k];
    }
  }
  if (outside > 0) {
    diagnostics.warning(
        error::input_out_of_range, record.place(input.name, first),
        fmt::format(
            "The column {} leaves the range of the input, {} to {}: {}, the first at t = {} s, the farthest {}.",
            input.name, number_text(input.minimum), number_text(input.maximum), number_of_values(outside),
            number_text(record.time()[first]), number_text(farthest)),
        "check the unit and the scale of the column, or widen @min and @max in the diagram.");
  }
}

/// As @ts takes it: 50us, 1ms, 1s.
std::string duration_text(double seconds) {
  const long long nanoseconds = std::llround(std::min(seconds * 1e9, 9e18));
  for (const auto& [unit, size] : {std::pair{"s", 1'000'000'000LL}, {"ms", 1'000'000LL}, {"us", 1'000LL}}) {
    if (nanoseconds % size == 0) {
      return fmt::format("{}{}", nanoseconds / size, unit);
    }
  }
  return fmt::format("{}ns", nanoseconds);
}

/// A record that is slower by just a thousand or a million was most likely not written in seconds.
std::string unit_advice(double ratio, const std::string& time) {
  const auto mistaken = time.empty() ? std::nullopt : records::mistaken_unit(ratio);
  return mistaken ? fmt::format("if its times are in {}, read it with --time {}. Else ", mistaken->words,
                                option_value(fmt::format("{}[{}]", time, mistaken->unit)))
                  : std::string();
}

/// Why a type of the graph cannot take a value; empty where it can.
std::string type_fault(Type type, double value) {
  switch (type) {
    case Type::Real:
      return {};
    case Type::Bool:
      return value == 0.0 || value == 1.0 ? "" : "takes 0 or 1";
    case Type::Int:
      return value == std::floor(value) && value >= std::numeric_limits<std::int32_t>::min() &&
                     value <= std::numeric_limits<std::int32_t>::max()
                 ? ""
                 : "takes whole numbers of 32 bits";
    case Type::Word:
      return value == std::floor(value) && value >= 0.0 && value <= std::numeric_limits<std::uint16_t>::max()
                 ? ""
                 : "takes whole numbers from 0 to 65535";
  }
  return {};
}

}  // namespace

std::string input_fault(const Port& input, const std::optional<bodies::WholeInput>& whole, double value) {
  return whole ? bodies::whole_fault(*whole, value) : type_fault(input.type, value);
}

Drive drive_from(const records::Record& record, const Program& program, std::vector<Signal> given,
                 Diagnostics& diagnostics) {
  const Graph& graph = program.graph;
  Drive drive{.inputs = std::move(given), .steps = record.size(), .sample_time = record.sample_time()};
  drive.inputs.resize(graph.inputs.size());
  const auto wholes = bodies::whole_inputs(graph);
  for (std::size_t i = 0; i < graph.inputs.size(); ++i) {
    const Port& input = graph.inputs[i];
    if (!drive.inputs[i].empty()) {
      continue;
    }
    if (const records::Column* const column = record.find(input.name)) {
      drive.inputs[i] = column->values;
      check_values(input, wholes[i], column->values, record, diagnostics);
      bodies::carry(wholes[i], drive.inputs[i]);
    } else if (has_default(graph, input)) {
      drive.inputs[i] = {input.preset};
    } else {
      try {
        (void)record.column(input.name);
      } catch (const InputError& missing) {
        Diagnostic diagnostic = missing.diagnostics().all().front();
        diagnostic.notes.push_back({.place = graph.place(input.span),
                                    .text = fmt::format("the input; {} := … would give it a default", input.name)});
        diagnostics.add(std::move(diagnostic));
      }
    }
  }
  return drive;
}

void settle_sample_time(const records::Record& record, Program& program, Diagnostics& diagnostics) {
  Graph& graph = program.graph;
  const double recorded = record.sample_time();
  if (graph.sample_time_ns == 0) {
    // A whole number of nanoseconds is what a diagram would state; of another one the interpreter is told.
    const double nanoseconds = recorded * 1e9;
    if (std::abs(nanoseconds - std::round(nanoseconds)) <= clock_tolerance * nanoseconds && nanoseconds < 1e18) {
      graph.sample_time_ns = std::llround(nanoseconds);
    }
    return;
  }
  const double stated = graph.sample_time();
  if (std::abs(recorded - stated) <= clock_tolerance * stated) {
    return;
  }
  records::PrintedResolution resolution;
  for (const double time : record.time()) {
    resolution.take(number_text(time));
  }
  const double last_decimal = resolution.quantum(0.0);
  if (records::deviations_from_grid(record.time(), stated).span() <= 1.25 * last_decimal + 0.02 * stated) {
    return;
  }
  diagnostics.error(
      error::sample_time_mismatch, record.place_of_time(1),
      fmt::format("The record has a sample time of {} s, {} one of {} s.", rounded_text(recorded), graph.name,
                  rounded_text(stated)),
      fmt::format("{}state @ts {} in the diagram, or bring the record to {} s: --resample linear, or hold "
                  "for encoders and commands.",
                  unit_advice(recorded / stated, record.time_name()), duration_text(recorded), rounded_text(stated)),
      {{.place = graph.place(graph.sample_time_span), .text = "the sample time of the diagram"}});
}

std::vector<Signal> interpret(const Program& program, const Drive& drive, const std::vector<Wire>& watched,
                              const std::function<void(double)>& progress) {
  return detail::interpreted_run<double>(program, drive, watched, progress);
}

std::vector<Wire> output_wires(const Graph& graph) {
  std::vector<Wire> wires;
  for (const Port& output : graph.outputs) {
    wires.push_back(output.wire);
  }
  return wires;
}

std::vector<Signal> simulate(Program program, const records::Record& record) {
  Diagnostics diagnostics;
  settle_sample_time(record, program, diagnostics);
  const Drive drive = drive_from(record, program, {}, diagnostics);
  if (diagnostics.has_errors()) {
    throw InputError(std::move(diagnostics));
  }
  return interpret(program, drive, output_wires(program.graph));
}

}  // namespace hysteron
