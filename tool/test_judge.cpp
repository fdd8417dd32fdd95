#include "tool/test_judge.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "records/read.hpp"
#include "support/names.hpp"
#include "support/numbers.hpp"
#include "tool/compiled.hpp"
#include "tool/output_record.hpp"
#include "tool/test_plot.hpp"
#include "tuning/record_options.hpp"
#include "tuning/record_units.hpp"
#include "tuning/recorded_run.hpp"

namespace hysteron::tool {
namespace {

std::string text_of(Type type, double value) {
  return type == Type::Bool ? (value != 0.0 ? "TRUE" : "FALSE") : number_text(value);
}

/// |got − expected| ≤ abs + rel·|expected|; truth values and whole numbers are equal or not.
double allowed_error(const PlannedCase& planned, Type type, double expected) {
  return type == Type::Real ? planned.test.absolute + planned.test.relative * std::abs(expected) : 0.0;
}

std::optional<Failure> compare(const PlannedCase& planned, std::size_t output, const ValuesByStep& expected,
                               const Signal& got, std::string_view whose) {
  const Port& port = planned.program.graph.outputs[output];
  std::optional<std::size_t> first;
  std::size_t count = 0;
  for (const auto& [step, value] : expected) {
    const double error = std::abs(got[step] - value);
    if (!(error <= allowed_error(planned, port.type, value))) {
      first = first ? first : step;
      ++count;
    }
  }
  if (!first) {
    return std::nullopt;
  }
  const double wanted = expected.at(*first);
  std::string cause =
      fmt::format("{} at step {} (t = {} s): {} {}, got {}", port.name, *first, number_text(planned.time[*first]),
                  whose, text_of(port.type, wanted), text_of(port.type, got[*first]));
  if (port.type == Type::Real) {
    const auto [off, allowed] =
        distinct_texts(std::abs(got[*first] - wanted), allowed_error(planned, port.type, wanted), 3);
    cause += fmt::format(", off by {}, allowed {}", off, allowed);
  }
  cause += expected.size() == 1 ? "" : fmt::format("; {} of {} steps fail", count, expected.size());
  return Failure{.cause = std::move(cause), .plot = plot_of(*first, planned.time, expected, got)};
}

}  // namespace

std::vector<Failure> judge(const PlannedCase& planned, const std::vector<Signal>& outputs) {
  std::vector<Failure> failures;
  for (const ExpectedOutput& expected : planned.expected) {
    if (auto failure = compare(planned, expected.output, expected.values, outputs[expected.output], "expected")) {
      failures.push_back(std::move(*failure));
    }
  }
  std::vector<std::string> names;
  for (const Port& port : planned.program.graph.outputs) {
    names.push_back(port.name);
  }
  Diagnostics not_finite;
  check_finite({}, planned.time, names, outputs, not_finite);
  for (const Diagnostic& one : not_finite.all()) {
    failures.push_back({.cause = one.cause, .plot = {}});
  }
  return failures;
}

std::vector<Failure> judge_bits(const PlannedCase& planned, const std::vector<Signal>& interpreted,
                                const std::vector<Signal>& generated) {
  std::vector<Failure> failures;
  for (std::size_t i = 0; i < interpreted.size(); ++i) {
    const auto step = first_difference(interpreted[i], generated[i]);
    if (step == same_bits) {
      continue;
    }
    const Port& port = planned.program.graph.outputs[i];
    failures.push_back({.cause = fmt::format(
                            "{} at step {} (t = {} s): the interpreter gives {}, the generated C++ {}; their bits must "
                            "be equal",
                            port.name, step, number_text(planned.time[step]), text_of(port.type, interpreted[i][step]),
                            text_of(port.type, generated[i][step])),
                        .plot = {}});
  }
  return failures;
}

records::Record golden_record(const PlannedCase& planned) {
  // It holds outputs alone: a T among the inputs leaves a t no second reading.
  const bool has_t = find_port(planned.program.graph.outputs, "T") != nullptr;
  records::Record golden =
      records::read_record(planned.golden.string(), read_options({}, has_t ? &planned.program : nullptr));
  Diagnostics diagnostics;
  convert_units(golden, planned.program, diagnostics);
  if (diagnostics.has_errors()) {
    throw InputError(diagnostics);
  }
  return golden;
}

ValuesByStep golden_values(const records::Column& column) {
  ValuesByStep values;
  for (std::size_t k = 0; k < column.values.size(); ++k) {
    values.emplace_hint(values.end(), k, column.values[k]);
  }
  return values;
}

std::vector<Failure> judge_golden(const PlannedCase& planned, const std::vector<Signal>& outputs,
                                  std::vector<std::string>& notes) {
  const auto name = planned.golden.string();
  const auto failure = [](std::string cause) { return std::vector{Failure{.cause = std::move(cause), .plot = {}}}; };
  std::error_code unknown;
  if (!std::filesystem::exists(planned.golden, unknown)) {
    return failure(fmt::format("the golden record {} is missing; write it with --update, and look it over", name));
  }
  const records::Record golden = golden_record(planned);
  notes.insert(notes.end(), golden.notes().begin(), golden.notes().end());
  if (golden.size() != planned.drive.steps) {
    return failure(fmt::format("the golden record {} has {} rows, the case {} steps; write it anew with --update", name,
                               golden.size(), planned.drive.steps));
  }
  std::vector<Failure> failures;
  const auto& ports = planned.program.graph.outputs;
  for (std::size_t i = 0; i < ports.size(); ++i) {
    const records::Column* const column = golden.find(ports[i].name);
    if (column == nullptr) {
      failures.push_back({.cause = fmt::format("the golden record {} has no column {}; write it anew with --update",
                                               name, ports[i].name),
                          .plot = {}});
      continue;
    }
    if (auto one = compare(planned, i, golden_values(*column), outputs[i], "golden")) {
      failures.push_back(std::move(*one));
    }
  }
  for (const records::Column& column : golden.columns()) {
    const auto same = [&](const Port& port) { return equal_ignoring_case(port.name, column.name); };
    if (std::none_of(ports.begin(), ports.end(), same)) {
      failures.push_back(
          {.cause = fmt::format("the golden record {} has a column {}, the block has no such output; write "
                                "it anew with --update",
                                name, column.name),
           .plot = {}});
    }
  }
  return failures;
}

std::string golden_text(const PlannedCase& planned, const std::vector<Signal>& outputs) {
  std::vector<std::string> names;
  for (const Port& port : planned.program.graph.outputs) {
    names.push_back(port.name);
  }
  return output_csv(planned.program.graph, planned.time, names, outputs, planned.test.float32);
}

}  // namespace hysteron::tool
