#include "records/read.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "records/column_names.hpp"
#include "records/formats.hpp"
#include "records/resampled_columns.hpp"
#include "records/scaled_unit.hpp"
#include "records/statistics.hpp"
#include "records/table.hpp"
#include "records/time/row_order.hpp"
#include "records/time/split_time.hpp"
#include "records/time/time_column.hpp"
#include "records/time/time_grid.hpp"
#include "records/time/time_unit.hpp"
#include "records/uneven_record.hpp"
#include "support/counted.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"
#include "support/numbers.hpp"
#include "support/option_words.hpp"
#include "support/rounded_text.hpp"
#include "support/text_file.hpp"
#include "support/time_heading.hpp"

namespace hysteron::records {
namespace {

// ---- time -----------------------------------------------------------------------------------------------------------

/// Where most rows share their times with others, the clock is too coarse: the rows have to be counted.
void refuse_coarse_clock(const Table& table, const Times& times, const Place& place) {
  std::size_t changes = 0;
  std::size_t first = 0;  // the first and the last row at which the clock goes on
  std::size_t last = 0;
  for (std::size_t k = 1; k < times.seconds.size(); ++k) {
    if (times.seconds[k] != times.seconds[k - 1]) {
      first = changes == 0 ? k : first;
      last = k;
      ++changes;
    }
  }
  if (2 * (changes + 1) > times.seconds.size()) {
    return;
  }
  const double span = times.seconds[last] - times.seconds[first];
  const double rate = changes > 1 && span > 0.0 ? static_cast<double>(last - first) / span : 0.0;
  throw InputError(
      error::reversed_time, place,
      fmt::format("{} rows have only {} time{}: the clock is coarser than the rows.", table.rows, changes + 1,
                  changes == 0 ? "" : "s"),
      rate > 0.0
          ? fmt::format("count the rows, by the rate of the logger: --rate {}Hz, if these {:.4g} rows a second are "
                        "even; or export the time with more digits.",
                        rounded_text(rate), rate)
          : std::string("count the rows, by the rate of the logger, such as --rate 1kHz; or export the time with "
                        "more digits."));
}

/// A signal beside others that goes from whole number to whole number, as an encoder does; nothing where there is none.
std::string stepping_signal(const Table& table, const Times& times) {
  std::string stepping;
  bool has_others = false;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    const TableColumn& column = table.columns[i];
    if (times.uses(i) || column.kind != CellKind::Number) {
      continue;
    }
    const bool steps = std::ranges::all_of(column.values, [](double value) { return value == std::round(value); });
    has_others = has_others || !steps;
    stepping = steps ? column.name : stepping;
  }
  return has_others ? stepping : std::string();
}

[[noreturn]] void refuse_time(const Table& table, const Times& times, std::size_t rows_before) {
  const TimeFault& fault = *times.grid.fault;
  constexpr int digits = 6;
  const auto place = [&](std::size_t row) {
    return table.source == nullptr ? table.place : table.source->place(times.column, row);
  };
  const std::vector<Note> before{{.place = place(fault.row - 1), .text = "the row before"}};
  Diagnostics list;
  if (fault.reversed) {
    const double last = times.seconds[fault.row - 1];
    const double now = times.seconds[fault.row];
    const auto [earlier, here] = distinct_texts(last, now, digits);
    if (last == now) {
      refuse_coarse_clock(table, times, place(fault.row));
    }
    list.error(
        error::reversed_time, place(fault.row),
        last == now ? fmt::format("The time {} s stands in two rows.", here)
                    : fmt::format("The time runs back, from {} s to {} s.", earlier, here),
        last == now
            ? "print the time with more digits, or remove the row that was written twice; events of a simulation: "
              "--resample hold, "
              "and the later row counts."
            : fmt::format("read one part alone: --rows 1..{} or --rows {}..; a file of several records is several "
                          "files.",
                          rows_before + fault.row, rows_before + fault.row + 1),
        before);
    throw InputError(list);
  }
  const std::string signal = stepping_signal(table, times);
  const bool missing = rows_missing_before(times.seconds, fault.row, fault.usual) > 0;
  std::string mend = fmt::format(
      "{}read it with --resample linear, where signals are analog and slow, or --resample hold, for encoders and "
      "commands, which step{}.",
      missing ? fmt::format("rows are missing: read one part alone, --rows 1..{}, or bridge the gap: ",
                            rows_before + fault.row)
              : std::string(),
      signal.empty() ? std::string() : "; of one signal alone, --resample " + option_value(signal + "=hold"));
  if (fault.coarse) {
    mend += " The times are printed coarsely: more digits may mend it.";
  }
  const auto [here, elsewhere] = distinct_texts(fault.step, fault.usual, digits);
  list.error(error::uneven_time, place(fault.row),
             fault.off > 0.0 ? fmt::format("No single step stands out, but the times stray from an even grid by "
                                           "{:.3g} s, {:.3g} sample times: the clock jitters or drifts.",
                                           fault.off, fault.off / fault.usual)
                             : fmt::format("The time goes on by {} s here, elsewhere by {} s.", here, elsewhere),
             mend, before);
  throw InputError(list);
}

// ---- columns --------------------------------------------------------------------------------------------------------

/// What makes a column no signal; nothing where it is one.
std::optional<Diagnostic> fault_of(const Table& table, const Times& times, std::size_t index) {
  const TableColumn& column = table.columns[index];
  // T beside a t that is the time is no second column of its name.
  const auto is_time_beside = [&](std::size_t i) {
    return times.uses(i) && is_called_t(column.name) &&
           (table.columns[i].name != column.name || !column.in_file.empty());
  };
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    if (i != index && equal_ignoring_case(table.columns[i].name, column.name) && !is_time_beside(i)) {
      return Diagnostic{.number = error::duplicate_column,
                        .place = column.place,
                        .cause = fmt::format("There are two columns {}.", column.name),
                        .mend = fmt::format("say which by its number: --column {} or --column {}.",
                                            option_value(fmt::format("{}={}", column.name, std::min(i, index) + 1)),
                                            option_value(fmt::format("{}={}", column.name, std::max(i, index) + 1)))};
    }
  }
  if (column.fault) {
    return column.fault;
  }
  if (column.kind != CellKind::Number && column.kind != CellKind::Truth) {
    return Diagnostic{.number = error::text_for_number,
                      .place = column.place,
                      .cause = fmt::format("Column {} holds no numbers.", column.name),
                      .mend = std::string(another_column)};
  }
  return std::nullopt;
}

std::string said_of_mark(const std::string& column, const MarkOfMissing& mark, std::size_t first_row) {
  const std::size_t row = mark.first + first_row;
  return fmt::format(
      "column {} holds {} in {}, where its other numbers go from {} to {}: if that means no value, leave it "
      "out, as --rows {}",
      column, number_text(mark.value), counted(mark.rows, "row"), rounded_text(mark.low), rounded_text(mark.high),
      row > 2 ? fmt::format("1..{}", row - 1) : fmt::format("{}..", row + 1));
}

struct OrderedTimes {
  Times times{};
  bool settled = false;  ///< rows were moved or left out
};
OrderedTimes times_in_order(Table& table, const ReadOptions& options) {
  join_split_times(table);
  OrderedTimes result{.times = times_of(table, options)};
  const std::optional<TimeFault>& fault = result.times.grid.fault;
  if (result.times.own.empty() && fault && fault->reversed && settle_rows(table, result.times.seconds, options)) {
    result = {.times = times_of(table, options), .settled = true};
  }
  return result;
}

/// Where a few samples are no numbers, a line over them invents little.
bool is_worth_bridging(const TableColumn& column, std::size_t rows) {
  constexpr std::size_t one_in = 20;
  return column.is_gappy && one_in * column.missing.size() <= rows;
}

enum class Uneven : std::uint8_t { Refused, Taken };

Record record_of(Table table, const ReadOptions& options, Uneven uneven = Uneven::Refused) {
  rename(table, options);
  take_scaled_units(table);
  if (table.source != nullptr) {
    table.source->names = names_of(table);
  }
  Times times = times_in_order(table, options).times;
  const bool resample = options.resamples();
  const bool is_faulty = times.grid.fault && (!resample || times.grid.fault->reversed);
  if (is_faulty && uneven == Uneven::Taken) {
    times.grid.sample_time = std::max(median_step(times.seconds), 0.0);
  } else if (is_faulty) {
    refuse_time(table, times, options.first_row - 1);
  }
  std::vector<Column> columns;
  std::vector<Record::Unreadable> unreadable;
  std::optional<ResampledColumns> even;
  if (resample) {
    even.emplace(table, times, options);
  }
  settle_names_of_t(table, times, options);
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    TableColumn& column = table.columns[i];
    const bool is_empty = !column.is_named && !column.has_values;  // the edge of a table, a separator at each end
    if (times.uses(i) || column.is_part_of_time || is_empty) {
      continue;
    }
    if (even && even->bridges(i)) {
      column.fault.reset();
    }
    if (auto fault = fault_of(table, times, i)) {
      if (fault->number == error::number_not_finite && is_worth_bridging(column, table.rows)) {
        fault->mend +=
            fmt::format(" It is {} of {} rows: --resample linear bridges them, or hold, where the signal steps.",
                        column.missing.size(), table.rows);
      }
      unreadable.push_back({.name = column.name, .fault = std::move(*fault)});
      continue;
    }
    if (const auto mark = mark_of_missing(column.values)) {
      table.notes.push_back(said_of_mark(column.name, *mark, options.first_row));
    }
    ResampledColumns::Brought brought = even ? even->bring(i) : ResampledColumns::Brought{std::move(column.values)};
    if (brought.fault) {
      unreadable.push_back({.name = column.name, .fault = std::move(*brought.fault)});
      continue;
    }
    columns.push_back({.name = column.name,
                       .unit = column.unit,
                       .values = std::move(brought.values),
                       .in_file = column.in_file,
                       .step = brought.step});
  }
  if (table.source != nullptr) {
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
      table.source->names[i] = table.columns[i].name;
    }
    if (times.index) {
      table.source->names[*times.index].clear();
    }
  }
  // Of a record that was resampled no row stands in the file.
  Record record(even ? even->seconds() : std::move(times.seconds), even ? even->sample_time() : times.grid.sample_time,
                std::move(columns), table.place, even ? nullptr : table.source);
  record.set_time_name(times.column);
  record.set_beside_t(options.signal_t.has_value());
  for (Record::Unreadable& one : unreadable) {
    record.add_unreadable(std::move(one.name), std::move(one.fault));
  }
  for (const auto* const notes : {&table.notes, &times.notes}) {
    for (const std::string& note : *notes) {
      record.note(note);
    }
  }
  for (const std::string& note : even ? even->said() : std::vector<std::string>()) {
    record.note(note);
  }
  return record;
}

void refuse_short_range(const std::string& file, std::size_t rows, std::span<const double> seconds) {
  if (rows < 2) {
    throw InputError(error::record_too_short, {.file = file},
                     fmt::format("The range holds {} of the rows, which go from {} s to {} s.", rows,
                                 number_text(seconds.front()), number_text(seconds.back())),
                     "give a range within the times of the record.");
  }
}

}  // namespace

Record read_table(const std::string& file, const TableReader& read, const ReadOptions& options) {
  if (!options.begin && !options.end) {
    return record_of(read(options), options);
  }
  // Rows outside of the range are not read at all, so that a fault there is none.
  Table whole = read(options);
  rename(whole, options);
  const auto [times, settled] = times_in_order(whole, options);
  if (settled) {  // no rows of the file, one behind the other
    ReadOptions all = options;
    all.begin.reset();
    all.end.reset();
    const Record record = record_of(std::move(whole), all);
    const RowRange rows = record.rows_between(options.begin.value_or(record.time().front()),
                                              options.end.value_or(std::numeric_limits<double>::infinity()));
    refuse_short_range(file, rows.size(), record.time());
    return record.slice(rows);
  }
  const double equal = 0.01 * times.grid.sample_time;
  std::size_t first = 0;
  while (first < times.seconds.size() && options.begin && times.seconds[first] < *options.begin - equal) {
    ++first;
  }
  std::size_t last = first;
  while (last < times.seconds.size() && (!options.end || times.seconds[last] < *options.end - equal)) {
    ++last;
  }
  refuse_short_range(file, last - first, times.seconds);
  ReadOptions narrowed = options;
  narrowed.begin.reset();
  narrowed.end.reset();
  narrowed.first_row = options.first_row + first;
  narrowed.last_row = options.first_row + last - 1;
  return record_of(read(narrowed), narrowed);
}

Record parse_record(const std::string& file, std::string bytes, const ReadOptions& options) {
  const Format& format = format_of(file, bytes);
  if (format.read == nullptr) {
    throw InputError(error::unread_format, {.file = file},
                     fmt::format("The file is {}, which is not read.", format.name), std::string(format.mend));
  }
  if (!options.begin && !options.end) {
    return record_of(format.read(file, std::move(bytes), options), options);
  }
  return read_table(
      file, [&](const ReadOptions& how) { return format.read(file, bytes, how); }, options);
}

Record parse_uneven_record(const std::string& file, std::string bytes, const ReadOptions& options) {
  const Format& format = format_of(file, bytes);
  ReadOptions whole = options;
  whole.begin.reset();
  whole.end.reset();
  whole.resampling = Resampling::None;
  whole.ways.clear();
  return record_of(format.read(file, std::move(bytes), whole), whole, Uneven::Taken);
}

Record parse_as_recorded(const std::string& file, const std::string& bytes, const ReadOptions& options) {
  try {
    return parse_record(file, bytes, options);
  } catch (const InputError& refused) {
    const auto is_uneven = [](const Diagnostic& one) { return one.number == error::uneven_time; };
    if (!std::ranges::all_of(refused.diagnostics().all(), is_uneven)) {
      throw;
    }
  }
  Record record = parse_uneven_record(file, bytes, options);
  if (options.begin || options.end) {
    const RowRange rows = record.rows_between(options.begin.value_or(record.time().front()),
                                              options.end.value_or(std::numeric_limits<double>::infinity()));
    refuse_short_range(file, rows.size(), record.time());
    record = record.slice(rows);
  }
  const TimeSurvey found = survey_of(record.time());
  record.note(fmt::format(
      "its times are uneven, and are kept: most rows are {} s apart, with a jitter of {:.2g} s RMS{}",
      rounded_text(found.usual), found.jitter, found.gaps > 0 ? " and " + counted(found.gaps, "gap") : std::string()));
  return record;
}

std::size_t rows_missing_before(std::span<const double> time, std::size_t row, double usual) {
  constexpr std::size_t reach = 3;
  const double step = time[row] - time[row - 1];
  if (!(step > 1.5 * usual)) {
    return 0;
  }
  const auto rows_in = [&](double span, std::size_t steps) {
    return std::clamp(std::round(span / usual) - static_cast<double>(steps), 0.0, 1e15);
  };
  const std::size_t first = row - std::min(row, reach + 1);
  const std::size_t last = std::min(time.size() - 1, row + reach);
  // At an end of the record fewer neighbours tell, and without any the step itself.
  return static_cast<std::size_t>(
      std::min(std::max(1.0, rows_in(step, 1)), rows_in(time[last] - time[first], last - first)));
}

TimeSurvey survey_of(std::span<const double> time) {
  TimeSurvey result{.usual = median_step(time)};
  double squares = 0.0;
  std::size_t others = 0;
  for (std::size_t k = 1; k < time.size(); ++k) {
    const double step = time[k] - time[k - 1];
    if (!(step > 0.0)) {
      result.first_backward = result.backward++ == 0 ? k + 1 : result.first_backward;
    } else if (const std::size_t missing = rows_missing_before(time, k, result.usual); missing > 0) {
      result.first_gap = result.gaps++ == 0 ? k : result.first_gap;
      result.missing += missing;
      result.longest_gap = std::max(result.longest_gap, step);
    } else if (step < 0.5 * result.usual) {
      ++result.close;
    } else {
      squares += (step - result.usual) * (step - result.usual);
      ++others;
    }
  }
  result.jitter = others > 0 ? std::sqrt(squares / static_cast<double>(others)) : 0.0;
  return result;
}

Record read_record(const std::string& path, const ReadOptions& options) {
  return parse_record(path, read_text_file(path), options);
}

}  // namespace hysteron::records
