#include "runtime/web/metrics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

#include "support/utf8.hpp"

namespace hysteron::runtime::web {
namespace {

/// Before the name of a point, and before the name as a sentence has it. The names of a status begin with task already.
struct KindWords {
  std::string_view prefix;
  std::string_view phrase;
};

KindWords words_of(PointKind kind) {
  switch (kind) {
    case PointKind::input:
      return {"input_", "the input "};
    case PointKind::output:
      return {"output_", "the output "};
    case PointKind::parameter:
      return {"parameter_", "the parameter "};
    case PointKind::status:
    case PointKind::command:
      break;
  }
  return {"", ""};
}

/// How many of a unit are a second; zero where it is no time.
double parts_of_second(std::string_view unit) {
  constexpr std::array<std::pair<std::string_view, double>, 4> units{
      {{"s", 1.0}, {"ms", 1e3}, {"us", 1e6}, {"ns", 1e9}}};
  const auto* const found = std::ranges::find(units, unit, &std::pair<std::string_view, double>::first);
  return found == units.end() ? 0.0 : found->second;
}

std::string metric_name(const Point& point) {
  std::string name = "hysteron_";
  name += words_of(point.kind).prefix;
  for (const char c : point.name) {
    const bool is_capital = c >= 'A' && c <= 'Z';
    const bool is_taken = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
    name += is_capital ? static_cast<char>(c - 'A' + 'a') : is_taken ? c : '_';
  }
  if (parts_of_second(point.unit) != 0.0) {
    name += "_seconds";
  }
  if (point.counts) {
    return name + "_total";
  }
  // These endings say what a metric is; a level that ends so by chance must not.
  constexpr std::array<std::string_view, 6> reserved{"_total", "_count", "_sum", "_bucket", "_info", "_created"};
  const bool is_reserved =
      std::ranges::any_of(reserved, [&](std::string_view ending) { return name.ends_with(ending); });
  return is_reserved ? name + "_value" : name;
}

/// The text of a help line, or of a label with its quotes escaped too. The format is UTF-8; what is not is replaced.
std::string escaped(std::string_view text, bool in_quotes) {
  std::string result;
  while (!text.empty()) {
    const std::size_t sound = std::min(first_invalid_utf8(text), text.size());
    for (const char c : text.substr(0, sound)) {
      if (c == '\n') {
        result += "\\n";
      } else {
        result += c == '\\' || (in_quotes && c == '"') ? "\\" : "";
        result += c;
      }
    }
    text.remove_prefix(sound);
    if (!text.empty()) {
      result += "\xEF\xBF\xBD";
      text.remove_prefix(1);
    }
  }
  return result;
}

std::string heading_of(const std::string& name, const Point& point) {
  const std::string help =
      point.meaning.empty() ? std::string(words_of(point.kind).phrase) + point.name : point.meaning;
  return fmt::format("# HELP {0} {1}\n# TYPE {0} {2}\n", name, escaped(help, false),
                     point.counts ? "counter" : "gauge");
}

std::string series_of(const std::string& name, const Point& point, bool is_time) {
  std::string series = fmt::format("{}{{point=\"{}\"", name, escaped(point.name, true));
  if (!is_time && !point.unit.empty() && point.unit != "1") {
    series += fmt::format(",unit=\"{}\"", escaped(point.unit, true));
  }
  return series + "}";
}

void add_value(std::string& text, double value) {
  if (std::isnan(value)) {
    text += "NaN";
  } else if (std::isinf(value)) {
    text += value < 0.0 ? "-Inf" : "+Inf";
  } else {
    fmt::format_to(std::back_inserter(text), "{}", value);
  }
}

}  // namespace

Metrics::Metrics(std::span<const Point> points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point& point = points[i];
    if (point.kind == PointKind::command) {
      continue;
    }
    const std::string name = metric_name(point);
    auto family = std::ranges::find(families_, name, &Family::name);
    if (family == families_.end()) {
      families_.push_back({.name = name, .heading = heading_of(name, point)});
      family = std::prev(families_.end());
    }
    const double parts = parts_of_second(point.unit);
    family->samples.push_back(
        {.point = i, .series = series_of(name, point, parts != 0.0), .divisor = parts == 0.0 ? 1.0 : parts});
  }
}

std::string Metrics::text(std::span<const double> values) const {
  std::string text;
  for (const Family& family : families_) {
    text += family.heading;
    for (const Sample& sample : family.samples) {
      text += sample.series;
      text += ' ';
      add_value(text, values[sample.point] / sample.divisor);
      text += '\n';
    }
  }
  return text;
}

}  // namespace hysteron::runtime::web
