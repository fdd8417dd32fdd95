#include "records/column_names.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "records/text/unit_text.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"
#include "support/time_heading.hpp"

namespace hysteron::records {
namespace {

/// The one column that is meant.
std::size_t the_column(const Table& table, const ColumnName& wanted) {
  const std::vector<std::size_t> found = columns_called(table, wanted.in_file);
  if (found.size() == 1) {
    return found.front();
  }
  if (found.size() > 1) {
    throw InputError(
        error::two_readings, table.columns[found[1]].place,
        fmt::format("{} columns are called {}.", found.size(), wanted.in_file),
        fmt::format("name it by its number from 1 on, as --column {}={}.", wanted.name, found.front() + 1));
  }
  const std::vector<std::string> names = names_of(table);
  const auto near = nearest_name(wanted.in_file, names);
  throw InputError(
      error::missing_column, table.place,
      fmt::format("There is no column {}; the columns are {}.", wanted.in_file, fmt::join(names, ", ")),
      near.empty() ? std::string("name one of these with --column.") : fmt::format("did you mean {}?", near));
}

}  // namespace

void rename(Table& table, const ReadOptions& options) {
  std::vector<std::optional<std::size_t>> found;
  for (const ColumnName& one : options.columns) {
    for (const ColumnName& other : options.columns) {
      if (&other < &one && equal_ignoring_case(other.name, one.name)) {
        throw InputError(error::two_readings, table.place,
                         fmt::format("{} is given two columns, {} and {}.", one.name, other.in_file, one.in_file),
                         "name one of them.");
      }
    }
    if (one.is_general && columns_called(table, one.in_file).empty()) {
      table.notes.push_back(
          fmt::format("there is no column {}, which the parameter file names for {}", one.in_file, one.name));
      found.emplace_back();
    } else {
      found.emplace_back(the_column(table, one));
    }
  }
  for (std::size_t k = 0; k < found.size(); ++k) {
    if (!found[k]) {
      continue;
    }
    const std::string& wanted = options.columns[k].name;
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
      const bool may_be_time =
          is_called_t(wanted) && (options.signal_t || (wanted == "T" && table.columns[i].name == "t"));
      if (i != *found[k] && equal_ignoring_case(table.columns[i].name, wanted) && !may_be_time) {
        table.columns[i].name += fmt::format(" ({})", i + 1);
      }
    }
    TableColumn& column = table.columns[*found[k]];
    column.in_file = column.name;
    column.name = wanted;
    column.unit = options.columns[k].unit.empty() ? column.unit : unit_of_word(options.columns[k].unit);
    column.is_named = true;
  }
}

void settle_names_of_t(Table& table, const Times& times, const ReadOptions& options) {
  const bool has_stated = std::ranges::any_of(
      table.columns, [](const TableColumn& one) { return is_called_t(one.name) && !one.in_file.empty(); });
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    TableColumn& column = table.columns[i];
    const bool is_time_again = times.index && table.columns[*times.index].name == column.name;
    if (!is_called_t(column.name) || !column.in_file.empty() || times.uses(i) || (is_time_again && !has_stated)) {
      continue;
    }
    if (has_stated || (!options.signal_t && column.name != "T")) {
      column.name += fmt::format(" ({})", i + 1);
    } else if (column.name != "T") {
      column.in_file = std::exchange(column.name, "T");
    }
  }
}

}  // namespace hysteron::records
