#include "runtime/web/parameter_text.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <vector>

#include "support/element_name.hpp"
#include "support/numbers.hpp"

namespace hysteron::runtime::web {
namespace {

/// A parameter, or all elements of one that is a vector.
struct Entry {
  std::string path{};
  std::vector<std::string> texts{};
  bool is_vector = false;
  bool is_finite = true;
};

std::string text_of(const Point& point, double value) {
  if (point.type == PointType::boolean) {
    return value != 0.0 ? "true" : "false";
  }
  if (!std::isfinite(value)) {
    return {};
  }
  return is_real(point.type) ? real_literal(value) : number_text(value);
}

std::vector<Entry> entries_of(std::span<const Point> points, std::span<const double> values) {
  std::vector<Entry> entries;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].kind != PointKind::parameter) {
      continue;
    }
    const auto element = element_of(points[i].name);
    const std::string path(element ? element->vector : std::string_view(points[i].name));
    if (!element || entries.empty() || entries.back().path != path) {
      entries.push_back({.path = path, .is_vector = element.has_value()});
    }
    entries.back().is_finite = entries.back().is_finite && std::isfinite(values[i]);
    entries.back().texts.push_back(text_of(points[i], values[i]));
  }
  return entries;
}

}  // namespace

std::string parameter_text(const std::string& program, std::span<const Point> points, std::span<const double> values) {
  std::map<std::string, std::string> tables{{"", ""}};  // by instance; the first is the diagram itself
  for (const Entry& entry : entries_of(points, values)) {
    const auto dot = entry.path.rfind('.');
    const std::string instance = dot == std::string::npos ? "" : entry.path.substr(0, dot);
    const std::string name = dot == std::string::npos ? entry.path : entry.path.substr(dot + 1);
    std::string& lines = tables[instance];
    if (!entry.is_finite) {
      lines += fmt::format("# {} is not finite, and stays as the diagram has it\n", name);
    } else {
      const std::string text = fmt::format("{}", fmt::join(entry.texts, ", "));
      lines += fmt::format("{} = {}\n", name, entry.is_vector ? "[" + text + "]" : text);
    }
  }
  std::string text = fmt::format("# Parameters that counted in {} when this was saved.\n", program);
  for (const auto& [instance, lines] : tables) {
    if (!lines.empty()) {
      text += fmt::format("\n[parameters{}]\n{}", instance.empty() ? "" : "." + instance, lines);
    }
  }
  return text;
}

}  // namespace hysteron::runtime::web
