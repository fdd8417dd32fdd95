#include "records/scaled_unit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include "records/text/unit_text.hpp"
#include "records/time/time_unit.hpp"
#include "support/errors.hpp"
#include "support/numbers.hpp"
#include "support/option_words.hpp"
#include "support/trimmed.hpp"

namespace hysteron::records {
namespace {

/// x1000, *1000, ×1000 and 1000x.
bool is_bare_factor(std::string_view unit) {
  constexpr std::string_view times = "\xC3\x97";
  for (const std::string_view mark : {std::string_view("x"), std::string_view("X"), std::string_view("*"), times}) {
    const std::string_view number = unit.starts_with(mark) ? trimmed(unit.substr(mark.size()))
                                    : unit.ends_with(mark) ? trimmed(unit.substr(0, unit.size() - mark.size()))
                                                           : std::string_view();
    if (!number.empty() && cell_value(number).kind == CellKind::Number) {
      return true;
    }
  }
  return false;
}

/// 0.1, 0.01, 1e-3: no range of an input is called so.
bool is_surely_a_factor(double factor) {
  const double power = std::log10(factor);
  return factor < 1.0 && std::abs(power - std::round(power)) < 1e-9;
}

void refuse(TableColumn& column, std::string cause) {
  const std::string& in_file = column.in_file.empty() ? column.name : column.in_file;
  column.fault = Diagnostic{.number = error::two_readings,
                            .place = column.place,
                            .cause = std::move(cause),
                            .mend = fmt::format("say the unit in which its numbers are, as --column {}.",
                                                option_value(fmt::format("{}={}[mV]", column.name, in_file)))};
}

}  // namespace

void take_scaled_units(Table& table) {
  for (TableColumn& column : table.columns) {
    if (column.unit.empty() || column.kind != CellKind::Number || column.fault || time_unit(column.unit)) {
      continue;
    }
    if (const auto scaled = scaled_unit(column.unit)) {
      if (!is_surely_a_factor(scaled->factor)) {
        refuse(column, fmt::format("Column {} is in {}: its numbers could count these, or it could be a range.",
                                   column.name, column.unit));
        continue;
      }
      for (double& value : column.values) {
        value *= scaled->factor;
      }
      table.notes.push_back(fmt::format("column {} is in {}: its numbers were multiplied by {}", column.name,
                                        column.unit, number_text(scaled->factor)));
      column.unit = scaled->unit;
    } else if (is_bare_factor(column.unit)) {
      refuse(column,
             fmt::format("Column {} has the factor {}: its numbers could have been multiplied by it, or be to be "
                         "multiplied.",
                         column.name, column.unit));
    }
  }
}

}  // namespace hysteron::records
