#include "records/text/unit_column.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include "records/text/unit_text.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"
#include "support/trimmed.hpp"

namespace hysteron::records {
namespace {

constexpr std::array<std::string_view, 5> words{"unit", "units", "uom", "einheit", "engunit"};

/// U of U_unit; nothing of Unit, which is that of the column before it. None where the name is another.
std::optional<std::string_view> signal_of(std::string_view name) {
  for (const std::string_view word : words) {
    if (name.size() < word.size() || !equal_ignoring_case(name.substr(name.size() - word.size()), word)) {
      continue;
    }
    const std::string_view rest = trimmed(name.substr(0, name.size() - word.size()));
    if (rest.empty()) {
      return rest;
    }
    if (std::string_view("_.-/ ").find(rest.back()) != std::string_view::npos || name[rest.size()] == ' ') {
      return trimmed(rest, "_.-/ ");
    }
  }
  return std::nullopt;
}

}  // namespace

bool names_units(std::string_view column) {
  return signal_of(column).has_value();
}

void take_units_beside(Table& table) {
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    const TableColumn& units = table.columns[i];
    const auto signal = units.kind == CellKind::Text ? signal_of(units.name) : std::nullopt;
    if (!signal || !std::ranges::all_of(units.dictionary,
                                        [](const std::string& word) { return is_known_unit(unit_of_word(word)); })) {
      continue;
    }
    const auto is_meant = [&](const TableColumn& one) {
      return signal->empty() ? i > 0 && &one == &table.columns[i - 1] : equal_ignoring_case(one.name, *signal);
    };
    const auto meant = std::ranges::find_if(table.columns, is_meant);
    if (meant == table.columns.end() || !meant->unit.empty() || meant->kind != CellKind::Number ||
        units.dictionary.empty()) {
      continue;
    }
    if (units.dictionary.size() == 1) {
      meant->unit = unit_of_word(units.dictionary.front());
      table.notes.push_back(fmt::format("column {} is in {}, as column {} says", meant->name, meant->unit, units.name));
    } else if (!meant->fault) {
      meant->fault = Diagnostic{.number = error::two_readings,
                                .place = units.place,
                                .cause = fmt::format("Column {} says that {} is in {} and in {}.", units.name,
                                                     meant->name, units.dictionary[0], units.dictionary[1]),
                                .mend = "record one unit in each column."};
    }
  }
}

}  // namespace hysteron::records
