#include "tuning/record_options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <string_view>
#include <tuple>
#include <utility>

#include "codegen/graph/defaults.hpp"
#include "codegen/graph/port_t.hpp"
#include "codegen/graph/unit.hpp"
#include "records/read.hpp"
#include "records/resample.hpp"
#include "support/diagnostic.hpp"
#include "support/element_name.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"
#include "support/numbers.hpp"
#include "support/overwriting.hpp"
#include "support/trimmed.hpp"
#include "support/whole_number.hpp"
#include "tuning/record_units.hpp"

namespace hysteron {
namespace {

/// An option is `--rate`, a setting of a parameter file `rate`, at its place.
[[noreturn]] void refuse(const RecordOptions& options, std::string_view option, const std::string& given,
                         std::string mend) {
  for (const auto& key : {std::string(option), fmt::format("{} {}", option, given)}) {
    if (const auto found = options.places.find(key); found != options.places.end()) {
      throw InputError(error::bad_usage, found->second,
                       fmt::format("{} = \"{}\" in [record] cannot be read.", option, given), std::move(mend));
    }
  }
  throw InputError(error::bad_usage, {}, fmt::format("--{} {} cannot be read.", option, given), std::move(mend));
}

/// `2`, `2s`, `250 ms`, `1kHz` as a number in the unit wanted; a bare number is in it already.
std::optional<double> quantity(std::string_view text, std::string_view wanted) {
  text = trimmed(text);
  const auto end = text.find_first_not_of("+-0123456789.");
  std::size_t length = std::min(end, text.size());
  // An exponent is followed by digits, a unit is not.
  if (length + 1 < text.size() && (text[length] == 'e' || text[length] == 'E')) {
    const auto behind = text.find_first_not_of("+-0123456789", length + 1);
    if (behind != length + 1) {
      length = std::min(behind, text.size());
    }
  }
  const ParsedNumber number = parse_number(text.substr(0, length));
  if (number.status != NumberStatus::Finite) {
    return std::nullopt;
  }
  const std::string_view unit = trimmed(text.substr(length));
  if (unit.empty()) {
    return number.value;
  }
  std::string reason;
  const auto from = units::parse_unit(unit, reason);
  const auto to = units::parse_unit(wanted, reason);
  const auto factor = from && to ? units::conversion(*from, *to) : std::nullopt;
  return factor ? std::optional(number.value * *factor) : std::nullopt;
}

/// `a..b`, of which either may be missing.
std::pair<std::string_view, std::string_view> ends_of(const RecordOptions& options, std::string_view option,
                                                      const std::string& given, const std::string& mend) {
  const std::string_view text = given;
  const auto dots = text.find("..");
  if (dots == std::string_view::npos || text.size() == 2) {
    refuse(options, option, given, mend);
  }
  return {trimmed(text.substr(0, dots)), trimmed(text.substr(dots + 2))};
}

std::optional<std::size_t> whole(std::string_view text) {
  return whole_number<std::size_t>(text, 1);
}

/// NAME or NAME[unit].
std::pair<std::string, std::string> name_and_unit(std::string_view given) {
  const auto open = given.rfind('[');
  const bool element = element_of(given).has_value() && open > 0 && given[open - 1] != ' ';  // Y[2], and no unit
  if (!given.ends_with(']') || open == std::string_view::npos || open == 0 || element) {
    return {std::string(trimmed(given)), {}};
  }
  return {std::string(trimmed(given.substr(0, open))),
          std::string(trimmed(given.substr(open + 1, given.size() - open - 2)))};
}

void take_range(const RecordOptions& options, records::ReadOptions& result) {
  if (!options.range.empty()) {
    const std::string mend = "write the times of begin and end, such as --range 2s..8s; either may be left out.";
    const auto [begin, end] = ends_of(options, "range", options.range, mend);
    result.begin = quantity(begin, "s");
    result.end = quantity(end, "s");
    if ((!begin.empty() && !result.begin) || (!end.empty() && !result.end) ||
        (result.begin && result.end && !(*result.begin < *result.end))) {
      refuse(options, "range", options.range, mend);
    }
  }
  if (!options.rows.empty()) {
    const std::string mend =
        "write the first and the last row of numbers, such as --rows 1..60; either may be left out.";
    const auto [first, last] = ends_of(options, "rows", options.rows, mend);
    const auto from = whole(first);
    result.last_row = whole(last);
    if ((!first.empty() && !from) || (!last.empty() && !result.last_row) ||
        (from && result.last_row && *from >= *result.last_row)) {
      refuse(options, "rows", options.rows, mend);
    }
    result.first_row = from.value_or(1);
  }
}

/// The name before the equals sign: that of U=MAIN.u, of Q=hold; nothing of hold, which says it of all.
std::string_view name_before(std::string_view text) {
  const auto equals = text.find('=');
  return equals == std::string_view::npos ? std::string_view() : trimmed(text.substr(0, equals));
}

bool has_name(const std::vector<std::string>& texts, std::string_view name) {
  return std::ranges::any_of(texts,
                             [&](const std::string& one) { return equal_ignoring_case(name_before(one), name); });
}

/// What `--resample` says, of all signals or of one.
void take_resampling(const RecordOptions& options, bool is_general, records::ReadOptions& result) {
  for (const std::string& text : is_general ? options.general_resample : options.resample) {
    const auto equals = text.rfind('=');
    const bool of_one = equals != std::string::npos;
    const std::string name(trimmed(std::string_view(text).substr(0, of_one ? equals : 0)));
    const auto way = records::resampling_of(trimmed(std::string_view(text).substr(of_one ? equals + 1 : 0)));
    if (!way || (of_one && name.empty())) {
      refuse(options, "resample", text, "the ways are linear, hold and average; of one signal, --resample U=hold.");
    }
    if (of_one) {
      result.ways.push_back({.name = name, .way = *way, .is_general = is_general});
    } else if (result.resampling != records::Resampling::None && result.resampling != *way) {
      refuse(options, "resample", text,
             fmt::format("{} is stated as well: state one way for all, and others by name, as --resample U={}.",
                         records::name_of(result.resampling), text));
    } else {
      result.resampling = *way;
    }
  }
}

}  // namespace

RecordOptions with_settings(RecordOptions options, const parameters::RecordSettings& settings) {
  const auto texts = texts_of(options);
  for (const auto& [key, value] : settings.settings) {
    if (key == "resample") {
      if (!has_name(options.resample, name_before(value.text))) {
        options.general_resample.push_back(value.text);
        options.places.emplace("resample " + value.text, value.place);
      }
      continue;
    }
    const auto* const found = std::ranges::find_if(texts, [&key = key](const auto& text) { return text.first == key; });
    if (found != texts.end() && found->second->empty()) {
      *found->second = value.text;
      options.places.emplace(key, value.place);
    }
  }
  for (const auto& [name, value] : settings.columns) {
    if (!has_name(options.columns, name)) {
      options.general_columns.push_back(fmt::format("{}={}", name, value.text));
      options.places.emplace("column " + options.general_columns.back(), value.place);
    }
  }
  return options;
}

RecordOptions with_settings_of(const std::string& parameter_file, const RecordOptions& options) {
  return parameter_file.empty() ? options
                                : with_settings(options, parameters::read_parameter_file(parameter_file).record);
}

records::ReadOptions read_options(const RecordOptions& options, const Program* program) {
  records::ReadOptions result;
  if (!options.skip.empty()) {
    const auto lines = whole(options.skip);
    if (!lines) {
      refuse(options, "skip", options.skip,
             "write how many lines at the top are no part of the record, such as --skip 3.");
    }
    result.skip = *lines;
  }
  std::tie(result.time, result.time_unit) = name_and_unit(options.time);
  take_range(options, result);
  if (!options.rate.empty()) {
    result.rate = quantity(options.rate, "Hz");
    if (!result.rate) {
      const auto period = quantity(options.rate, "s");
      result.rate = period && *period > 0.0 ? std::optional(1.0 / *period) : std::nullopt;
    }
    if (!result.rate || !(*result.rate > 0.0)) {
      refuse(options, "rate", options.rate,
             "write how many rows a second has, such as --rate 1kHz, or the time of a row, 1ms.");
    }
  }
  for (const auto* const columns : {&options.columns, &options.general_columns}) {
    for (const std::string& one : *columns) {
      const auto equals = one.find('=');
      if (equals == std::string::npos || equals == 0 || equals + 1 == one.size()) {
        refuse(options, "column", one,
               "write the name in the diagram and that in the file, such as --column U=MAIN.u.");
      }
      auto [in_file, unit] = name_and_unit(std::string_view(one).substr(equals + 1));
      result.columns.push_back({.name = std::string(trimmed(std::string_view(one).substr(0, equals))),
                                .in_file = std::move(in_file),
                                .unit = std::move(unit),
                                .is_general = columns == &options.general_columns});
    }
  }
  if (!options.decimal.empty()) {
    if (!equal_ignoring_case(options.decimal, "point") && !equal_ignoring_case(options.decimal, "comma")) {
      refuse(options, "decimal", options.decimal, "write --decimal point or --decimal comma.");
    }
    result.decimal = equal_ignoring_case(options.decimal, "point") ? '.' : ',';
  }
  take_resampling(options, false, result);
  take_resampling(options, true, result);
  if (result.resamples() && program != nullptr) {
    if (program->graph.sample_time_ns > 0) {
      result.sample_time = program->graph.sample_time();
    }
    for (const auto* const ports : {&program->graph.inputs, &program->graph.outputs}) {
      for (const Port& port : *ports) {
        if (port.type != Type::Real) {
          result.stepping.push_back(port.name);
        }
      }
    }
  }
  if (const Port* const port = program != nullptr ? port_called_t(program->graph) : nullptr) {
    result.signal_t = records::SignalT{.unit = port->unit, .sample_time = program->graph.sample_time()};
  }
  return result;
}

records::ReadOptions drive_options(const RecordOptions& options, const Program& program) {
  records::ReadOptions result = read_options(options, &program);
  if (find_port(program.graph.inputs, "T") == nullptr) {
    result.signal_t.reset();
  }
  return result;
}

std::vector<std::string> what_was_read(const records::Record& record, const Program& program, bool tell_unused,
                                       std::string_view used) {
  std::vector<std::string> notes = record.notes();
  const Graph& graph = program.graph;
  for (const Port& input : graph.inputs) {
    if (has_default(graph, input) && record.find(input.name) == nullptr) {
      notes.push_back(
          fmt::format("input {} has no column, and keeps its default {}", input.name, number_text(input.preset)));
    }
  }
  std::vector<std::string> unused;
  for (const std::string& name : record.names()) {
    const auto same = [&](const Port& port) { return equal_ignoring_case(port.name, name); };
    if (std::ranges::none_of(graph.inputs, same) && std::ranges::none_of(graph.outputs, same) &&
        !equal_ignoring_case(name, used)) {
      unused.push_back(name);
    }
  }
  for (const records::Record::Unreadable& one : record.unreadable()) {
    unused.push_back(one.name);
  }
  if (tell_unused && !unused.empty()) {
    notes.push_back(fmt::format("columns not used: {}", fmt::join(unused, ", ")));
  }
  return notes;
}

std::vector<records::Record> read_measured_records(const std::vector<std::string>& logs, const RecordOptions& options,
                                                   const Program& program, Diagnostics& diagnostics) {
  for (std::size_t i = 0; i < logs.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if (same_file(logs[k], logs[i])) {
        throw InputError(error::bad_usage, {.file = logs[i]},
                         logs[k] == logs[i] ? fmt::format("--log names the record {} twice.", logs[i])
                                            : fmt::format("--log names one record as {} and as {}.", logs[k], logs[i]),
                         "give each record once: repeated, it would count as a second measurement.");
      }
    }
  }
  const records::ReadOptions reading = read_options(options, &program);
  std::vector<records::Record> records;
  records.reserve(logs.size());
  for (const std::string& log : logs) {
    records.push_back(records::read_record(log, reading));
    convert_units(records.back(), program, diagnostics);
  }
  if (diagnostics.has_errors()) {
    throw InputError(diagnostics);
  }
  return records;
}

}  // namespace hysteron
