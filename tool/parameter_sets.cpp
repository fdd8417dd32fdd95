#include "tool/parameter_sets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string_view>
#include <utility>

#include "codegen/parameters/apply.hpp"
#include "codegen/parameters/parameter_file.hpp"
#include "support/byte_order_mark.hpp"
#include "support/element_name.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"
#include "support/numbers.hpp"
#include "support/text_file.hpp"
#include "support/trimmed.hpp"

namespace hysteron::tool {
namespace {

/// The values of the varied parameters, and where each set stands.
struct Table {
  std::vector<std::string> paths{};
  std::vector<std::vector<double>> rows{};
  std::vector<Place> places{};  ///< by set; one for all where no file has them

  [[nodiscard]] const Place& place_of(std::size_t set) const {
    return places.size() == 1 ? places.front() : places[set];
  }
};

[[noreturn]] void refuse(std::string cause, std::string mend) {
  throw InputError(error::bad_usage, {}, std::move(cause), std::move(mend));
}

// --- a table ---------------------------------------------------------------------------------------------------------

std::vector<std::string> cells_of(std::string_view line, char separator) {
  std::vector<std::string> cells;
  while (true) {
    const std::size_t end = line.find(separator);
    cells.emplace_back(trimmed(line.substr(0, end)));
    if (end == std::string_view::npos) {
      return cells;
    }
    line.remove_prefix(end + 1);
  }
}

double number_of(const std::string& cell, const std::string& path, const Place& place) {
  const ParsedNumber read = parse_number(cell);
  if (read.status == NumberStatus::NotANumber) {
    throw InputError(error::text_for_number, place, fmt::format("{} is \"{}\", which is no number.", path, cell),
                     "write a number with a point: 0.05.");
  }
  if (read.status != NumberStatus::Finite) {
    throw InputError(error::number_not_finite, place, fmt::format("{} is {}, which is no finite number.", path, cell),
                     "write a finite number.");
  }
  return read.value;
}

void check_head(const std::vector<std::string>& paths, const Place& place) {
  for (std::size_t i = 0; i < paths.size(); ++i) {
    if (paths[i].empty()) {
      throw InputError(error::missing_header, place, fmt::format("Column {} has no name.", i + 1),
                       "name the parameter of each column in the first line: INV.C1,INV.C2.");
    }
    if (std::find(paths.begin(), paths.begin() + static_cast<std::ptrdiff_t>(i), paths[i]) !=
        paths.begin() + static_cast<std::ptrdiff_t>(i)) {
      throw InputError(error::duplicate_column, place, fmt::format("{} has two columns.", paths[i]),
                       "leave one of them out.");
    }
  }
}

Table table_of_file(const std::string& file) {
  const std::string text = without_mark(read_text_file(file));
  Table table;
  char separator = ',';
  std::uint32_t line_number = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string line(trimmed(std::string_view(text).substr(at, end - at), " \t\r"));
    at = end + 1;
    ++line_number;
    if (line.empty() || line.front() == '#') {
      continue;
    }
    const Place place{.file = file, .line = line_number, .column = 1};
    if (table.paths.empty()) {
      separator = line.find(';') != std::string::npos ? ';' : line.find('\t') != std::string::npos ? '\t' : ',';
      for (const std::string& name : cells_of(line, separator)) {
        table.paths.push_back(in_capitals(name));
      }
      check_head(table.paths, place);
      continue;
    }
    const std::vector<std::string> cells = cells_of(line, separator);
    if (cells.size() != table.paths.size()) {
      throw InputError(error::ragged_row, place,
                       fmt::format("This set has {} values, for {} parameters.", cells.size(), table.paths.size()),
                       separator == ';'
                           ? "write one value for each name of the first line."
                           : "write one value for each name of the first line; a decimal mark is a point.");
    }
    std::vector<double> row;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      row.push_back(number_of(cells[i], table.paths[i], place));
    }
    table.rows.push_back(std::move(row));
    table.places.push_back(place);
  }
  if (table.rows.empty()) {
    throw InputError(error::record_too_short, {.file = file}, "The table has no set.",
                     "write the names of parameters in the first line, INV.C1,INV.C2, and a line of values for each "
                     "set.");
  }
  return table;
}

// --- what options say ------------------------------------------------------------------------------------------------

/// `INV.C1` and what stands behind the =.
std::pair<std::string, std::string_view> named(const std::string& text, std::string_view option,
                                               std::string_view example) {
  const std::size_t equals = text.find('=');
  if (equals == 0 || equals == std::string::npos || equals + 1 == text.size()) {
    refuse(fmt::format("{} {} names no parameter with its values.", option, text),
           fmt::format("write {} {}.", option, example));
  }
  return {in_capitals(trimmed(std::string_view(text).substr(0, equals))), std::string_view(text).substr(equals + 1)};
}

double number_in(std::string_view text, const std::string& whole, std::string_view option, std::string_view example) {
  const ParsedNumber read = parse_number(trimmed(text));
  if (read.status != NumberStatus::Finite) {
    refuse(fmt::format("{} {}: \"{}\" is no finite number.", option, whole, text),
           fmt::format("write {} {}.", option, example));
  }
  return read.value;
}

constexpr std::string_view sweep_example = "INV.C1=0.1..0.3/21";
constexpr std::string_view draw_example = "INV.C1=normal(0.2,0.01)";

std::vector<double> sweep_values(std::string_view range, const std::string& whole) {
  const std::size_t dots = range.find("..");
  const std::size_t slash = range.find('/', dots == std::string_view::npos ? 0 : dots);
  const bool third_dot = dots != std::string_view::npos && range.substr(dots + 2).starts_with('.');
  if (dots == std::string_view::npos || slash == std::string_view::npos || third_dot) {
    refuse(fmt::format("--sweep {} states no range with a number of values.", whole),
           fmt::format("write --sweep {}: from 0.1 to 0.3 in 21 values.", sweep_example));
  }
  const double low = number_in(range.substr(0, dots), whole, "--sweep", sweep_example);
  const double high = number_in(range.substr(dots + 2, slash - dots - 2), whole, "--sweep", sweep_example);
  const double count = number_in(range.substr(slash + 1), whole, "--sweep", sweep_example);
  if (count < 2.0 || count > static_cast<double>(most_sets) || count != std::floor(count)) {
    refuse(fmt::format("--sweep {} asks for {} values.", whole, number_text(count)),
           fmt::format("write a whole number from 2 to {} behind the /.", most_sets));
  }
  const auto steps = static_cast<std::size_t>(count);
  std::vector<double> values(steps);
  for (std::size_t i = 0; i < steps; ++i) {
    const double share = static_cast<double>(i) / (count - 1.0);
    values[i] = i + 1 == steps ? high : low + share * (high - low);
  }
  return values;
}

/// All combinations; the last parameter changes first.
Table grid_of(const std::vector<std::string>& sweeps) {
  Table table{.places = {Place{}}};
  table.rows.emplace_back();
  for (const std::string& sweep : sweeps) {
    const auto [path, range] = named(sweep, "--sweep", sweep_example);
    const std::vector<double> values = sweep_values(range, sweep);
    if (table.rows.size() > most_sets / values.size()) {
      refuse(fmt::format("The sweeps make more than {} sets.", most_sets), "take fewer values of each.");
    }
    std::vector<std::vector<double>> rows;
    rows.reserve(table.rows.size() * values.size());
    for (const std::vector<double>& row : table.rows) {
      for (const double value : values) {
        rows.push_back(row);
        rows.back().push_back(value);
      }
    }
    table.rows = std::move(rows);
    table.paths.push_back(path);
  }
  return table;
}

/// A distribution of draws: both kinds have two numbers.
struct Distribution {
  bool normal = false;
  double first = 0.0;
  double second = 0.0;

  /// From two uniform numbers, above 0 and below 1: those of the standard library differ from one library to the next.
  [[nodiscard]] double operator()(double a, double b) const {
    return normal ? first + second * std::sqrt(-2.0 * std::log(a)) * std::cos(2.0 * std::numbers::pi * b)
                  : first + a * (second - first);
  }
};

Distribution distribution_of(std::string_view text, const std::string& whole) {
  const std::size_t open = text.find('(');
  const std::size_t comma = text.find(',');
  const std::string_view kind = text.substr(0, open);
  if (open == std::string_view::npos || comma == std::string_view::npos || text.back() != ')' ||
      (kind != "normal" && kind != "uniform")) {
    refuse(
        fmt::format("--draw {} states no distribution.", whole),
        "write normal(mean,deviation) or uniform(low,high), in quotes of the shell: --draw 'INV.C1=normal(0.2,0.01)'.");
  }
  const Distribution found{
      .normal = kind == "normal",
      .first = number_in(text.substr(open + 1, comma - open - 1), whole, "--draw", draw_example),
      .second = number_in(text.substr(comma + 1, text.size() - comma - 2), whole, "--draw", draw_example)};
  if (found.normal && found.second < 0.0) {
    refuse(fmt::format("--draw {}: a deviation is not below 0.", whole), "write normal(mean,deviation).");
  }
  if (!found.normal && found.second < found.first) {
    refuse(fmt::format("--draw {}: the range ends before it begins.", whole), "write uniform(low,high).");
  }
  return found;
}

Table draws_of(const SetOptions& options) {
  if (!options.count || *options.count == 0 || *options.count > most_sets) {
    refuse("It is not said how many sets to draw.", fmt::format("write --sets N, from 1 to {}.", most_sets));
  }
  Table table{.places = {Place{}}};
  std::vector<Distribution> distributions;
  for (const std::string& draw : options.draws) {
    const auto [path, text] = named(draw, "--draw", draw_example);
    table.paths.push_back(path);
    distributions.push_back(distribution_of(text, draw));
  }
  std::mt19937_64 random(options.seed);
  const auto uniform = [&] { return (static_cast<double>(random() >> 11) + 0.5) * 0x1p-53; };
  for (std::uint64_t i = 0; i < *options.count; ++i) {
    std::vector<double> row;
    for (const Distribution& one : distributions) {
      const double a = uniform();
      row.push_back(one(a, uniform()));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table table_of(const SetOptions& options) {
  const int kinds = static_cast<int>(!options.file.empty()) + static_cast<int>(!options.sweeps.empty()) +
                    static_cast<int>(!options.draws.empty());
  if (kinds != 1) {
    refuse(kinds == 0 ? "It is not said which sets to run." : "Sets come from a table, from sweeps or from draws.",
           "write one of --batch SETS.csv, --sweep and --draw.");
  }
  if (options.count && options.draws.empty()) {
    refuse("A number of sets is one of draws.", "write --draw, or leave out --sets.");
  }
  Table table = !options.file.empty()     ? table_of_file(options.file)
                : !options.sweeps.empty() ? grid_of(options.sweeps)
                                          : draws_of(options);
  if (options.file.empty()) {
    for (std::size_t i = 0; i < table.paths.size(); ++i) {
      const auto begin = table.paths.begin();
      if (std::find(begin, begin + static_cast<std::ptrdiff_t>(i), table.paths[i]) !=
          begin + static_cast<std::ptrdiff_t>(i)) {
        refuse(fmt::format("{} is varied twice.", table.paths[i]), "leave one of the two out.");
      }
    }
  }
  if (table.rows.size() > most_sets) {
    throw InputError(error::bad_usage, {.file = options.file},
                     fmt::format("The table has {} sets; {} are the most.", table.rows.size(), most_sets),
                     "take the table apart.");
  }
  return table;
}

// --- in the diagram --------------------------------------------------------------------------------------------------

parameters::Value value_for(const Graph& graph, const std::string& path, double number) {
  const std::int64_t found = find_parameter(graph, path);
  return found < 0 ? parameters::Value(number)
                   : parameters::value_for(graph.parameters[static_cast<std::size_t>(found)].field, number);
}

/// A set gives one number to each path. What takes another value is said before any set is run, with what to write.
void check_types(const Table& table, const SetOptions& options, const Graph& graph) {
  const std::string source = !options.file.empty() ? "a column" : !options.sweeps.empty() ? "--sweep" : "--draw";
  for (std::size_t k = 0; k < table.paths.size(); ++k) {
    const std::string& path = table.paths[k];
    const auto wrong = [&](const Place& place, std::string cause, std::string mend) {
      throw InputError(error::wrong_value_type, place, std::move(cause), std::move(mend));
    };
    const Place& first = table.places.front();
    const bool is_vector = std::ranges::any_of(graph.parameters, [&](const Parameter& one) {
      const auto element = element_of(one.path);
      return element && equal_ignoring_case(element->vector, path);
    });
    if (is_vector) {
      wrong(first, fmt::format("{} is a vector, and {} gives one number.", path, source),
            fmt::format("vary its elements one by one: {}.",
                        !options.file.empty()     ? fmt::format("a column {}[0]", path)
                        : !options.sweeps.empty() ? fmt::format("--sweep '{}[0]=0.1..0.3/21'", path)
                                                  : fmt::format("--draw '{}[0]=normal(0.2,0.01)'", path)));
    }
    const std::int64_t found = find_parameter(graph, path);
    if (found < 0) {
      continue;  // said where the values are applied
    }
    const Field& field = graph.parameters[static_cast<std::size_t>(found)].field;
    if (field.length > 1) {
      wrong(first, fmt::format("{} is a list of numbers, and {} gives one number.", path, source),
            "write the lists into parameter files, and run the diagram once with each: --params P.toml.");
    }
    for (std::size_t i = 0; field.type != Type::Real && i < table.rows.size(); ++i) {
      const double number = table.rows[i][k];
      if (std::holds_alternative<double>(parameters::value_for(field, number))) {
        wrong(table.place_of(i),
              fmt::format("{} takes {}, and {} gives it {}.", path,
                          field.type == Type::Bool ? "TRUE or FALSE, as 1 or 0" : "whole numbers", source,
                          number_text(number)),
              options.file.empty() && !options.sweeps.empty()
                  ? fmt::format("choose range and count so that all values are such: --sweep {}={}.", path,
                                field.type == Type::Bool ? "0..1/2" : "1..5/5")
                  : "write such a value, or vary it in a table: --batch SETS.csv.");
      }
    }
  }
}

std::vector<double> all_values(const Graph& graph) {
  std::vector<double> values;
  for (const Parameter& one : graph.parameters) {
    values.insert(values.end(), one.value.begin(), one.value.end());
  }
  return values;
}

}  // namespace

ParameterSets parameter_sets(const SetOptions& options, const Graph& graph) {
  Table table = table_of(options);
  check_types(table, options, graph);
  ParameterSets sets{.paths = std::move(table.paths), .rows = std::move(table.rows)};
  Graph set = graph;
  for (std::size_t i = 0; i < sets.rows.size(); ++i) {
    const Place& place = table.place_of(i);
    parameters::ParameterFile file{.file = options.file};
    for (std::size_t k = 0; k < sets.paths.size(); ++k) {
      file.values.push_back({.path = sets.paths[k],
                             .value = value_for(graph, sets.paths[k], sets.rows[i][k]),
                             .place = place,
                             .value_place = place});
    }
    parameters::apply(file, set);
    sets.whole.push_back(all_values(set));
  }
  return sets;
}

}  // namespace hysteron::tool
