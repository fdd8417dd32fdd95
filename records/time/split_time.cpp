#include "records/time/split_time.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "records/time/time_unit.hpp"
#include "support/names.hpp"

namespace hysteron::records {
namespace {

/// How many of the parts that a column counts make a second; nothing where its name or its numbers are of another kind.
std::optional<TimeUnit> part_of_second(const TableColumn& column) {
  const auto unit =
      column.is_named && column.kind == CellKind::Number ? time_unit(last_word(column.name)) : std::nullopt;
  if (!unit || unit->over != 1 || !column.has_values || column.fault) {
    return std::nullopt;
  }
  if (unit->under == 1) {  // Fractional Seconds of Keithley
    const bool fractions = is_one_of(column.name, {"fractional seconds", "fraction of seconds", "fractional second"}) &&
                           std::ranges::all_of(column.values, [](double value) { return value >= 0.0 && value < 1.0; });
    return fractions ? unit : std::nullopt;
  }
  const auto parts = static_cast<double>(unit->under);
  const bool all = std::ranges::all_of(
      column.values, [&](double value) { return value >= 0.0 && value < parts && value == std::floor(value); });
  return all ? unit : std::nullopt;
}

/// A clock or a date with a clock, or seconds since 1970 in a column that is called so; without parts of a second.
bool counts_whole_seconds(const TableColumn& column) {
  const bool clock = column.kind == CellKind::Clock || column.kind == CellKind::DateTime;
  const bool epoch = column.kind == CellKind::Number && column.is_named && !column.stamps.empty() &&
                     time_unit(last_word(column.name)) && time_unit(last_word(column.name))->name == "s" &&
                     epoch_unit(column.stamps.front().whole);
  return (clock || epoch) && !column.fault &&
         std::ranges::all_of(column.stamps, [](const Stamp& stamp) { return stamp.fraction == 0.0; });
}

}  // namespace

void join_split_times(Table& table) {
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    const auto unit = part_of_second(table.columns[i]);
    if (!unit) {
      continue;
    }
    const auto whole = std::ranges::find_if(table.columns, counts_whole_seconds);
    if (whole == table.columns.end() || whole->stamps.size() != table.columns[i].values.size()) {
      return;
    }
    TableColumn& part = table.columns[i];
    for (std::size_t k = 0; k < part.values.size(); ++k) {
      whole->stamps[k].fraction = part.values[k] / static_cast<double>(unit->under);
      if (whole->kind == CellKind::Number) {
        whole->values[k] += whole->stamps[k].fraction;
      }
    }
    if (unit->under == 1) {
      whole->resolution = part.resolution;
    } else {
      whole->resolution.take(unit->under == 1000 ? "0.001" : unit->under == 1'000'000 ? "0.000001" : "0.000000001");
    }
    part.is_part_of_time = true;
    table.notes.push_back(fmt::format("{} counts the parts of a second of {}", part.name, whole->name));
    return;
  }
}

}  // namespace hysteron::records
