#include "records/text/decimal_marks.hpp"

#include <fmt/format.h>

#include <string>

#include "support/errors.hpp"

namespace hysteron::records {
namespace {

/// 1,052 beside 0.001: what cannot separate thousands is the decimal mark.
std::string mend_of_two_marks(std::string_view one, std::string_view other) {
  const auto is_thousands = [](std::string_view text) {
    return number_with_mark(text, text.find('.') != std::string_view::npos ? ',' : '.').kind == CellKind::Number;
  };
  const bool one_has_point = one.find('.') != std::string_view::npos;
  const bool points = is_thousands(one_has_point ? one : other);
  const bool commas = is_thousands(one_has_point ? other : one);
  return points && commas ? "if points separate thousands, say --decimal comma; if commas do, say --decimal point."
         : points         ? "if points separate thousands, say --decimal comma."
         : commas         ? "if commas separate thousands, say --decimal point."
                          : "write all numbers with the same decimal mark.";
}

/// 2.664, 12.345: three digits behind the point, and no zero alone before it.
bool looks_grouped(std::string_view text) {
  text = text.substr(text.starts_with('-') || text.starts_with('+') ? 1 : 0);
  const auto point = text.find('.');
  return point >= 1 && point <= 3 && text.size() == point + 4 && text.front() != '0';
}

}  // namespace

void DecimalMarks::see(const Line& line, const Cell& cell, const CellValue& value, std::size_t column) {
  if (value.has_point) {
    Pointed& points = columns_[column];
    ++points.count;
    points.first = points.first ? points.first : std::optional(std::pair(line, cell));
    points.thousands = points.thousands && looks_grouped(cell.text);
  } else if (!value.has_comma) {
    ++columns_[column].whole;
  }
  if (!value.has_comma && !value.has_point) {
    return;
  }
  auto& seen = value.has_comma ? comma_seen_ : point_seen_;
  const auto& other = value.has_comma ? point_seen_ : comma_seen_;
  if (seen) {
    return;
  }
  seen = std::pair(line, cell);
  if (other) {
    diagnostics_->error(error::ambiguous_decimal_mark, source_->place_of(line, cell),
                        fmt::format("{} has a decimal {}, an earlier number has a decimal {}.", cell.text,
                                    value.has_comma ? "comma" : "point", value.has_comma ? "point" : "comma"),
                        mend_of_two_marks(cell.text, other->second.text),
                        {{.place = source_->place_of(other->first, other->second), .text = "the earlier number"}});
  }
}

void DecimalMarks::doubt_points(Table& table, char separator) const {
  if (separator != ';' && separator != '\t') {
    return;
  }
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    const Pointed& points = columns_[i];
    if (points.count == 0 || points.whole == 0 || !points.thousands || table.columns[i].fault) {
      continue;
    }
    const auto& [line, cell] = *points.first;
    std::string without(cell.text);
    std::erase(without, '.');
    table.columns[i].fault = Diagnostic{
        .number = error::ambiguous_decimal_mark,
        .place = source_->place_of(line, cell),
        .cause = fmt::format("{} in column {} could be read in two ways: the point may separate thousands, as in {}.",
                             cell.text, table.columns[i].name, without),
        .mend = "say which: --decimal comma, and points separate thousands; or --decimal point."};
  }
}

}  // namespace hysteron::records
