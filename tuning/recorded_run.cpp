#include "tuning/recorded_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "support/element_name.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"
#include "support/numbers.hpp"
#include "support/time_heading.hpp"
#include "tuning/float32_run.hpp"
#include "tuning/record_units.hpp"
#include "tuning/signal_names.hpp"

namespace hysteron {
void check_finite(const std::vector<Place>& places, std::span<const double> time, const std::vector<std::string>& names,
                  const std::vector<Signal>& columns, Diagnostics& diagnostics) {
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const auto finite = [](double value) { return std::isfinite(value); };
    const auto first = std::find_if_not(columns[i].begin(), columns[i].end(), finite);
    if (first == columns[i].end()) {
      continue;
    }
    const auto step = static_cast<std::size_t>(first - columns[i].begin());
    const auto count =
        columns[i].size() - static_cast<std::size_t>(std::count_if(first, columns[i].end(), finite)) - step;
    diagnostics.error(
        error::output_not_finite, places.empty() ? Place{} : places[i],
        fmt::format("{} is {} at step {} (t = {} s){}.", names[i], std::isnan(*first) ? "not a number" : "infinite",
                    step, number_text(time[step]), count > 1 ? fmt::format(", and in {} steps in all", count) : ""),
        "look for a division by 0, a root or logarithm of a negative number, or a sum that grows without bound; "
        "--trace shows the signals inside.");
  }
}

Drive drive_of(Program& program, records::Record& record, Diagnostics& diagnostics) {
  convert_units(record, program, diagnostics);
  settle_sample_time(record, program, diagnostics);
  return drive_from(record, program, {}, diagnostics);
}

RecordedRun run_over(Program program, records::Record& record, const RunRequest& request, Diagnostics& diagnostics) {
  RecordedRun result;
  result.drive = drive_of(program, record, diagnostics);
  const Graph& graph = program.graph;
  std::vector<Place> places;
  for (const Port& output : graph.outputs) {
    result.names.push_back(output.name);
    result.units.push_back(output.unit);
    places.push_back(graph.place(output.span));
  }
  std::vector<Wire> watched = output_wires(graph);
  for (const std::string& path : request.traces) {
    for (const NamedSignal& one : find_signals(graph, path, {.file = graph.source->path})) {
      watched.push_back(one.wire);
      places.push_back({.file = graph.source->path});
      // A variable T would stand in a second column t, or beside a port T.
      result.names.push_back(in_capitals(is_called_t(one.name) ? graph.name + "." + one.name : one.name));
      result.units.emplace_back();
    }
  }
  if (diagnostics.has_errors()) {
    throw InputError(diagnostics);
  }
  result.values = interpret(program, result.drive, watched, request.float32, request.progress);
  check_finite(places, record.time(), result.names, result.values, diagnostics);
  result.program = std::move(program);
  return result;
}

}  // namespace hysteron
