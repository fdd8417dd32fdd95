#include "records/time/row_order.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

namespace hysteron::records {
namespace {

/// The rows that are kept, of every list that has one value a row.
void keep_rows(Table& table, const std::vector<std::size_t>& kept) {
  const auto pick = [&](auto& values) {
    if (values.size() != table.rows) {
      return;
    }
    auto picked = values;
    picked.resize(kept.size());
    for (std::size_t k = 0; k < kept.size(); ++k) {
      picked[k] = values[kept[k]];
    }
    values = std::move(picked);
  };
  for (TableColumn& column : table.columns) {
    std::vector<bool> missing(table.rows);
    for (const std::size_t row : column.missing) {
      missing[row] = true;
    }
    column.missing.clear();
    for (std::size_t k = 0; k < kept.size(); ++k) {
      if (missing[kept[k]]) {
        column.missing.push_back(k);
      }
    }
    pick(column.values);
    pick(column.stamps);
    pick(column.words);
  }
  if (table.source != nullptr) {
    pick(table.source->rows);
  }
  table.rows = kept.size();
}

bool same_numbers(const Table& table, std::size_t a, std::size_t b) {
  return std::ranges::all_of(table.columns, [&](const TableColumn& column) {
    return (column.values.size() != table.rows || column.values[a] == column.values[b]) &&
           std::ranges::binary_search(column.missing, a) == std::ranges::binary_search(column.missing, b);
  });
}

/// The signal with the numbers of each time in its first row; nothing where a time has two of them.
std::optional<TableColumn> joined(const TableColumn& column, std::span<const std::size_t> first_of) {
  TableColumn result = column;
  std::vector<bool> missing(first_of.size());
  for (const std::size_t row : column.missing) {
    missing[row] = true;
  }
  for (std::size_t k = 0; k < first_of.size(); ++k) {
    const std::size_t first = first_of[k];
    if (first == k || missing[k]) {
      continue;
    }
    if (!missing[first] && result.values[first] != result.values[k]) {
      return std::nullopt;
    }
    missing[first] = false;
    result.values[first] = result.values[k];
  }
  std::erase_if(result.missing, [&](std::size_t row) { return first_of[row] == row && !missing[row]; });
  return result;
}

/// The rows of one time are parts of one row where no signal has two numbers there: topics of ROS one below the other,
/// tables that were joined by their times. Puts them together; whether any were.
bool join_parts(Table& table, std::span<const double> seconds) {
  std::vector<std::size_t> kept;
  std::vector<std::size_t> first_of(table.rows);
  for (std::size_t k = 0; k < table.rows; ++k) {
    if (kept.empty() || seconds[k] != seconds[kept.back()]) {
      kept.push_back(k);
    }
    first_of[k] = kept.back();
  }
  std::vector<TableColumn> columns;
  bool any = false;
  for (const TableColumn& column : table.columns) {
    const bool is_signal = (column.kind == CellKind::Number || column.kind == CellKind::Truth) &&
                           column.values.size() == table.rows && column.has_values;
    std::optional<TableColumn> one = is_signal ? joined(column, first_of) : column;
    if (!one) {
      return false;
    }
    any = any || one->missing.size() < column.missing.size();
    columns.push_back(std::move(*one));
  }
  if (!any) {
    return false;
  }
  table.columns = std::move(columns);
  keep_rows(table, kept);
  for (TableColumn& column : table.columns) {
    if (column.is_gappy && column.missing.empty()) {
      column.fault.reset();
      column.is_gappy = false;
    }
  }
  table.notes.push_back(fmt::format("rows of one time that fill each other's gaps were put together: {} rows are {}",
                                    seconds.size(), kept.size()));
  return true;
}

}  // namespace

bool settle_rows(Table& table, std::span<const double> seconds, const ReadOptions& options) {
  std::vector<std::size_t> kept;
  if (std::ranges::adjacent_find(seconds, std::less_equal{}) == seconds.end()) {
    for (std::size_t k = seconds.size(); k-- > 0;) {
      kept.push_back(k);
    }
    keep_rows(table, kept);
    table.notes.emplace_back("the rows stand in the order newest first, and were turned round");
    return true;
  }
  if (join_parts(table, seconds)) {
    return true;
  }
  std::size_t twice = 0;
  std::size_t replaced = 0;
  for (std::size_t k = 0; k < seconds.size(); ++k) {
    const bool again = !kept.empty() && seconds[k] == seconds[kept.back()];
    if (again && same_numbers(table, kept.back(), k)) {
      ++twice;
    } else if (again && options.resamples()) {
      kept.back() = k;
      ++replaced;
    } else {
      kept.push_back(k);
    }
  }
  // Where most rows share their times, the clock is coarser than the rows, and no row is one too many.
  if (twice + replaced == 0 || 4 * (twice + replaced) > seconds.size()) {
    return false;
  }
  keep_rows(table, kept);
  if (twice > 0) {
    table.notes.push_back(fmt::format("{} stand{} twice in the file, and {} read once",
                                      twice == 1 ? "one row" : fmt::format("{} rows", twice), twice == 1 ? "s" : "",
                                      twice == 1 ? "was" : "were"));
  }
  if (replaced > 0) {
    table.notes.push_back(fmt::format("of two rows with one time the later counts: {} times", replaced));
  }
  return true;
}

}  // namespace hysteron::records
