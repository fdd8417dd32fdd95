#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "support/json_number.hpp"
#include "support/names.hpp"
#include "support/numbers.hpp"
#include "tool/comparison.hpp"

namespace hysteron::tool {
namespace {

using parameters::ParameterValue;

std::vector<double> numbers_of(const parameters::Value& value) {
  if (const auto* list = std::get_if<std::vector<double>>(&value)) {
    return *list;
  }
  if (const auto* truths = std::get_if<std::vector<bool>>(&value)) {
    return {truths->begin(), truths->end()};
  }
  if (const auto* real = std::get_if<double>(&value)) {
    return {*real};
  }
  if (const auto* whole = std::get_if<std::int64_t>(&value)) {
    return {static_cast<double>(*whole)};
  }
  return {std::get<bool>(value) ? 1.0 : 0.0};
}

std::string text_of(const parameters::Value& value) {
  if (const auto* truth = std::get_if<bool>(&value)) {
    return *truth ? "true" : "false";
  }
  std::vector<std::string> texts;
  for (const double number : numbers_of(value)) {
    texts.push_back(number_text(number));
  }
  return texts.size() == 1 ? texts.front() : fmt::format("[{}]", fmt::join(texts, ", "));
}

bool are_same(const parameters::Value& a, const parameters::Value& b, const Tolerance& tolerance) {
  if (std::holds_alternative<bool>(a) != std::holds_alternative<bool>(b)) {
    return false;
  }
  return std::ranges::equal(numbers_of(a), numbers_of(b), [&](double x, double y) { return tolerance.holds(x, y); });
}

/// A row a value, in the order of a, then what b alone has.
struct ParameterRow {
  std::string path;
  std::optional<parameters::Value> a{};
  std::optional<parameters::Value> b{};
};

void add_rows(std::vector<ParameterRow>& rows, std::span<const ParameterValue> a, std::span<const ParameterValue> b,
              const std::string& prefix) {
  const auto find = [](std::span<const ParameterValue> values,
                       const std::string& path) -> std::optional<parameters::Value> {
    const auto found =
        std::ranges::find_if(values, [&](const ParameterValue& one) { return equal_ignoring_case(one.path, path); });
    return found == values.end() ? std::nullopt : std::optional(found->value);
  };
  for (const ParameterValue& one : a) {
    rows.push_back({.path = prefix + one.path, .a = one.value, .b = find(b, one.path)});
  }
  for (const ParameterValue& one : b) {
    if (!find(a, one.path)) {
      rows.push_back({.path = prefix + one.path, .a = std::nullopt, .b = one.value});
    }
  }
}

/// In percent of the first; not finite where that is 0.
double change_of(double a, double b) {
  return 100.0 * (b - a) / std::abs(a);
}

}  // namespace

std::string change_text(double a, double b) {
  const double change = change_of(a, b);
  return std::isfinite(change) ? fmt::format("{:+.3g} %", change) : "–";
}

Comparison compare_parameters(const parameters::ParameterFile& a, const parameters::ParameterFile& b,
                              const Tolerance& tolerance) {
  std::vector<ParameterRow> rows;
  add_rows(rows, a.values, b.values, "");
  add_rows(rows, a.initial, b.initial, "initial ");
  Comparison result;
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  std::size_t same = 0;
  for (const ParameterRow& row : rows) {
    const bool is_same = row.a && row.b && are_same(*row.a, *row.b, tolerance);
    const bool has_change = row.a && row.b && numbers_of(*row.a).size() == 1 && numbers_of(*row.b).size() == 1;
    const double before = has_change ? numbers_of(*row.a).front() : not_a_number;
    const double after = has_change ? numbers_of(*row.b).front() : not_a_number;
    const double percent = change_of(before, after);
    const auto json_of = [](const std::optional<parameters::Value>& value) {
      return value ? nlohmann::ordered_json(text_of(*value)) : nlohmann::ordered_json();
    };
    list.push_back({{"name", row.path},
                    {"a", json_of(row.a)},
                    {"b", json_of(row.b)},
                    {"change_percent", number_or_null<nlohmann::ordered_json>(percent)},
                    {"same", is_same}});
    if (is_same) {
      ++same;
      continue;
    }
    result.same = false;
    if (row.a && row.b) {
      result.text += fmt::format("{}: {} -> {}{}\n", row.path, text_of(*row.a), text_of(*row.b),
                                 has_change ? fmt::format("  ({})", change_text(before, after)) : "");
    } else {
      result.text += fmt::format("{}: {}, only in {}\n", row.path, text_of(row.a ? *row.a : *row.b), row.a ? 'A' : 'B');
    }
  }
  result.text += fmt::format("{} of {} values are the same\n", same, rows.size());
  result.json["parameters"] = std::move(list);
  return result;
}

}  // namespace hysteron::tool
