#include "tool/record_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <variant>

#include "codegen/graph/unit.hpp"
#include "plots/thinned.hpp"
#include "records/uneven_record.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"
#include "support/numbers.hpp"

namespace hysteron::tool {
namespace {

using plots::Curve;
using plots::Figure;
using plots::FigurePanel;

/// A curve over the times of a record. Where rows are missing it has a gap: nobody measured a line over it.
void take_rows(const records::Record& record, const std::vector<double>& values, Curve& curve) {
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (k > 0 && records::rows_missing_before(record.time(), k, record.sample_time()) > 0) {
      curve.x.push_back(0.5 * (record.time()[k - 1] + record.time()[k]));
      curve.y.push_back(std::nan(""));
    }
    curve.x.push_back(record.time()[k]);
    curve.y.push_back(values[k]);
  }
}

/// What the values of a column are multiplied by, to be in a unit; 1 where either is not known.
double factor_to(const std::string& unit, const records::Column& column, const records::Record& record) {
  if (unit.empty() || column.unit.empty() || unit == column.unit) {
    return 1.0;
  }
  std::string reason;
  const auto from = units::parse_unit(column.unit, reason);
  const auto to = units::parse_unit(unit, reason);
  const auto factor = from && to ? units::conversion(*from, *to) : std::nullopt;
  if (!factor) {
    throw InputError(
        error::unit_of_column, record.place(column.name, 0),
        fmt::format("Column {} is in {}, and in {} in the record before.", column.name, column.unit, unit),
        fmt::format("draw them apart, or state the unit of one by --column {}=NAME[{}].", column.name, unit));
  }
  return *factor;
}

/// The names of all columns, in the order in which they come; or those chosen.
std::vector<std::string> columns_of(std::span<const NamedRecord> records, const std::vector<std::string>& chosen) {
  std::vector<std::string> names;
  for (const std::string& name : chosen) {
    if (std::ranges::none_of(records, [&](const NamedRecord& one) { return one.record.find(name) != nullptr; })) {
      (void)records.front().record.column(name);  // throws, and names those there are
    }
    names.push_back(name);
  }
  for (const NamedRecord& one : records) {
    for (const records::Column& column : one.record.columns()) {
      const auto same = [&](const std::string& name) { return equal_ignoring_case(name, column.name); };
      if (chosen.empty() && std::ranges::none_of(names, same)) {
        names.push_back(column.name);
      }
    }
  }
  return names;
}

bool have_same_times(const records::Record& one, const records::Record& other) {
  const double allowed = 0.01 * one.sample_time();
  return std::ranges::equal(one.time(), other.time(), [&](double a, double b) { return std::abs(a - b) <= allowed; });
}

/// What the second curve has more than the first.
FigurePanel difference_of(const FigurePanel& panel) {
  const Curve& first = panel.curves[0];
  const Curve& second = panel.curves[1];
  Curve curve{.name = fmt::format("{} − {}", second.name, first.name), .x = first.x, .y = second.y, .colour = 2};
  for (std::size_t k = 0; k < curve.y.size(); ++k) {
    curve.y[k] -= first.y[k];
  }
  return {.title = fmt::format("{}: {}", panel.title, curve.name),
          .x_label = panel.x_label,
          .y_label = panel.y_label,
          .curves = {curve}};
}

/// The number of a parameter; nothing for a list.
std::optional<double> number_of(const parameters::Value& value) {
  if (const auto* real = std::get_if<double>(&value)) {
    return *real;
  }
  if (const auto* whole = std::get_if<std::int64_t>(&value)) {
    return static_cast<double>(*whole);
  }
  if (const auto* truth = std::get_if<bool>(&value)) {
    return *truth ? 1.0 : 0.0;
  }
  return std::nullopt;
}

std::string names_of(std::span<const NamedRecord> records) {
  std::string text;
  for (const NamedRecord& one : records) {
    text += (text.empty() ? "" : ", ") + one.name;
  }
  return text;
}

}  // namespace

std::vector<double> values_in_unit(const std::string& unit, const records::Column& column,
                                   const records::Record& record) {
  std::vector<double> values = column.values;
  const double factor = factor_to(unit, column, record);
  for (double& value : values) {
    value *= factor;
  }
  return values;
}

const records::Column* readable(const records::Record& record, const std::string& name) {
  const auto found = std::ranges::find_if(
      record.columns(), [&](const records::Column& column) { return equal_ignoring_case(column.name, name); });
  return found == record.columns().end() ? nullptr : &*found;
}

void bring_to_one_unit(std::span<NamedRecord> records) {
  for (NamedRecord& later : records) {
    for (const std::string& name : later.record.names()) {
      const auto first = std::ranges::find_if(records, [&](const NamedRecord& one) {
        const records::Column* const column = readable(one.record, name);
        return &one == &later || (column != nullptr && !column->unit.empty());
      });
      const records::Column& column = later.record.column(name);
      if (&*first == &later) {
        continue;
      }
      const std::string unit = first->record.column(name).unit;
      if (column.unit.empty()) {
        later.record.note(fmt::format("column {} has no unit, and is taken to be in {}, as in {}", column.name, unit,
                                      first->record.file()));
      } else if (const double factor = factor_to(unit, column, later.record); factor != 1.0) {
        later.record.note(fmt::format("column {} is in {}, and was converted to {}, as in {}: times {}", column.name,
                                      column.unit, unit, first->record.file(), number_text(factor)));
        later.record.convert(name, factor, unit);
      }
    }
  }
}

Figure figure_over_time(std::span<const NamedRecord> records, const std::vector<std::string>& chosen) {
  Figure figure{.title = names_of(records)};
  for (const std::string& name : columns_of(records, chosen)) {
    FigurePanel panel{.title = name, .x_label = "t [s]"};
    std::string unit;
    for (std::size_t i = 0; i < records.size(); ++i) {
      const records::Column* const column =
          chosen.empty() ? readable(records[i].record, name) : records[i].record.find(name);
      if (column == nullptr) {
        continue;
      }
      unit = unit.empty() ? column->unit : unit;
      Curve& curve = panel.curves.emplace_back(
          Curve{.name = records[i].name,
                .stroke = plots::is_of_steps(column->values) ? plots::Stroke::Steps : plots::Stroke::Line,
                .colour = i});
      take_rows(records[i].record, values_in_unit(unit, *column, records[i].record), curve);
    }
    panel.y_label = plots::axis_label(name, unit);
    figure.panels.push_back(panel);
    if (records.size() == 2 && panel.curves.size() == 2 && have_same_times(records[0].record, records[1].record) &&
        panel.curves[0].x.size() == panel.curves[1].x.size()) {
      figure.panels.push_back(difference_of(panel));
    }
  }
  return figure;
}

namespace {

/// The record itself where it has the column; else another one with the same times that has it, as the record that
/// drove a run has the run's inputs.
const records::Record& with_column(std::span<const NamedRecord> records, const std::string& name,
                                   const records::Record& record) {
  if (record.find(name) == nullptr) {
    for (const NamedRecord& other : records) {
      if (other.record.find(name) != nullptr && have_same_times(record, other.record)) {
        return other.record;
      }
    }
  }
  return record;
}

}  // namespace

Figure figure_in_plane(std::span<const NamedRecord> records, const std::string& abscissa, const std::string& ordinate) {
  FigurePanel panel;
  std::string x_unit;
  std::string y_unit;
  std::string names;
  for (std::size_t i = 0; i < records.size(); ++i) {
    const records::Record& record = records[i].record;
    const records::Record& driven_by = with_column(records, abscissa, record);
    const records::Column* const x = driven_by.find(abscissa);
    const records::Column* const y = record.find(ordinate);
    if (x == nullptr || y == nullptr) {
      continue;
    }
    x_unit = x_unit.empty() ? x->unit : x_unit;
    y_unit = y_unit.empty() ? y->unit : y_unit;
    names += (names.empty() ? "" : ", ") + records[i].name;
    panel.curves.push_back({.name = records[i].name,
                            .x = values_in_unit(x_unit, *x, driven_by),
                            .y = values_in_unit(y_unit, *y, record),
                            .colour = i});
  }
  if (panel.curves.empty()) {
    (void)records.front().record.column(abscissa);
    (void)records.front().record.column(ordinate);
  }
  panel.x_label = plots::axis_label(abscissa, x_unit);
  panel.y_label = plots::axis_label(ordinate, y_unit);
  return {.title = fmt::format("{} over {}: {}", ordinate, abscissa, names),
          .panels = {std::move(panel)},
          .over_time = false};
}

Figure figure_of_parameters(std::span<const NamedParameters> files) {
  Figure figure{.title = "Parameters"};
  std::vector<std::pair<std::string, double>> names;
  for (std::size_t i = 0; i < files.size(); ++i) {
    names.emplace_back(files[i].name, static_cast<double>(i + 1));
  }
  std::vector<std::string> done;
  for (const NamedParameters& of : files) {
    for (const parameters::ParameterValue& one : of.file.values) {
      const auto same_path = [&](const auto& other) { return equal_ignoring_case(other.path, one.path); };
      if (std::ranges::any_of(done, [&](const std::string& path) { return equal_ignoring_case(path, one.path); })) {
        continue;
      }
      done.push_back(one.path);
      Curve curve{.name = one.path, .stroke = plots::Stroke::Dots};
      for (std::size_t i = 0; i < files.size(); ++i) {
        const auto found = std::ranges::find_if(files[i].file.values, same_path);
        const auto value = found == files[i].file.values.end() ? std::nullopt : number_of(found->value);
        if (value) {
          curve.x.push_back(static_cast<double>(i + 1));
          curve.y.push_back(*value);
        }
      }
      const bool is_one =
          curve.y.empty() || std::ranges::all_of(curve.y, [&](double y) { return y == curve.y.front(); });
      if (!is_one) {
        figure.panels.push_back(
            {.title = one.path, .y_label = one.path, .curves = {std::move(curve)}, .x_names = names});
      }
    }
  }
  return figure;
}

}  // namespace hysteron::tool
