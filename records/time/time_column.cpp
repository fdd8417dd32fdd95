#include "records/time/time_column.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <optional>
#include <string_view>
#include <utility>

#include "records/time/counter.hpp"
#include "records/time/no_time.hpp"
#include "records/time/packed_clock.hpp"
#include "records/time/time_candidates.hpp"
#include "records/time/time_unit.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"
#include "support/numbers.hpp"
#include "support/option_words.hpp"
#include "support/rounded_text.hpp"
#include "support/time_heading.hpp"

namespace hysteron::records {
namespace {

constexpr std::int64_t seconds_a_day = 86400;
/// Beyond it a number of seconds, or of any unit, is no time since the record began but a date.
constexpr double longest_record = 1e8;

double raw_value(const Stamp& stamp) {
  return static_cast<double>(stamp.whole) + stamp.fraction;
}

bool same_times(const TableColumn& a, const TableColumn& b) {
  return a.kind == b.kind && a.unit == b.unit &&
         std::ranges::equal(a.stamps, b.stamps, [](const Stamp& x, const Stamp& y) {
           return x.whole == y.whole && x.fraction == y.fraction;
         });
}

/// The date and the time of day that make one time.
std::optional<std::pair<std::size_t, std::size_t>> date_and_clock(const Table& table,
                                                                  const std::vector<std::size_t>& found) {
  std::optional<std::size_t> date;
  std::optional<std::size_t> clock;
  for (const std::size_t i : found) {
    if (table.columns[i].kind == CellKind::Date && !date) {
      date = i;
    } else if (table.columns[i].kind == CellKind::Clock && !clock) {
      clock = i;
    }
  }
  return date && clock ? std::optional(std::pair(*date, *clock)) : std::nullopt;
}

/// The unit of a column of numbers: what is stated, what the header says, what the size of the numbers says, seconds.
struct FoundUnit {
  TimeUnit unit{"s", 1, 1};
  bool is_epoch = false;
};
FoundUnit unit_of(const TableColumn& column, const ReadOptions& options) {
  FoundUnit result;
  if (is_clock_kind(column.kind)) {
    return result;
  }
  const std::optional<TimeName> name = time_name(column.name);
  const std::string stated = !options.time_unit.empty()     ? options.time_unit
                             : is_zone_of_time(column.unit) ? std::string()
                                                            : column.unit;
  const std::optional<TimeUnit> epoch = column.stamps.empty() ? std::nullopt : epoch_unit(column.stamps.front().whole);
  if (!stated.empty()) {
    const auto unit = time_unit(stated);
    if (!unit) {
      throw InputError(error::time_unit, column.place,
                       fmt::format("The time is given in {}, which is no unit of time.", stated),
                       fmt::format("state it, as --time {}; s, ms, us, ns, min, h and d are known.",
                                   option_value(column.name + "[UNIT]")));
    }
    result.unit = *unit;
  } else if (name && name->unit) {
    result.unit = *name->unit;
  } else if (epoch) {
    result.unit = *epoch;
  } else if (const auto unit = name ? std::nullopt : unit_in_name(column.name)) {  // --time tick_ms
    result.unit = *unit;
  }
  result.is_epoch = epoch.has_value() && epoch->name == result.unit.name;
  return result;
}

std::string date_text(std::int64_t seconds) {
  const std::chrono::sys_seconds at{std::chrono::seconds(seconds)};
  const auto day = std::chrono::floor<std::chrono::days>(at);
  const std::chrono::year_month_day date(day);
  const std::chrono::hh_mm_ss time(at - day);
  return fmt::format("{:04}-{:02}-{:02} {:02}:{:02}:{:02}", static_cast<int>(date.year()),
                     static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()), time.hours().count(),
                     time.minutes().count(), time.seconds().count());
}

/// The times of a column in its own unit. Numbers that count from the record's begin are those that were printed, to
/// the bit; dates, and numbers that count from elsewhere, count from the first row.
std::vector<double> raw_times(const TableColumn& column, const std::vector<Stamp>& stamps, bool is_date,
                              bool is_epoch) {
  const bool is_clock = is_clock_kind(column.kind);
  const Stamp first = stamps.front();
  if (auto wrapped = column.kind == CellKind::Number && !is_epoch ? unwrapped(column.values) : std::nullopt) {
    return std::move(*wrapped);
  }
  if (!is_clock && !is_epoch && std::abs(raw_value(first)) <= longest_record) {
    return column.values;
  }
  std::vector<double> result;
  result.reserve(stamps.size());
  std::int64_t days = 0;
  for (std::size_t k = 0; k < stamps.size(); ++k) {
    // Midnight: a time of day without a date begins anew.
    if (is_clock && !is_date && k > 0 && stamps[k].whole < stamps[k - 1].whole - seconds_a_day / 2) {
      ++days;
    }
    result.push_back(static_cast<double>(stamps[k].whole + seconds_a_day * days - first.whole) +
                     (stamps[k].fraction - first.fraction));
  }
  return result;
}

/// Numbers of Excel and MATLAB that count days look like seconds: 46176.4166 and a step of 1.157e-5. They are told by
/// their size, from 2000 to 2099, and by a step that is a plain number of seconds only where it counts days.
void refuse_days_without_unit(const TableColumn& column, const ReadOptions& options) {
  const std::optional<TimeName> name = time_name(column.name);
  const bool has_unit = !column.unit.empty() && !is_zone_of_time(column.unit);
  if (column.kind != CellKind::Number || has_unit || !options.time_unit.empty() || (name && name->unit)) {
    return;
  }
  const double first = column.values.front();
  const bool of_excel = first >= 36526.0 && first < 73051.0;
  const bool of_matlab = first >= 730486.0 && first < 767011.0;
  const double step = (column.values.back() - first) / static_cast<double>(column.values.size() - 1);
  const auto is_plain = [](double number) {
    const double scale = std::pow(10.0, 2.0 - std::floor(std::log10(number)));
    return std::abs(std::round(number * scale) / (number * scale) - 1.0) < 2e-4;
  };
  if ((of_excel || of_matlab) && step > 0.0 && step < 0.5 && is_plain(86400.0 * step) && !is_plain(step)) {
    throw InputError(error::two_readings, column.place,
                     fmt::format("The times from {} on could be seconds, or days as {} counts them.",
                                 number_text(first), of_excel ? "Excel" : "MATLAB"),
                     fmt::format("say which: --time {} or --time {}.", option_value(column.name + "[d]"),
                                 option_value(column.name + "[s]")));
  }
}

/// The times of one column, or of a date and a time of day.
struct Found {
  std::vector<double> seconds{};
  TimeGrid grid{};
  std::string note{};
};
Found times_of_column(const Table& table, std::size_t index, std::optional<std::size_t> date,
                      const ReadOptions& options) {
  const TableColumn& column = table.columns[index];
  for (const std::size_t i : {index, date.value_or(index)}) {
    if (table.columns[i].fault) {
      Diagnostics list;
      list.add(*table.columns[i].fault);
      throw InputError(list);
    }
    if (table.columns[i].ambiguity && table.columns[i].kind == CellKind::Clock && !date) {
      throw InputError(
          error::two_readings, table.columns[i].place,
          fmt::format("{} could be hours and minutes, or minutes and seconds.", *table.columns[i].ambiguity),
          "write the seconds too, as 00:00:58, or count the rows by --rate.");
    }
    const bool one_day = table.columns[i].kind == CellKind::Date &&
                         std::ranges::all_of(table.columns[i].stamps, [&](const Stamp& stamp) {
                           return stamp.whole == table.columns[i].stamps.front().whole;
                         });
    if (table.columns[i].ambiguity && table.columns[i].kind != CellKind::Clock && !one_day &&
        table.columns[i].stamps.front().whole / seconds_a_day != table.columns[i].stamps.back().whole / seconds_a_day) {
      throw InputError(error::two_readings, table.columns[i].place,
                       fmt::format("{} could be a day of two months, and the record goes over midnight.",
                                   *table.columns[i].ambiguity),
                       "write dates as 2024-06-03, or cut the record at midnight with --rows.");
    }
  }
  if (!is_clock_kind(column.kind) && column.kind != CellKind::Number) {
    throw InputError(error::text_for_number, column.place, fmt::format("Column {} holds no times.", column.name),
                     "name another column with --time, or state the rate with --rate.");
  }
  const FoundUnit unit = unit_of(column, options);
  refuse_days_without_unit(column, options);
  std::vector<Stamp> stamps = column.stamps;
  if (date) {
    for (std::size_t k = 0; k < stamps.size(); ++k) {
      stamps[k].whole += table.columns[*date].stamps[k].whole;
    }
  }
  const std::vector<double> raw = raw_times(column, stamps, date || column.kind == CellKind::DateTime, unit.is_epoch);
  Found result;
  result.seconds = raw;
  for (double& value : result.seconds) {
    value = unit.unit.seconds(value);
  }
  // Of decimal units the grid is found as they were printed; a minute is no round number of them.
  const bool decimal = unit.unit.over == 1;
  PrintedResolution resolution = column.resolution;
  if (!decimal) {
    resolution.scale(unit.unit.seconds(1.0));
  }
  result.grid = find_time_grid(decimal ? raw : result.seconds, resolution);
  auto clock = result.grid.fault && column.kind == CellKind::Number ? unpacked_clock(raw) : std::nullopt;
  if (clock) {
    result.seconds = std::move(*clock);
    result.grid = find_time_grid(result.seconds, resolution);
    result.note = ", whose numbers are times of day";
    return result;
  }
  if (decimal) {
    result.grid.sample_time = unit.unit.seconds(result.grid.sample_time);
  }
  if (decimal && result.grid.fault) {
    result.grid.fault->step = unit.unit.seconds(result.grid.fault->step);
    result.grid.fault->usual = unit.unit.seconds(result.grid.fault->usual);
    result.grid.fault->off = unit.unit.seconds(result.grid.fault->off);
  }
  if (unit.is_epoch || date || column.kind == CellKind::DateTime) {
    const double since = unit.is_epoch ? unit.unit.seconds(raw_value(stamps.front())) : raw_value(stamps.front());
    constexpr double from_1601_to_1970 = 11'644'473'600.0;
    const double begin = unit.unit.name == "100 ns" ? since - from_1601_to_1970 : since;
    result.note = fmt::format(", from {} on", date_text(static_cast<std::int64_t>(std::floor(begin))));
  }
  if (column.kind == CellKind::Number && raw.back() > column.values.back() - column.values.front() + 32768.0) {
    result.note += ", whose counter begins anew";
  }
  if (unit.unit.name != "s") {
    result.note = fmt::format(", in {}{}", unit.unit.name, result.note);
  }
  return result;
}

/// The times of a signal that has its own, as many as it has rows.
std::vector<double> own_times(const Table& table, std::size_t index, const ReadOptions& options) {
  const std::size_t rows = own_rows(table.columns[index], table.rows);
  if (rows == table.rows || rows < 2) {
    return times_of_column(table, index, std::nullopt, options).seconds;
  }
  Table shorter{.columns = {table.columns[index]}, .rows = rows, .place = table.place};
  TableColumn& column = shorter.columns.front();
  column.values.resize(std::min(column.values.size(), rows));
  column.stamps.resize(std::min(column.stamps.size(), rows));
  column.missing.clear();
  column.fault.reset();
  return times_of_column(shorter, 0, std::nullopt, options).seconds;
}

}  // namespace

Times times_of(const Table& table, const ReadOptions& options) {
  Times result;
  if (options.rate && options.time.empty()) {
    const double sample_time = 1.0 / *options.rate;
    result.grid.sample_time = sample_time;
    for (std::size_t k = 0; k < table.rows; ++k) {
      result.seconds.push_back(static_cast<double>(k) / *options.rate);
    }
    if (const auto left = time_candidates(table, options); !left.empty()) {
      result.notes.push_back(
          fmt::format("the time is counted by --rate; not used: {}", fmt::join(names_of(table, left), ", ")));
      result.used = left;
    }
    return result;
  }
  std::vector<std::size_t> found;
  std::optional<std::size_t> date;
  if (!options.time.empty()) {
    const std::vector<std::size_t> stated = columns_called(table, options.time);
    if (stated.empty()) {
      throw InputError(
          error::missing_column, table.place,
          fmt::format("There is no column {}; the columns are {}.", options.time, fmt::join(names_of(table), ", ")),
          "name one of these with --time, or give its number from 1 on.");
    }
    found = {stated.front()};
  } else {
    found = time_candidates(table, options);
    if (const auto pair = date_and_clock(table, found)) {
      date = pair->first;
      std::erase(found, *date);
      result.used.push_back(*date);
      std::erase_if(found, [&](std::size_t i) { return i != pair->second; });
    }
    if (found.size() > 1 && std::ranges::any_of(found, [&](std::size_t i) { return rises(table.columns[i]); })) {
      std::erase_if(found, [&](std::size_t i) { return !rises(table.columns[i]); });
    }
  }
  if (found.empty() && table.stated && table.stated->differs) {
    throw InputError(
        error::two_readings, table.place,
        fmt::format("Above the rows stands \"{}\": the signals have rates of their own.", table.stated->words),
        "write each signal with its time (X_Columns Multi in LabVIEW), or each into a file of its own.");
  }
  if (found.empty() && table.stated && table.stated->is_of_rows) {
    result.grid.sample_time = table.stated->period;
    for (std::size_t k = 0; k < table.rows; ++k) {
      result.seconds.push_back(table.stated->begin + static_cast<double>(k) * table.stated->period);
    }
    result.notes.push_back(fmt::format("the time is counted in steps of {} s, by \"{}\" above the rows",
                                       number_text(table.stated->period), table.stated->words));
    return result;
  }
  if (found.empty()) {
    refuse_without_time(table);
  }
  // Of several: what repeats the first is the same time; a t in seconds is the time of this house, and beside a
  // signal T the time; else each may be the time of the signal behind it.
  if (found.size() > 1) {
    std::vector<std::size_t> others;
    for (const std::size_t i : found) {
      if (i == found.front() || same_times(table.columns[i], table.columns[found.front()])) {
        result.used.push_back(i);
      } else {
        others.push_back(i);
      }
    }
    const auto called = [&](std::string_view name) {
      return std::ranges::find_if(found, [&](std::size_t i) { return table.columns[i].name == name; });
    };
    const bool beside_t = options.signal_t || std::ranges::any_of(table.columns, [](const TableColumn& one) {
                            return is_called_t(one.name);
                          });
    const auto exact = called("t") == found.end() && beside_t ? called("time") : called("t");
    const auto before_signal = [&](std::size_t i) {
      return i + 1 < table.columns.size() && std::ranges::find(found, i + 1) == found.end();
    };
    const bool one_each = table.columns.size() == 2 * found.size() && std::ranges::all_of(found, before_signal);
    if (!others.empty() && one_each) {
      if (!options.resamples()) {
        throw InputError(
            error::two_readings, table.columns[others.front()].place,
            fmt::format("Columns {} have different times: each signal has its own.",
                        fmt::join(names_of(table, found), " and ")),
            fmt::format(
                "bring all to one with --resample linear (hold for encoders and commands); or, if they count as "
                "recorded at once, --time {}.",
                option_value(table.columns[found.front()].name)));
      }
      for (const std::size_t i : found) {
        result.own.push_back({.column = i + 1, .seconds = own_times(table, i, options)});
      }
      // The time of the record is that of the signal with the most rows.
      std::ranges::stable_sort(found, std::ranges::greater{},
                               [&](std::size_t i) { return own_rows(table.columns[i], table.rows); });
      result.used = found;
    } else if (!others.empty() && exact != found.end()) {
      result.used = {*exact};
      found = {*exact};
    } else if (!others.empty()) {
      throw InputError(
          error::two_readings, table.columns[others.front()].place,
          fmt::format("Each of the columns {} could be the time.", fmt::join(names_of(table, found), " and ")),
          fmt::format("say which: --time {} or --time {}.", option_value(table.columns[found.front()].name),
                      option_value(table.columns[others.front()].name)));
    }
  }
  const std::size_t index = found.front();
  if (std::ranges::find(result.used, index) == result.used.end()) {
    result.used.push_back(index);
  }
  Found times = times_of_column(table, index, date, options);
  result.seconds = std::move(times.seconds);
  result.grid = times.grid;
  result.index = index;
  result.column = table.columns[index].name;
  if (result.column != "t" || !times.note.empty()) {
    result.notes.push_back(fmt::format("the time is column {}{}", result.column, times.note));
  }
  return result;
}

}  // namespace hysteron::records
