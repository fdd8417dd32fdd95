#include "diagnosis/effects/signals.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "codegen/parameters/apply.hpp"
#include "diagnosis/effects/candidates.hpp"

namespace hysteron::diagnosis {
namespace {

std::vector<double> percentiles(std::vector<double> values) {
  std::vector<double> result(101, 0.0);
  std::erase_if(values, [](double value) { return !std::isfinite(value); });  // not a number has no order
  if (values.empty()) {
    return result;
  }
  std::ranges::sort(values);
  for (std::size_t k = 0; k <= 100; ++k) {
    result[k] = values[std::min(values.size() - 1, k * values.size() / 100)];
  }
  return result;
}

}  // namespace

Extent extent_of(const RecordSignals& values, double sample_time) {
  Extent extent{.low = std::numeric_limits<double>::infinity(), .high = -std::numeric_limits<double>::infinity()};
  std::vector<double> rates;
  std::vector<double> all;
  for (const Signal& record : values) {
    all.insert(all.end(), record.begin(), record.end());
    extent.first = record.empty() ? extent.first : std::max(extent.first, std::abs(record.front()));
    for (std::size_t k = 0; k < record.size(); ++k) {
      extent.low = std::min(extent.low, record[k]);
      extent.high = std::max(extent.high, record[k]);
      if (k > 0) {
        rates.push_back(std::abs(record[k] - record[k - 1]) / sample_time);
      }
    }
  }
  if (extent.low > extent.high) {
    return {};
  }
  extent.begin = values.front().empty() ? 0.0 : values.front().front();
  std::vector<double> levels = percentiles(std::move(all));
  extent.usual = levels[99] - levels[1];
  levels.erase(std::unique(levels.begin(), levels.end()), levels.end());
  extent.levels = levels.size();
  extent.rates = percentiles(std::move(rates));
  return extent;
}

std::vector<RecordSignals> wire_signals(const Task& task, const Program& program, const std::vector<Wire>& wires,
                                        const VectorXd& known) {
  Program driven = program;
  parameters::apply(task.file, driven.graph);
  for (std::size_t j = 0; j < task.known.size(); ++j) {
    set_parameter(driven.graph, task.known[j].path, known[static_cast<Index>(j)]);
  }
  std::vector<RecordSignals> result(wires.size());
  for (const records::Record& record : task.records) {
    Diagnostics diagnostics;
    Program here = driven;
    settle_sample_time(record, here, diagnostics);
    const Drive drive = drive_from(record, here, {}, diagnostics);
    if (diagnostics.has_errors()) {
      throw InputError(std::move(diagnostics));
    }
    std::vector<Signal> values = interpret(here, drive, wires);
    for (std::size_t i = 0; i < wires.size(); ++i) {
      result[i].push_back(std::move(values[i]));
    }
  }
  return result;
}

}  // namespace hysteron::diagnosis
