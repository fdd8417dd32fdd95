#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <tuple>
#include <utility>

#include "codegen/parameters/goal_reader.hpp"
#include "codegen/parameters/parameter_file.hpp"
#include "codegen/parameters/parameter_names.hpp"
#include "codegen/parameters/settings_reader.hpp"
#include "codegen/parameters/toml_comments.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"
#include "support/numbers.hpp"
#include "support/text_file.hpp"
#include "support/toml_text.hpp"

namespace hysteron::parameters {
namespace {

/// Instances inside instances. Further down is no diagram but an attack on the stack.
constexpr int most_levels = 64;

constexpr std::array<std::string_view, 7> top_keys{"parameters", "initial",  "fit",   "tune",
                                                   "goal",       "diagnose", "record"};
constexpr std::array<std::string_view, 4> fit_keys{"min", "max", "start", "scale"};
constexpr std::array<std::string_view, 5> tune_keys{"outputs", "loss", "train", "test", "initial_states"};
/// In the order of Loss.
constexpr std::array<std::string_view, 2> losses{"squares", "huber"};
constexpr std::array<std::string_view, 1> diagnose_keys{"ignore"};
constexpr std::array<std::string_view, 8> record_keys{"time", "rate",    "skip",     "range",
                                                      "rows", "decimal", "resample", "columns"};
/// Below [fit], in small letters: an instance of that name is written in capitals.
constexpr std::string_view by_record = "record";

constexpr TomlKind parameter_file{error::parameter_file_syntax, error::duplicate_key,
                                  "a table as [parameters.INV] and a value as C1 = 0.05"};

template <class Item>
void sort_by_place(std::vector<Item>& items) {
  std::stable_sort(items.begin(), items.end(), [](const Item& a, const Item& b) {
    return std::tie(a.place.line, a.place.column) < std::tie(b.place.line, b.place.column);
  });
}

/// What is read and said, before the reader that refers to it.
class Reading {
 protected:
  ParameterFile result_{};
  Diagnostics found_{};
};

class Reader : private Reading, private SettingsReader {
 public:
  Reader(const std::string& file, std::string_view text)
      : SettingsReader(result_.file, found_), root_(parse_toml(file, text, parameter_file)) {
    result_.file = file;
    result_.comments = comments_of(text);
  }

  ParameterFile read() {
    for (const auto& [key, node] : root_) {
      if (const auto* const table = known_key(key, node, top_keys, "") ? as_table(key, node) : nullptr) {
        if (key.str() == "parameters") {
          read_values(*table, "", 0, result_.values);
        } else if (key.str() == "initial") {
          read_values(*table, "", 0, result_.initial);
        } else if (key.str() == "fit") {
          read_fits(*table, "", 0, false);
        } else if (key.str() == "tune") {
          read_tune(*table);
        } else if (key.str() == "goal") {
          result_.goal = read_goal(*table, at(key), result_.file, diagnostics_);
        } else if (key.str() == "diagnose") {
          read_diagnose(*table);
        } else {
          read_record(*table);
        }
      }
    }
    sort_by_place(result_.values);
    sort_by_place(result_.initial);
    sort_by_place(result_.fits);
    refuse_doubles(result_.values);
    refuse_doubles(result_.initial);
    refuse_doubles(result_.fits);
    for (const FitSetting& fit : result_.fits) {
      check_range(fit);
    }
    if (diagnostics_.has_errors()) {
      throw InputError(diagnostics_);
    }
    return std::move(result_);
  }

 private:
  // ---- keys -------------------------------------------------------------------------------------------------------

  /// The path of a key below a path; nothing, with an error, where it cannot be that of an instance or parameter.
  std::optional<std::string> path_below(const std::string& path, const toml::key& key, int level) {
    if (!is_path(key.str())) {
      diagnostics_.error(error::unknown_key, at(key),
                         fmt::format("\"{}\" is no name of an instance or parameter.", key.str()),
                         "use letters, digits and _, as in the diagram.");
      return std::nullopt;
    }
    if (level > most_levels) {
      diagnostics_.error(error::parameter_file_syntax, at(key),
                         fmt::format("The tables are nested more than {} deep.", most_levels),
                         "nest instances less deeply.");
      return std::nullopt;
    }
    return path.empty() ? std::string(key.str()) : fmt::format("{}.{}", path, key.str());
  }

  template <class Item>
  void refuse_doubles(const std::vector<Item>& items) {
    std::map<std::string, const Item*> seen;
    for (const Item& item : items) {
      const auto [first, fresh] = seen.emplace(in_capitals(item.path), &item);
      if (!fresh) {
        diagnostics_.error(error::duplicate_key, item.place, fmt::format("{} has been given before.", item.path),
                           "keep one of the two; case makes no difference.",
                           {{.place = first->second->place, .text = "the first"}});
      }
    }
  }

  // ---- values -----------------------------------------------------------------------------------------------------

  void read_values(const toml::table& table, const std::string& path, int level, std::vector<ParameterValue>& values) {
    for (const auto& [key, node] : table) {
      const auto below = path_below(path, key, level);
      if (!below) {
        continue;
      }
      if (const auto* const instance = node.as_table()) {
        read_values(*instance, *below, level + 1, values);
      } else if (auto value = value_of(key, node)) {
        values.push_back({.path = *below, .value = std::move(*value), .place = at(key), .value_place = at(node)});
      }
    }
  }

  std::optional<Value> value_of(const toml::key& key, const toml::node& node) {
    constexpr std::string_view wanted = "a number, true or false, or a list of numbers";
    if (const auto* const truth = node.as_boolean()) {
      return truth->get();
    }
    if (const auto* const whole = node.as_integer()) {
      return whole->get();
    }
    if (node.is_floating_point()) {
      const auto number = finite(key, node);
      return number ? std::optional<Value>(number->value) : std::nullopt;
    }
    const auto* const list = node.as_array();
    if (list == nullptr || list->empty()) {
      wrong_type(key, node, wanted, fmt::format("{0} = 0.05, or {0} = [0.0, 0.5, 1.0]", key.str()));
      return std::nullopt;
    }
    if (list->is_homogeneous(toml::node_type::boolean)) {
      std::vector<bool> truths;
      for (const toml::node& element : *list) {
        truths.push_back(element.as_boolean()->get());
      }
      return truths;
    }
    std::vector<double> numbers;
    for (const toml::node& element : *list) {
      if (!element.is_number()) {
        wrong_element(key, element, "a number", fmt::format("{} = [0.0, 0.5, 1.0]", key.str()));
        return std::nullopt;
      }
      const auto number = finite(key, element);
      if (!number) {
        return std::nullopt;
      }
      numbers.push_back(number->value);
    }
    return numbers;
  }

  // ---- fit --------------------------------------------------------------------------------------------------------

  /// A table below [fit] is a parameter where it is empty or has a setting, be it mistyped; else it is an instance.
  static bool is_parameter(const toml::table& table) {
    return table.empty() || std::any_of(table.cbegin(), table.cend(), [](const auto& entry) {
             return !entry.second.is_table() && !nearest_name(entry.first.str(), fit_keys).empty();
           });
  }

  void read_fits(const toml::table& table, const std::string& path, int level, bool each_record) {
    for (const auto& [key, node] : table) {
      const auto below = path_below(path, key, level);
      if (!below) {
        continue;
      }
      const auto* const inner = node.as_table();
      if (inner != nullptr && path.empty() && !each_record && key.str() == by_record) {
        read_fits(*inner, "", level + 1, true);
        continue;
      }
      if (inner == nullptr) {
        diagnostics_.error(error::wrong_value_type, at(node),
                           fmt::format("{} must be a table of settings, but is {}.", *below, toml_kind(node)),
                           fmt::format("write {} = {{}}, or {} = {{min = 0.0, max = 1.0}}.", key.str(), key.str()));
        continue;
      }
      if (is_parameter(*inner)) {
        read_fit(*inner, *below, at(key), each_record);
      } else {
        read_fits(*inner, *below, level + 1, each_record);
      }
    }
  }

  void read_fit(const toml::table& table, const std::string& path, const Place& place, bool each_record) {
    FitSetting fit{.path = path, .place = place, .by_record = each_record};
    for (const auto& [key, node] : table) {
      if (!known_key(key, node, fit_keys, "the fit of " + path)) {
        continue;
      }
      if (key.str() == "min" || key.str() == "max") {
        const bool low = key.str() == "min";
        auto bound = number_of(key, node);
        if (bound && !std::isfinite(bound->value) && bound->value != (low ? -infinity : infinity)) {
          not_finite(key, *bound, "write a finite number, or leave the key out where there is no bound.");
          bound.reset();
        }
        (low ? fit.minimum : fit.maximum) = bound;
      } else {
        (key.str() == "start" ? fit.start : fit.scale) = finite(key, node);
      }
    }
    result_.fits.push_back(std::move(fit));
  }

  void check_range(const FitSetting& fit) {
    if (fit.scale && !(fit.scale->value > 0.0)) {
      contradiction(fit.scale->place, fmt::format("The scale of {} is not above 0.", fit.path),
                    "write the size of a notable change of the parameter, or leave it out.");
    }
    if (fit.minimum && fit.maximum && !(fit.minimum->value < fit.maximum->value)) {
      contradiction(fit.maximum->place, fmt::format("The max of {} is not above its min.", fit.path),
                    "exchange the two, or remove the parameter from the fit where it is known.");
      return;
    }
    std::optional<PlacedNumber> start = fit.start;
    if (const auto* const given = start ? nullptr : result_.find(fit.path)) {
      if (const auto* const real = std::get_if<double>(&given->value)) {
        start = PlacedNumber{.value = *real, .place = given->value_place};
      } else if (const auto* const whole = std::get_if<std::int64_t>(&given->value)) {
        start = PlacedNumber{.value = static_cast<double>(*whole), .place = given->value_place};
      }
    }
    const bool outside = start && ((fit.minimum && start->value < fit.minimum->value) ||
                                   (fit.maximum && start->value > fit.maximum->value));
    if (outside) {
      const auto bound = [](const std::optional<PlacedNumber>& number, std::string_view none) {
        return number ? number_text(number->value) : std::string(none);
      };
      contradiction(start->place,
                    fmt::format("The fit of {} would start at {}, outside of {} to {}.", fit.path,
                                number_text(start->value), bound(fit.minimum, "-inf"), bound(fit.maximum, "inf")),
                    "widen the range, or start inside of it.");
    }
  }

  // ---- tune -------------------------------------------------------------------------------------------------------

  void read_tune(const toml::table& table) {
    for (const auto& [key, node] : table) {
      if (!known_key(key, node, tune_keys, "[tune]")) {
        continue;
      }
      if (key.str() == "outputs") {
        result_.tune.outputs = names_of(key, node, R"(outputs = ["Y"])", is_path);
      } else if (key.str() == "initial_states") {
        result_.tune.initial_states = names_of(key, node, R"(initial_states = ["LAG.XOUT"])", is_path);
      } else if (key.str() == "loss") {
        const auto loss = word_of(key, node, losses);
        result_.tune.loss = loss == 1U ? Loss::Huber : Loss::Squares;
      } else {
        (key.str() == "train" ? result_.tune.train : result_.tune.test) = intervals_of(key, node);
      }
    }
    refuse_shared_intervals();
  }

  void read_diagnose(const toml::table& table) {
    for (const auto& [key, node] : table) {
      if (known_key(key, node, diagnose_keys, "[diagnose]")) {
        result_.diagnose.ignore = names_of(key, node, R"(ignore = ["SP"])", is_column);
      }
    }
  }

  void read_record(const toml::table& table) {
    for (const auto& [key, node] : table) {
      if (!known_key(key, node, record_keys, "[record]")) {
        continue;
      }
      if (const auto* const ways = key.str() == "resample" ? node.as_table() : nullptr) {
        read_ways(*ways);
      } else if (key.str() != "columns") {
        take_setting(key, node, result_.record.settings);
      } else if (const auto* const columns = as_table(key, node)) {
        for (const auto& [name, column] : *columns) {
          take_setting(name, column, result_.record.columns);
        }
      }
    }
  }

  /// {Q = "hold", "*" = "linear"}: as the option repeated, Q=hold and linear, in the order of the file.
  void read_ways(const toml::table& table) {
    const std::size_t first = result_.record.settings.size();
    for (const auto& [name, way] : table) {
      const bool is_of_others = name.str() == "*";
      if (!way.is_string()) {
        wrong_type(name, way, "a text", fmt::format("{} = \"hold\"", is_of_others ? "\"*\"" : name.str()));
      } else if (is_of_others || is_column(name.str())) {
        const std::string text = *way.value<std::string>();
        result_.record.settings.push_back(
            {.key = "resample",
             .value = {.text = is_of_others ? text : fmt::format("{}={}", name.str(), text), .place = at(way)}});
      } else {
        no_signal(name);
      }
    }
    std::sort(result_.record.settings.begin() + static_cast<std::ptrdiff_t>(first), result_.record.settings.end(),
              [](const auto& a, const auto& b) {
                return std::tie(a.value.place.line, a.value.place.column) <
                       std::tie(b.value.place.line, b.value.place.column);
              });
  }

  void no_signal(const toml::key& key) {
    diagnostics_.error(error::unknown_key, at(key), fmt::format("\"{}\" is no name of a signal.", key.str()),
                       "use letters, digits and _, as in the diagram.");
  }

  void take_setting(const toml::key& key, const toml::node& node, std::vector<RecordSettings::Setting>& settings) {
    const auto text = node.is_string() ? node.value<std::string>() : std::nullopt;
    const auto whole = node.is_integer() ? node.value<std::int64_t>() : std::nullopt;
    const bool plain = text && std::ranges::none_of(*text, [](char c) { return c >= 0 && c < ' '; });
    if (!plain && !(whole && !text)) {
      wrong_type(key, node, "a text", fmt::format("{} = \"...\"", key.str()));
    } else if (is_path(key.str())) {
      settings.push_back(
          {.key = std::string(key.str()), .value = {.text = text ? *text : std::to_string(*whole), .place = at(node)}});
    } else {
      no_signal(key);
    }
  }

  /// [1.0, 21.0], or a list of such.
  std::vector<Interval> intervals_of(const toml::key& key, const toml::node& node) {
    std::vector<Interval> intervals;
    const auto* const list = node.as_array();
    const bool many = list != nullptr && !list->empty() && list->front().is_array();
    if (many) {
      for (const toml::node& element : *list) {
        add_interval(intervals, key, element);
      }
    } else {
      add_interval(intervals, key, node);
    }
    std::stable_sort(intervals.begin(), intervals.end(),
                     [](const Interval& a, const Interval& b) { return a.begin < b.begin; });
    for (std::size_t i = 1; i < intervals.size(); ++i) {
      if (intervals[i].begin < intervals[i - 1].end) {
        contradiction(intervals[i].place, fmt::format("Two intervals of {} overlap.", key.str()),
                      "join them, so that no sample counts twice.");
      }
    }
    return intervals;
  }

  /// A sample that was fitted tells nothing of the rest.
  void refuse_shared_intervals() {
    for (const Interval& test : result_.tune.test) {
      for (const Interval& train : result_.tune.train) {
        if (test.begin < train.end && train.begin < test.end) {
          contradiction(test.place, "Intervals of test and train overlap.",
                        "end one where the other begins: a test on what was fitted says nothing.");
          return;
        }
      }
    }
  }

  void add_interval(std::vector<Interval>& intervals, const toml::key& key, const toml::node& node) {
    const auto* const pair = node.as_array();
    if (pair == nullptr || pair->size() != 2 || !pair->front().is_number() || !pair->back().is_number()) {
      const auto example = fmt::format("{0} = [1.0, 21.0], or {0} = [[1.0, 9.0], [12.0, 21.0]]", key.str());
      if (pair == nullptr || pair->empty()) {
        wrong_type(key, node, "an interval of two numbers, or a list of such", example);
      } else {
        diagnostics_.error(error::wrong_value_type, at(node),
                           fmt::format("An interval of {} has two numbers, but here is a list of {}.", key.str(),
                                       pair->size() == 1 ? "one value" : fmt::format("{} values", pair->size())),
                           fmt::format("write it as in {}.", example));
      }
      return;
    }
    const auto begin = finite(key, pair->front());
    const auto end = finite(key, pair->back());
    if (begin && end) {
      if (!(begin->value < end->value)) {
        contradiction(at(node), fmt::format("The interval of {} ends before it begins.", key.str()),
                      "exchange the two times.");
        return;
      }
      intervals.push_back({.begin = begin->value, .end = end->value, .place = at(node)});
    }
  }

  toml::table root_;
};

}  // namespace

ParameterFile parse_parameter_file(const std::string& file, std::string_view text) {
  return Reader(file, text).read();
}

ParameterFile read_parameter_file(const std::string& path) {
  return parse_parameter_file(path, read_text_file(path));
}

}  // namespace hysteron::parameters
