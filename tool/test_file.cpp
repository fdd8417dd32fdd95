#include "tool/test_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <tuple>
#include <utility>

#include "support/errors.hpp"
#include "support/names.hpp"
#include "support/text_file.hpp"
#include "support/toml_text.hpp"
#include "support/whole_number.hpp"

namespace hysteron::tool {
namespace {

constexpr std::array<std::string_view, 12> case_keys{"name",   "block",  "params", "float32", "steps", "csv",
                                                     "inputs", "expect", "golden", "abs",     "rel",   "doc"};
/// As many steps as a day has at 1 ms; a mistyped number would fill the memory.
constexpr std::int64_t most_steps = 86'400'000;
constexpr double float32_relative = 1e-5;
constexpr TomlKind test_file{error::test_file_syntax, error::test_file_syntax,
                             "a case as [[case]] and its settings as steps = 10"};

/// A step as a key: 0, 5, 100.
std::optional<std::size_t> step_of(std::string_view key) {
  return whole_number<std::size_t>(key, 0, most_steps - 1);
}

/// In the order of the file; the library gives keys in that of their names.
Diagnostics sorted(const Diagnostics& found) {
  auto list = found.all();
  std::stable_sort(list.begin(), list.end(), [](const Diagnostic& a, const Diagnostic& b) {
    return std::tie(a.place.line, a.place.column) < std::tie(b.place.line, b.place.column);
  });
  Diagnostics result;
  for (Diagnostic& one : list) {
    result.add(std::move(one));
  }
  return result;
}

class Reader {
 public:
  Reader(const std::string& file, std::string_view text) : root_(parse_toml(file, text, test_file)) {
    result_.path = file;
  }

  TestFile read() {
    for (const auto& [key, node] : root_) {
      if (key.str() != "case") {
        diagnostics_.error(error::unknown_test_key, at(key),
                           fmt::format("There is no key {} in a test file.", key.str()),
                           "open each case by [[case]], and write its settings below.");
      } else if (const auto* const list = node.as_array(); list != nullptr && list->is_homogeneous<toml::table>()) {
        for (const toml::node& one : *list) {
          read_case(*one.as_table());
        }
      } else {
        wrong(node, "case", "a list of tables", "[[case]], with two brackets on each side");
      }
    }
    if (result_.cases.empty() && !diagnostics_.has_errors()) {
      diagnostics_.error(error::unusable_test, {.file = result_.path}, "The file has no test case.",
                         "open a case by [[case]], and write its settings below.");
    }
    refuse_doubles();
    if (diagnostics_.has_errors()) {
      throw InputError(sorted(diagnostics_));
    }
    return std::move(result_);
  }

 private:
  [[nodiscard]] Place at(const toml::node& node) const { return place_of(result_.path, node.source()); }
  [[nodiscard]] Place at(const toml::key& key) const { return place_of(result_.path, key.source()); }

  void wrong(const toml::node& node, std::string_view what, std::string_view wanted, std::string_view example) {
    diagnostics_.error(error::wrong_test_value, at(node), fmt::format("{} must be {}.", what, wanted),
                       fmt::format("write it as {}.", example));
  }

  void read_case(const toml::table& table) {
    TestCase one;
    one.place = at(table);
    bool has_relative = false;
    for (const auto& [key, node] : table) {
      const auto name = key.str();
      if (name == "name") {
        one.name = text_of(key, node, "name = \"a step passes\"").text;
      } else if (name == "doc") {
        (void)text_of(key, node, "doc = \"what the case is for\"");
      } else if (name == "block") {
        one.block = text_of(key, node, "block = \"PLANT\"");
      } else if (name == "csv") {
        one.csv = text_of(key, node, "csv = \"log.csv\"");
      } else if (name == "golden") {
        one.golden = text_of(key, node, "golden = \"plant.step.csv\"");
      } else if (name == "float32") {
        one.float32 = node.value_or(false);
        if (!node.is_boolean()) {
          wrong(node, name, "true or false", "float32 = true");
        }
      } else if (name == "steps") {
        read_steps(node, one);
      } else if (name == "abs" || name == "rel") {
        has_relative = has_relative || name == "rel";
        read_tolerance(key, node, name == "abs" ? one.absolute : one.relative);
      } else if (name == "params") {
        read_parameters(key, node, one);
      } else if (name == "inputs") {
        read_signals(key, node, true, one.inputs);
      } else if (name == "expect") {
        read_signals(key, node, false, one.expected);
      } else {
        const auto near = nearest_name(name, case_keys);
        diagnostics_.error(error::unknown_test_key, at(key), fmt::format("There is no key {} in a test case.", name),
                           near.empty() ? fmt::format("use one of {}.", fmt::join(case_keys, ", "))
                                        : fmt::format("did you mean {}?", near));
      }
    }
    if (one.name.empty()) {
      diagnostics_.error(error::unusable_test, one.place, "The case has no name.",
                         "give it one: name = \"a step passes\".");
    }
    if (one.expected.empty() && one.golden.text.empty() && !table.contains("expect") && !table.contains("golden")) {
      diagnostics_.error(error::unusable_test, one.place, fmt::format("The case \"{}\" checks nothing.", one.name),
                         "say what is expected, expect = {Y = 1.0}, or name a record, golden = \"NAME.csv\".");
    }
    if (one.float32 && !has_relative) {
      one.relative = float32_relative;
    }
    result_.cases.push_back(std::move(one));
  }

  TestText text_of(const toml::key& key, const toml::node& node, std::string_view example) {
    const auto* const text = node.as_string();
    if (text == nullptr || text->get().empty()) {
      wrong(node, key.str(), "a text", example);
      return {};
    }
    return {.text = text->get(), .place = at(node)};
  }

  void read_steps(const toml::node& node, TestCase& one) {
    const auto* const whole = node.as_integer();
    if (whole == nullptr || whole->get() < 1 || whole->get() > most_steps) {
      wrong(node, "steps", fmt::format("a whole number from 1 to {}", most_steps), "steps = 100");
      return;
    }
    one.steps = static_cast<std::size_t>(whole->get());
  }

  void read_tolerance(const toml::key& key, const toml::node& node, double& tolerance) {
    const auto number = node.is_number() ? node.value<double>() : std::nullopt;
    if (!number || !(*number >= 0.0) || !std::isfinite(*number)) {
      wrong(node, key.str(), "a number, 0 or above", fmt::format("{} = 1e-9", key.str()));
      return;
    }
    tolerance = *number;
  }

  // ---- parameters -------------------------------------------------------------------------------------------------

  void read_parameters(const toml::key& key, const toml::node& node, TestCase& one) {
    if (node.is_string()) {
      one.parameter_file = text_of(key, node, "params = \"tuned.toml\"");
    } else if (const auto* const table = node.as_table()) {
      read_parameter_table(*table, "", one);
    } else {
      wrong(node, key.str(), "a table, or the name of a parameter file",
            "params = {INV = {C1 = 0.05}}, or params = \"tuned.toml\"");
    }
  }

  void read_parameter_table(const toml::table& table, const std::string& path, TestCase& one) {
    for (const auto& [key, node] : table) {
      const auto below = path.empty() ? std::string(key.str()) : fmt::format("{}.{}", path, key.str());
      if (const auto* const inner = node.as_table()) {
        read_parameter_table(*inner, below, one);
        continue;
      }
      parameters::ParameterValue value{.path = below, .place = at(key), .value_place = at(node)};
      if (const auto* const truth = node.as_boolean()) {
        value.value = truth->get();
      } else if (const auto* const whole = node.as_integer()) {
        value.value = whole->get();
      } else if (const auto number = finite(node)) {
        value.value = *number;
      } else if (auto list = numbers_of(node)) {
        value.value = std::move(*list);
      } else {
        wrong(node, below, "a finite number, true or false, or a list of numbers", fmt::format("{} = 0.05", key.str()));
        continue;
      }
      one.parameters.push_back(std::move(value));
    }
  }

  // ---- signals ----------------------------------------------------------------------------------------------------

  /// A number; true and false are 1 and 0.
  static std::optional<double> finite(const toml::node& node) {
    if (const auto* const truth = node.as_boolean()) {
      return truth->get() ? 1.0 : 0.0;
    }
    const auto number = node.is_number() ? node.value<double>() : std::nullopt;
    return number && std::isfinite(*number) ? number : std::nullopt;
  }

  static std::optional<std::vector<double>> numbers_of(const toml::node& node) {
    const auto* const list = node.as_array();
    if (list == nullptr || list->empty()) {
      return std::nullopt;
    }
    std::vector<double> numbers;
    for (const toml::node& element : *list) {
      const auto number = finite(element);
      if (!number) {
        return std::nullopt;
      }
      numbers.push_back(*number);
    }
    return numbers;
  }

  void read_signals(const toml::key& key, const toml::node& node, bool ramps, std::vector<TestSignal>& signals) {
    const auto* const table = node.as_table();
    if (table == nullptr || (table->empty() && !ramps)) {
      wrong(node, key.str(), ramps ? "a table of inputs" : "a table of outputs, and not empty",
            fmt::format("{} = {{{} = 1.0}}", key.str(), ramps ? "X" : "Y"));
      return;
    }
    for (const auto& [name, value] : *table) {
      TestSignal signal{.name = std::string(name.str()), .place = at(name), .value_place = at(value)};
      if (const auto number = finite(value)) {
        signal.values = *number;
      } else if (auto list = numbers_of(value)) {
        signal.values = std::move(*list);
      } else if (const auto* const inner = value.as_table();
                 inner == nullptr || !read_steps_of(*inner, ramps, signal)) {
        wrong(value, signal.name,
              ramps ? "a number, a list of one number for each step, values by step, or a ramp"
                    : "a number, a list of one number for each step, or values by step",
              ramps ? fmt::format("{0} = 1.0, {0} = [0.0, 1.0], {0} = {{0 = 0.0, 5 = 1.0}} or {0} = {{from = 0.0, to = "
                                  "1.0}}",
                                  signal.name)
                    : fmt::format("{0} = 1.0, {0} = [0.0, 1.0] or {0} = {{5 = 1.0}}", signal.name));
        continue;
      }
      signals.push_back(std::move(signal));
    }
  }

  static bool read_steps_of(const toml::table& table, bool ramps, TestSignal& signal) {
    if (ramps && table.size() == 2 && table.contains("from") && table.contains("to")) {
      const auto from = finite(*table.get("from"));
      const auto to = finite(*table.get("to"));
      signal.values = Ramp{.from = from.value_or(0.0), .to = to.value_or(0.0)};
      return from && to;
    }
    ValuesByStep values;
    for (const auto& [key, node] : table) {
      const auto step = step_of(key.str());
      const auto number = finite(node);
      if (!step || !number) {
        return false;
      }
      values[*step] = *number;
    }
    signal.values = std::move(values);
    return !table.empty();
  }

  void refuse_doubles() {
    std::map<std::string, const TestCase*> seen;
    for (const TestCase& one : result_.cases) {
      const auto [first, fresh] = seen.emplace(one.name, &one);
      if (!fresh && !one.name.empty()) {
        diagnostics_.error(error::unusable_test, one.place, fmt::format("Two cases are named \"{}\".", one.name),
                           "give each case a name of its own.", {{.place = first->second->place, .text = "the first"}});
      }
    }
  }

  toml::table root_;
  TestFile result_;
  Diagnostics diagnostics_;
};

}  // namespace

TestFile parse_test_file(const std::string& file, std::string_view text) {
  return Reader(file, text).read();
}

TestFile read_test_file(const std::string& path) {
  return parse_test_file(path, read_text_file(path));
}

}  // namespace hysteron::tool
