#include "records/column_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "records/text/csv_line.hpp"
#include "records/time/time_unit.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"
#include "support/numbers.hpp"
#include "support/utf8.hpp"

namespace hysteron::records {
namespace {

bool is_stated_time(const std::vector<NumberColumn>& columns, std::size_t index, const ReadOptions& options) {
  return !options.time.empty() &&
         (equal_ignoring_case(columns[index].name, options.time) || options.time == std::to_string(index + 1));
}

/// Whether the rules for times may look at a column: by its name, its unit, or because it is the first.
bool may_be_time(const std::vector<NumberColumn>& columns, std::size_t index, const ReadOptions& options) {
  const NumberColumn& column = columns[index];
  return is_stated_time(columns, index, options) || time_name(column.name) || time_unit(column.unit) ||
         (index + 1 < columns.size() && is_time_of(column.name, columns[index + 1].name));
}

/// How many rows a record has: as many as its time; without one, as most columns have, the longest of equals.
std::size_t rows_of(const std::vector<NumberColumn>& columns, const ReadOptions& options) {
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const bool is_time = options.time.empty() ? !options.rate && time_name(columns[i].name).has_value()
                                              : is_stated_time(columns, i, options);
    if (is_time && columns[i].values.size() > 1) {
      return columns[i].values.size();
    }
  }
  std::map<std::size_t, std::size_t> counts;
  for (const NumberColumn& column : columns) {
    ++counts[column.values.size()];
  }
  counts.erase(0);
  counts.erase(1);  // a constant beside the record
  const auto most =
      std::ranges::max_element(counts, {}, [](const auto& one) { return std::pair(one.second, one.first); });
  return most == counts.end() ? 0 : most->first;
}

Stamp stamp_of(double value) {
  constexpr double largest = 9e18;
  const double whole = std::trunc(value);
  return std::abs(whole) < largest ? Stamp{static_cast<std::int64_t>(whole), value - whole} : Stamp{0, value};
}

class Columns {
 public:
  Columns(const std::string& file, std::vector<NumberColumn> columns, const ReadOptions& options)
      : file_(file), columns_(std::move(columns)), options_(options), rows_(rows_of(columns_, options)) {}

  Table table() {
    if (rows_ < 2) {
      throw InputError(error::record_too_short, {.file = file_}, "There is no column with two values or more.",
                       "give a record of at least two samples.");
    }
    first_ = std::min(options_.first_row - 1, rows_);
    last_ = std::min(options_.last_row.value_or(rows_), rows_);
    if (last_ < first_ + 2) {
      throw InputError(error::record_too_short, {.file = file_},
                       fmt::format("Of the {} rows, rows {} to {} are less than two.", rows_, options_.first_row,
                                   options_.last_row.value_or(rows_)),
                       "give --rows within the record.");
    }
    Table result{.rows = last_ - first_, .place = {.file = file_}};
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      result.columns.push_back(column(i));
    }
    return result;
  }

 private:
  TableColumn column(std::size_t index) {
    NumberColumn& given = columns_[index];
    const bool is_time = may_be_time(columns_, index, options_);
    TableColumn result{
        .name = std::move(given.name), .unit = std::move(given.unit), .has_values = true, .is_time = given.is_time};
    result.kind = given.is_truth ? CellKind::Truth : CellKind::Number;
    result.place = {.file = file_};
    if (given.fault) {
      result.values.assign(last_ - first_, 0.0);
      result.fault = std::move(given.fault);
      return result;
    }
    if (given.values.size() != rows_) {
      result.values.assign(last_ - first_, 0.0);
      result.fault = Diagnostic{
          .number = error::ragged_row,
          .place = result.place,
          .cause = fmt::format("{} has {} values, the record {} rows.", result.name, given.values.size(), rows_),
          .mend = "bring it to the times of the others before it is saved."};
      return result;
    }
    result.values.assign(given.values.begin() + static_cast<std::ptrdiff_t>(first_),
                         given.values.begin() + static_cast<std::ptrdiff_t>(last_));
    for (std::size_t k = 0; k < result.values.size(); ++k) {
      take(result, k, is_time);
    }
    return result;
  }

  void take(TableColumn& column, std::size_t k, bool is_time) const {
    const double value = column.values[k];
    if (!std::isfinite(value)) {
      column.missing.push_back(k);
      column.is_gappy = true;
      if (!column.fault) {
        const std::size_t row = first_ + k + 1;
        column.fault = Diagnostic{
            .number = error::number_not_finite,
            .place = column.place,
            .cause = fmt::format("Column {} holds {} in row {}, which is no finite number.", column.name,
                                 number_text(value), row),
            .mend = row > 2
                        ? fmt::format("read the rows before it: --rows 1..{}, or record the signal again.", row - 1)
                        : fmt::format("read the rows behind it: --rows {}.., or record the signal again.", row + 1)};
      }
    }
    if (is_time) {
      column.stamps.push_back(std::isfinite(value) ? stamp_of(value) : Stamp{});
      if (std::isfinite(value)) {
        column.resolution.take(number_text(value));
      }
    }
  }

  const std::string& file_;
  std::vector<NumberColumn> columns_;
  const ReadOptions& options_;
  std::size_t rows_ = 0;   ///< of the whole record
  std::size_t first_ = 0;  ///< of those that are read
  std::size_t last_ = 0;
};

}  // namespace

Table table_of(const std::string& file, std::vector<NumberColumn> columns, const ReadOptions& options) {
  for (NumberColumn& column : columns) {
    if (column.unit.empty()) {
      HeaderName found = split_header(column.name);
      column.name = std::move(found.name);
      column.unit = std::move(found.unit);
    }
    const std::string written = column.name + column.unit;
    if (column.name.empty() || first_invalid_utf8(written) != std::string::npos ||
        std::ranges::any_of(written, [](char one) { return one == '"' || (one >= 0 && one < ' ') || one == '\x7F'; })) {
      throw InputError(
          error::missing_header, {.file = file},
          "The name of a column is empty, or holds a quote, a control character, or bytes that are no UTF-8.",
          "use letters, digits and _ in the names of columns, as a diagram does.");
    }
  }
  return Columns(file, std::move(columns), options).table();
}

}  // namespace hysteron::records
