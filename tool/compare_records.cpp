#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "support/errors.hpp"
#include "support/names.hpp"
#include "support/numbers.hpp"
#include "support/root_mean_square.hpp"
#include "support/rounded_text.hpp"
#include "tool/comparison.hpp"
#include "tool/record_figures.hpp"

namespace hysteron::tool {
namespace {

struct RowPair {
  std::size_t a = 0;
  std::size_t b = 0;
};

/// Rows of the same time, to a hundredth of a sample.
std::vector<RowPair> common_rows(const records::Record& a, const records::Record& b) {
  const double near = 0.01 * std::min(a.sample_time(), b.sample_time());
  std::vector<RowPair> rows;
  for (std::size_t i = 0, k = 0; i < a.size() && k < b.size();) {
    const double apart = a.time()[i] - b.time()[k];
    if (std::abs(apart) <= near) {
      rows.push_back({.a = i++, .b = k++});
    } else if (apart < 0.0) {
      ++i;
    } else {
      ++k;
    }
  }
  return rows;
}

bool overlap(const records::Record& a, const records::Record& b) {
  return a.time().front() <= b.time().back() && b.time().front() <= a.time().back();
}

/// Whether rows of other times lie between those that are common: not a part of the other record, but another clock.
bool are_mixed(const records::Record& a, const records::Record& b, const std::vector<RowPair>& rows) {
  const RowPair& first = rows.front();
  const RowPair& last = rows.back();
  return last.a - first.a + 1 > rows.size() || last.b - first.b + 1 > rows.size() || (first.a > 0 && first.b > 0) ||
         (last.a + 1 < a.size() && last.b + 1 < b.size());
}

bool have_same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b) || (std::isnan(a) && std::isnan(b));
}

struct ColumnDifference {
  double largest = 0.0;
  double rms = 0.0;
  std::size_t largest_at = 0;  ///< number of the pair of rows
  std::size_t first = 0;
  std::size_t beyond = 0;  ///< rows beyond the tolerance
  std::size_t other_bits = 0;
};

ColumnDifference difference_of(const std::vector<double>& a, const std::vector<double>& b,
                               const std::vector<RowPair>& rows, const Tolerance& tolerance) {
  ColumnDifference found;
  RootMeanSquare rms;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double one = a[rows[i].a];
    const double other = b[rows[i].b];
    found.other_bits += have_same_bits(one, other) ? 0 : 1;
    if (!tolerance.holds(one, other)) {
      found.first = found.beyond == 0 ? i : found.first;
      ++found.beyond;
    }
    const double apart = std::abs(other - one);
    if (std::isfinite(apart)) {
      rms.add(apart);
      if (apart > found.largest) {
        found.largest = apart;
        found.largest_at = i;
      }
    }
  }
  found.rms = rms.value();
  return found;
}

void add_lonely(Comparison& result, const records::Record& a, const records::Record& b, const char* key, char whose) {
  nlohmann::ordered_json names = nlohmann::ordered_json::array();
  for (const records::Column& column : a.columns()) {
    const auto same_name = [&](const records::Record::Unreadable& one) {
      return equal_ignoring_case(one.name, column.name);
    };
    if (readable(b, column.name) == nullptr && std::ranges::none_of(b.unreadable(), same_name)) {
      result.same = false;
      names.push_back(column.name);
      result.text += fmt::format("{}: only in {}\n", column.name, whose);
    }
  }
  result.json[key] = std::move(names);
}

}  // namespace

bool Tolerance::holds(double a, double b) const {
  return a == b || (std::isnan(a) && std::isnan(b)) || std::abs(b - a) <= absolute + relative * std::abs(a);
}

Comparison compare_records(const records::Record& a, const records::Record& b, const Tolerance& tolerance) {
  const std::vector<RowPair> rows = common_rows(a, b);
  if (rows.empty()) {
    throw InputError(
        error::bad_usage, {.file = b.file()},
        fmt::format("The records have no time in common: {} to {} s, and {} to {} s.", number_text(a.time().front()),
                    number_text(a.time().back()), number_text(b.time().front()), number_text(b.time().back())),
        overlap(a, b) ? "compare them at the times of the slower one: --resample linear, or hold where signals step."
                      : "give records of the same time: those of another begin have to be cut and shifted.");
  }
  Comparison result;
  result.json["rows"] = rows.size();
  result.json["rows_only_in_a"] = a.size() - rows.size();
  result.json["rows_only_in_b"] = b.size() - rows.size();
  if (a.size() != rows.size() || b.size() != rows.size()) {
    result.same = false;
    result.text +=
        fmt::format("{} rows have the same time; {} are only in A, {} only in B{}\n", rows.size(),
                    a.size() - rows.size(), b.size() - rows.size(),
                    are_mixed(a, b, rows) ? "; --resample linear compares at the times of the slower one" : "");
  }
  nlohmann::ordered_json columns = nlohmann::ordered_json::array();
  bool all_bits = true;
  for (const records::Column& column : a.columns()) {
    const records::Column* const other = readable(b, column.name);
    if (other == nullptr) {
      continue;
    }
    const auto found = difference_of(column.values, values_in_unit(column.unit, *other, b), rows, tolerance);
    const auto time = [&](std::size_t row) { return a.time()[rows[row].a]; };
    all_bits = all_bits && found.other_bits == 0;
    result.same = result.same && found.beyond == 0;
    columns.push_back(
        {{"name", column.name},
         {"unit", column.unit},
         {"largest", found.largest},
         {"largest_at", time(found.largest_at)},
         {"rms", found.rms},
         {"rows_beyond", found.beyond},
         {"first_at", found.beyond > 0 ? nlohmann::ordered_json(time(found.first)) : nlohmann::ordered_json()},
         {"equal_bits", found.other_bits == 0}});
    const std::string unit = column.unit.empty() ? "" : " " + column.unit;
    if (found.other_bits == 0) {
      result.text += fmt::format("{}: equal bits\n", column.name);
    } else {
      result.text += fmt::format("{}: largest difference {:.4g}{} at t = {} s, RMS {:.4g}{}", column.name,
                                 found.largest, unit, rounded_text(time(found.largest_at)), found.rms, unit);
      result.text += found.beyond == 0 ? std::string("; within the tolerance\n")
                                       : fmt::format("; first different at t = {} s, in {} of {} rows\n",
                                                     rounded_text(time(found.first)), found.beyond, rows.size());
    }
  }
  // A column with something that is no finite number is not compared, and so is not the same.
  auto not_compared = nlohmann::ordered_json::array();
  for (const records::Record* const record : {&a, &b}) {
    for (const records::Record::Unreadable& one : record->unreadable()) {
      result.same = false;
      not_compared.push_back({{"name", one.name}, {"file", record->file()}, {"cause", one.fault.cause}});
      result.text += fmt::format("{}: not compared; {}: {}\n", one.name, record->file(), one.fault.cause);
    }
  }
  result.json["columns_not_compared"] = std::move(not_compared);
  result.json["columns"] = std::move(columns);
  add_lonely(result, a, b, "columns_only_in_a", 'A');
  add_lonely(result, b, a, "columns_only_in_b", 'B');
  result.json["equal_bits"] = all_bits && result.same;
  return result;
}

}  // namespace hysteron::tool
