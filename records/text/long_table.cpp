#include "records/text/long_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <utility>

#include "records/time/time_unit.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"

namespace hysteron::records {
namespace {

/// Of WinCC, InfluxDB, Wonderware, Kepware, Grafana, Home Assistant and pandas.
constexpr auto names_of_signals =
    std::to_array<std::string_view>({"VarName", "_field", "TagName", "tag", "variable", "signal", "_NAME", "name",
                                     "series", "entity_id", "metric", "channel", "topic"});
constexpr auto names_of_values = std::to_array<std::string_view>({"VarValue", "_value", "value", "vValue", "state"});

template <class Predicate>
std::optional<std::size_t> column_where(const Table& table, const Predicate& is_it) {
  const auto found = std::ranges::find_if(table.columns, is_it);
  return found == table.columns.end() ? std::nullopt
                                      : std::optional(static_cast<std::size_t>(found - table.columns.begin()));
}

/// The time of a row: the finest there is. WinCC's Time_ms is a date in millionths of a day, in spite of its name.
std::optional<std::size_t> time_of(Table& table) {
  const auto in_days =
      column_where(table, [](const TableColumn& one) { return equal_ignoring_case(one.name, "Time_ms"); });
  if (in_days && table.columns[*in_days].kind == CellKind::Number) {
    table.columns[*in_days].unit = "1e-6 d";
    return in_days;
  }
  // A range that was asked for, _start and _stop of InfluxDB, stands in each row.
  const auto stands = [](const TableColumn& one) {
    return one.stamps.size() > 1 && one.stamps.front().whole == one.stamps.back().whole &&
           one.stamps.front().fraction == one.stamps.back().fraction;
  };
  const auto is_time = [](const TableColumn& one) {
    return one.kind == CellKind::DateTime || (one.kind == CellKind::Number && time_name(one.name));
  };
  const auto moving = column_where(table, [&](const TableColumn& one) { return is_time(one) && !stands(one); });
  return moving ? moving : column_where(table, is_time);
}

}  // namespace

bool names_signals(std::string_view column) {
  return is_one_of(column, names_of_signals);
}

Table widened(Table table) {
  const auto names =
      column_where(table, [](const TableColumn& one) { return names_signals(one.name) && !one.words.empty(); });
  const auto values = column_where(table, [](const TableColumn& one) {
    return is_one_of(one.name, names_of_values) && one.kind == CellKind::Number;
  });
  const auto time = names && values ? time_of(table) : std::nullopt;
  // A column "name" may name the measurement, one for all rows.
  const bool names_many = names && (table.columns[*names].dictionary.size() > 1 ||
                                    !equal_ignoring_case(table.columns[*names].name, "name"));
  if (!time || !names_many || table.columns[*time].stamps.size() != table.rows) {
    return table;
  }
  const TableColumn& of_names = table.columns[*names];
  const TableColumn& of_values = table.columns[*values];
  TableColumn of_time = table.columns[*time];
  Table result{.place = table.place, .notes = std::move(table.notes)};
  std::vector<TableColumn> signals(of_names.dictionary.size());
  for (std::size_t s = 0; s < signals.size(); ++s) {
    signals[s].name = of_names.dictionary[s];
    signals[s].is_gappy = true;
    signals[s].has_values = true;
    signals[s].place = of_names.place;
  }
  const std::vector<Stamp> stamps = std::move(of_time.stamps);
  const std::vector<double> numbers = std::move(of_time.values);
  of_time.stamps.clear();
  of_time.values.clear();
  // Each signal may stand in a block of its own: the rows are taken in the order of their times.
  const auto earlier = [&](const Stamp& a, const Stamp& b) {
    return a.whole != b.whole ? a.whole < b.whole : a.fraction < b.fraction;
  };
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < table.rows; ++row) {
    if (!of_names.dictionary[of_names.words[row]].starts_with("$RT_")) {  // WinCC: the archive was switched on or off
      rows.push_back(row);
    }
  }
  std::ranges::stable_sort(rows, [&](std::size_t a, std::size_t b) { return earlier(stamps[a], stamps[b]); });
  std::vector<std::vector<bool>> has(signals.size());
  for (const std::size_t row : rows) {
    const Stamp& now = stamps[row];
    const std::size_t signal = of_names.words[row];
    const bool same = !of_time.stamps.empty() && !earlier(of_time.stamps.back(), now) && !has[signal].back();
    if (!same) {
      of_time.stamps.push_back(now);
      if (of_time.kind == CellKind::Number) {
        of_time.values.push_back(numbers[row]);
      }
      for (std::size_t s = 0; s < signals.size(); ++s) {
        signals[s].values.push_back(0.0);
        has[s].push_back(false);
      }
    }
    signals[signal].values.back() = of_values.values[row];
    has[signal].back() = !std::ranges::binary_search(of_values.missing, row);
  }
  result.rows = of_time.stamps.size();
  for (std::size_t s = 0; s < signals.size(); ++s) {
    for (std::size_t row = 0; row < result.rows; ++row) {
      if (!has[s][row]) {
        signals[s].missing.push_back(row);
      }
    }
    if (of_values.fault && of_values.missing.empty()) {
      signals[s].fault = of_values.fault;
    } else if (!signals[s].missing.empty()) {
      signals[s].fault = Diagnostic{.number = error::text_for_number,
                                    .place = of_names.place,
                                    .cause = fmt::format("{} has no value at {} of the {} times.", signals[s].name,
                                                         signals[s].missing.size(), result.rows),
                                    .mend = "bring it to all times: --resample hold, or linear."};
    }
  }
  result.columns.push_back(std::move(of_time));
  for (TableColumn& signal : signals) {
    if (!signal.name.starts_with("$RT_")) {
      result.columns.push_back(std::move(signal));
    }
  }
  result.notes.push_back(fmt::format("each row holds one value: {} names the signals", of_names.name));
  return result;
}

}  // namespace hysteron::records
