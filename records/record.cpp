#include "records/record.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "records/text/source_text.hpp"
#include "support/element_name.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"
#include "support/option_words.hpp"

namespace hysteron::records {

Record Record::even(double start, double sample_time, std::size_t rows) {
  if (!(sample_time > 0.0) || !std::isfinite(sample_time) || !std::isfinite(start)) {
    throw std::invalid_argument("a record needs a sample time above 0");
  }
  std::vector<double> time(rows);
  for (std::size_t k = 0; k < rows; ++k) {
    time[k] = start + static_cast<double>(k) * sample_time;
  }
  return {std::move(time), sample_time, {}, {}};
}

Record::Record(std::vector<double> time, double sample_time, std::vector<Column> columns, Place header,
               std::shared_ptr<const SourceText> source)
    : time_(std::move(time)), sample_time_(sample_time), header_(std::move(header)), source_(std::move(source)) {
  columns_.reserve(columns.size());
  for (Column& column : columns) {
    add(std::move(column));
  }
}

std::vector<std::string> Record::names() const {
  std::vector<std::string> result;
  result.reserve(columns_.size());
  for (const Column& column : columns_) {
    result.push_back(column.name);
  }
  return result;
}

std::vector<std::string> Record::all_names() const {
  std::vector<std::string> result = names();
  for (const Unreadable& one : unreadable_) {
    result.push_back(one.name);
  }
  return result;
}

const Column* Record::find(std::string_view name) const {
  const auto is_it = [&](const auto& column) { return equal_ignoring_case(column.name, name); };
  const auto found = std::ranges::find_if(columns_, is_it);
  if (found != columns_.end()) {
    return &*found;
  }
  if (const auto unreadable = std::ranges::find_if(unreadable_, is_it); unreadable != unreadable_.end()) {
    Diagnostics list;
    list.add(unreadable->fault);
    throw InputError(list);
  }
  return nullptr;
}

const Column& Record::column(std::string_view name) const {
  if (const Column* const found = find(name)) {
    return *found;
  }
  const auto known = all_names();
  // MAIN.fbAxis.u for U: what a controller records has the path of its variable before the name.
  const auto ends_so = std::ranges::find_if(known, [&](const std::string& one) {
    return one.size() > name.size() && equal_ignoring_case(one.substr(one.size() - name.size()), name) &&
           std::string_view("._:/ ").find(one[one.size() - name.size() - 1]) != std::string_view::npos;
  });
  // u_mV and u (raw) for U: a unit or a remark behind the name.
  const auto begins_so = std::ranges::find_if(known, [&](const std::string& one) {
    return one.size() > name.size() && equal_ignoring_case(one.substr(0, name.size()), name) &&
           std::string_view("_ (/").find(one[name.size()]) != std::string_view::npos;
  });
  std::string near = ends_so != known.end()     ? *ends_so
                     : begins_so != known.end() ? *begins_so
                                                : std::string(nearest_name(name, known));
  // An element of a vector: U_2 may be U[2], as generated code calls it; U[0] is not.
  if (const auto element = element_of(name)) {
    const auto flat = std::ranges::find_if(known, [&](const std::string& one) {
      return equal_ignoring_case(one, fmt::format("{}_{}", element->vector, element->index));
    });
    const auto other = element_of(near);
    const bool is_sibling = other && equal_ignoring_case(other->vector, element->vector);
    near = flat != known.end() ? *flat : is_sibling ? std::string() : near;
  }
  std::vector<std::string> shown = known;
  if (!time_name_.empty()) {  // as the file calls it; a record of a stated rate has none
    shown.insert(shown.begin(), time_name_);
  }
  throw InputError(
      error::missing_column, header_,
      fmt::format("There is no column {}; the {}.", name,
                  shown.size() == 1 ? fmt::format("only column is {}", shown.front())
                                    : fmt::format("columns are {}", fmt::join(shown, ", "))),
      near.empty()
          ? fmt::format("record the signal, or say which column it is, as --column {}=NAME.", name)
          : fmt::format("if {} is meant, say so: --column {}.", near, option_value(fmt::format("{}={}", name, near))));
}

Place Record::place(std::string_view column, std::size_t row) const {
  return source_ == nullptr ? Place{.file = file()} : source_->place(column, first_row_ + row);
}

Place Record::place_of_time(std::size_t row) const {
  return place("", row);
}

void Record::add(Column column) {
  if (column.values.size() != size()) {
    throw std::invalid_argument(
        fmt::format("column {} has {} values for {} rows", column.name, column.values.size(), size()));
  }
  if (column.name.empty() || find(column.name) != nullptr) {
    throw std::invalid_argument(fmt::format("column name \"{}\" is empty or taken", column.name));
  }
  if (is_called_t(column.name)) {
    column.name = signal_heading(column.name);
    is_beside_t_ = true;
  }
  columns_.push_back(std::move(column));
}

void Record::replace(std::string_view name, std::vector<double> values) {
  if (values.size() != size()) {
    throw std::invalid_argument(fmt::format("column {} has {} values for {} rows", name, values.size(), size()));
  }
  columns_[static_cast<std::size_t>(&column(name) - columns_.data())].values = std::move(values);
}

void Record::convert(std::string_view name, double factor, std::string unit) {
  Column& converted = columns_[static_cast<std::size_t>(&column(name) - columns_.data())];
  for (double& value : converted.values) {
    value *= factor;
  }
  converted.step *= std::abs(factor);
  converted.unit = std::move(unit);
}

void Record::remove(std::string_view name) {
  std::erase_if(columns_, [&](const Column& column) { return equal_ignoring_case(column.name, name); });
}

Record Record::slice(RowRange rows) const {
  if (rows.first > rows.last || rows.last > size()) {
    throw std::out_of_range(fmt::format("rows {} to {} of {}", rows.first, rows.last, size()));
  }
  const auto cut = [&](const std::vector<double>& values) {
    const auto begin = values.begin();
    return std::vector<double>(begin + static_cast<std::ptrdiff_t>(rows.first),
                               begin + static_cast<std::ptrdiff_t>(rows.last));
  };
  Record result(cut(time_), sample_time_, {}, header_, source_);
  result.first_row_ = first_row_ + rows.first;
  result.unreadable_ = unreadable_;
  result.notes_ = notes_;
  result.time_name_ = time_name_;
  result.is_beside_t_ = is_beside_t_;
  for (const Column& column : columns_) {
    Column part = column;
    part.values = cut(column.values);
    result.add(std::move(part));
  }
  return result;
}

RowRange Record::rows_between(double begin, double end) const {
  const double equal = 0.01 * sample_time_;
  const auto row_at = [&](double time) {
    const auto found = std::lower_bound(time_.begin(), time_.end(), time - equal);
    return static_cast<std::size_t>(found - time_.begin());
  };
  const std::size_t first = row_at(begin);
  return {first, std::max(first, row_at(end))};
}

}  // namespace hysteron::records
