#include "records/time/time_candidates.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <string_view>

#include "records/time/time_grid.hpp"
#include "records/time/time_unit.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"
#include "support/option_words.hpp"
#include "support/rounded_text.hpp"
#include "support/time_heading.hpp"

namespace hysteron::records {
namespace {

/// t_u beside u, u_time beside u: the times of one signal. So are t1 and t2 where each has one signal behind it.
bool is_time_of_signal(const Table& table, std::size_t index) {
  return index + 1 < table.columns.size() && is_time_of(table.columns[index].name, table.columns[index + 1].name);
}

/// The first column in a unit of time, and each further one of the same name: the X [s] of a drive's oscilloscope.
bool is_time_by_unit(const Table& table, std::size_t index) {
  const TableColumn& column = table.columns[index];
  const TableColumn& first = table.columns.front();
  return column.is_named && time_unit(column.unit) && time_unit(first.unit) &&
         (index == 0 || equal_ignoring_case(column.name, first.name));
}

bool has_numbered_times(const Table& table) {
  const std::size_t count = table.columns.size();
  if (count < 4 || count % 2 != 0) {
    return false;
  }
  for (std::size_t i = 0; i < count; i += 2) {
    const std::string_view base = without_number(table.columns[i].name);
    if (!time_name(base) || !equal_ignoring_case(base, without_number(table.columns[0].name)) ||
        time_name(table.columns[i + 1].name)) {
      return false;
    }
  }
  return true;
}

std::vector<std::size_t> called_so(const Table& table) {
  std::vector<std::size_t> result;
  const bool numbered = has_numbered_times(table);
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    const TableColumn& column = table.columns[i];
    if (!column.has_values || column.is_part_of_time) {
      continue;
    }
    if ((numbered && i % 2 == 0) || is_clock_kind(column.kind) || (column.is_named && time_name(column.name)) ||
        is_time_of_signal(table, i) || is_time_by_unit(table, i)) {
      result.push_back(i);
    }
  }
  return result;
}

bool rises_evenly(const TableColumn& column) {
  return column.kind == CellKind::Number && rises(column) && !find_time_grid(column.values, column.resolution).fault;
}

/// Whether a column says that it is the time, by its name or its cells, so that a T beside it is something else.
bool says_time(const TableColumn& column) {
  return column.name.size() > 2 || is_clock_kind(column.kind);
}

/// One day in all rows says nothing of their times.
bool is_one_day(const TableColumn& column) {
  return column.kind == CellKind::Date &&
         std::ranges::all_of(column.stamps, [&](const Stamp& one) { return one.whole == column.stamps.front().whole; });
}

/// What is known of the diagram is nothing, or that no port of it is called T: beside a time a T is a temperature or a
/// torque, and so is one of another unit than a time's.
void leave_out_temperatures(const Table& table, const ReadOptions& options, std::vector<std::size_t>& found) {
  const auto is_there = [&](auto accepts) {
    return std::ranges::any_of(found, [&](std::size_t i) { return accepts(table.columns[i]); });
  };
  const bool any_unit = is_there([](const TableColumn& one) { return one.name == "time" && rises(one); }) ||
                        is_there([](const TableColumn& one) { return one.name == "t" && rises_evenly(one); });
  const bool any_time = any_unit || is_there(says_time);
  std::erase_if(found, [&](std::size_t i) {
    const TableColumn& column = table.columns[i];
    const bool is_no_time = options.rate && options.time.empty() && !rises(column);
    return column.name == "T" && (any_unit || is_no_time || (any_time && !time_unit(column.unit)));
  });
}

/// Of the columns called t, or T, where a port of the diagram is called so.
class ColumnsCalledT {
 public:
  ColumnsCalledT(const Table& table, const ReadOptions& options, std::vector<std::size_t>& found)
      : table_(table), options_(options), found_(found) {}

  void leave_out_signal() {
    const auto is_stated = [](const TableColumn& one) { return is_called_t(one.name) && !one.in_file.empty(); };
    const bool has_stated = std::ranges::any_of(table_.columns, is_stated);
    std::erase_if(found_, [&](std::size_t i) { return is_stated(table_.columns[i]); });
    if (has_stated) {  // what else is called so is not the signal
      leave_out_temperatures(table_, options_, found_);
      return;
    }
    std::erase_if(found_, [&](std::size_t i) { return is_signal(i); });
    std::vector<std::size_t> both;  // what could be the time and the signal
    std::ranges::copy_if(found_, std::back_inserter(both),
                         [&](std::size_t i) { return is_called_t(table_.columns[i].name) && !is_time(i); });
    const auto is_both = [&](std::size_t i) { return std::ranges::find(both, i) != both.end(); };
    const bool has_time = std::ranges::any_of(found_, [&](std::size_t i) {
      const TableColumn& column = table_.columns[i];
      return !is_both(i) && !is_one_day(column) && (is_time(i) || says_time(column) || rises(column));
    });
    const bool is_counted = options_.rate && options_.time.empty();
    if (both.size() == 2 && table_.columns[both[0]].name != table_.columns[both[1]].name && !has_time) {
      const bool in_order = table_.columns[both[0]].name == "t";
      const std::size_t small = both[in_order ? 0 : 1];
      const std::size_t big = both[in_order ? 1 : 0];
      const bool is_only_one = rises(table_.columns[small]) && !rises(table_.columns[big]);
      if (is_only_one || rises_evenly(table_.columns[small])) {
        std::erase(found_, big);
        return;
      }
    }
    if (both.size() == 1 && !has_time && !is_counted && rises(table_.columns[both.front()])) {
      refuse_one(both.front());
    }
    if (both.size() > 1 && !has_time && !is_counted) {
      refuse_several(both);
    }
    std::erase_if(found_, is_both);
  }

 private:
  /// In a unit that no time has.
  [[nodiscard]] bool is_signal(std::size_t i) const {
    const TableColumn& column = table_.columns[i];
    return is_called_t(column.name) && !is_clock_kind(column.kind) && !column.unit.empty() && !time_unit(column.unit) &&
           !is_zone_of_time(column.unit);
  }

  /// Whatever the signal is called: dates, a unit that the signal does not have, what a format calls its times, and
  /// several columns t, which are the times of several signals.
  [[nodiscard]] bool is_time(std::size_t i) const {
    const TableColumn& column = table_.columns[i];
    const bool has_other_unit =
        time_unit(column.unit) && !options_.signal_t->unit.empty() && !time_unit(options_.signal_t->unit);
    const auto is_small = [&](std::size_t k) { return table_.columns[k].name == "t"; };
    return is_clock_kind(column.kind) || column.is_time || has_other_unit ||
           (is_small(i) && std::ranges::count_if(found_, is_small) > 1);
  }

  [[noreturn]] void refuse_one(std::size_t index) const {
    const std::string& name = table_.columns[index].name;
    const std::vector<std::size_t> rising = rising_columns(table_);
    const auto other = std::ranges::find_if(rising, [&](std::size_t i) { return i != index; });
    const std::string rate = table_.stated                          ? rounded_text(1.0 / table_.stated->period) + "Hz"
                             : options_.signal_t->sample_time > 0.0 ? rounded_text(options_.signal_t->sample_time) + "s"
                                                                    : std::string("1kHz");
    throw InputError(
        error::two_readings, table_.place,
        fmt::format("Column {} could be the time, or the signal T of the diagram; the columns are {}.", name,
                    fmt::join(records::names_of(table_), ", ")),
        fmt::format("if it is the time, call it time in the file, or say --time {}; if it is the signal, {}state how "
                    "often there is a row: --rate {}.",
                    option_value(name),
                    other == rising.end() ? ""
                                          : fmt::format("name the time, as --time {}, or ",
                                                        option_value(table_.columns[*other].name + "[s]")),
                    rate));
  }

  [[noreturn]] void refuse_several(const std::vector<std::size_t>& both) const {
    const std::vector<std::string> names = names_of(table_, both);
    const bool by_name = names[0] != names[1];
    const auto said = [&](std::size_t k) { return by_name ? names[k] : std::to_string(both[k] + 1); };
    throw InputError(
        error::two_readings, table_.place,
        fmt::format("Each of the columns {} could be the time, or the signal T of the diagram{}; the columns are {}.",
                    fmt::join(names, " and "),
                    std::ranges::find(names, "t") == names.end() ? "" : ": t does not rise evenly, as a time does",
                    fmt::join(records::names_of(table_), ", ")),
        fmt::format("call the time `time` in the file, or say which it is: --time {} or --time {}.",
                    option_value(said(0)), option_value(said(1))));
  }

  const Table& table_;
  const ReadOptions& options_;
  std::vector<std::size_t>& found_;
};

}  // namespace

std::vector<std::size_t> time_candidates(const Table& table, const ReadOptions& options) {
  std::vector<std::size_t> found = called_so(table);
  if (options.signal_t) {
    ColumnsCalledT(table, options, found).leave_out_signal();
  } else {
    leave_out_temperatures(table, options, found);
  }
  // Where none says time: the first, if it rises and its name is a unit below the second, or ends so: ms, tick_us.
  const TableColumn& first = table.columns.front();
  const auto unit = unit_in_name(first.name);
  if (found.empty() && first.has_values && first.is_named && first.kind == CellKind::Number && !first.fault && unit &&
      unit->under > 1 && rises(first)) {
    found.push_back(0);
  }
  return found;
}

bool is_clock_kind(CellKind kind) {
  return kind == CellKind::DateTime || kind == CellKind::Date || kind == CellKind::Clock;
}

std::size_t own_rows(const TableColumn& column, std::size_t rows) {
  const std::size_t missing = column.missing.size();
  return column.is_gappy && missing > 0 && column.missing.front() == rows - missing ? rows - missing : rows;
}

bool rises(const TableColumn& column) {
  const std::size_t rows = own_rows(column, column.stamps.size());
  if (rows < 2 || (column.fault && rows == column.stamps.size())) {
    return false;
  }
  const bool may_rest = column.kind == CellKind::Date || column.kind == CellKind::Clock;
  for (std::size_t k = 1; k < rows; ++k) {
    const Stamp& before = column.stamps[k - 1];
    const Stamp& now = column.stamps[k];
    const double step = static_cast<double>(now.whole - before.whole) + (now.fraction - before.fraction);
    if (!(may_rest ? step >= 0.0 || step < -43200.0 : step > 0.0)) {
      return false;
    }
  }
  return true;
}

std::vector<std::size_t> rising_columns(const Table& table) {
  std::vector<std::size_t> rising;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    const std::vector<double>& values = table.columns[i].values;
    const bool rising_values = std::ranges::adjacent_find(values, std::greater_equal{}) == values.end();
    if (table.columns[i].kind == CellKind::Number && !table.columns[i].fault && rising_values) {
      rising.push_back(i);
    }
  }
  return rising;
}

std::vector<std::string> names_of(const Table& table, const std::vector<std::size_t>& columns) {
  std::vector<std::string> names;
  names.reserve(columns.size());
  for (const std::size_t i : columns) {
    names.push_back(table.columns[i].name);
  }
  return names;
}

}  // namespace hysteron::records
