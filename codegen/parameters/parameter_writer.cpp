#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <utility>

#include "codegen/parameters/parameter_file.hpp"
#include "support/atomic_file.hpp"
#include "support/names.hpp"
#include "support/numbers.hpp"
#include "support/utf8.hpp"

namespace hysteron::parameters {
namespace {

std::string real_text(double value) {
  if (!std::isfinite(value)) {
    throw std::invalid_argument("a parameter file holds finite numbers");
  }
  return real_literal(value);
}

/// A bound may be infinite.
std::string bound_text(double value) {
  return std::isfinite(value) ? real_literal(value) : number_text(value);
}

std::string value_text(const Value& value) {
  if (const auto* const truth = std::get_if<bool>(&value)) {
    return *truth ? "true" : "false";
  }
  if (const auto* const whole = std::get_if<std::int64_t>(&value)) {
    return std::to_string(*whole);
  }
  if (const auto* const real = std::get_if<double>(&value)) {
    return real_text(*real);
  }
  std::string text = "[";
  for (const double element : std::get<std::vector<double>>(value)) {
    text += (text.size() > 1 ? ", " : "") + real_text(element);
  }
  return text + "]";
}

/// "INV.C1" as instance "INV" and name "C1".
std::pair<std::string, std::string> split(const std::string& path) {
  const auto dot = path.rfind('.');
  return dot == std::string::npos ? std::pair(std::string(), path)
                                  : std::pair(path.substr(0, dot), path.substr(dot + 1));
}

/// Lines by instance, in the order in which instances first appear; those of the diagram itself first, because a
/// table below ends the one above.
class Tables {
 public:
  void add(const std::string& path, std::string text, std::string comment = {}) {
    auto [instance, name] = split(path);
    const auto capitals = in_capitals(instance);
    if (!names_.insert(in_capitals(path)).second) {
      throw std::invalid_argument("two entries for " + path);
    }
    for (auto dot = capitals.find('.');; dot = capitals.find('.', dot + 1)) {
      instances_.insert(capitals.substr(0, dot));
      if (dot == std::string::npos) {
        break;
      }
    }
    auto table = std::find_if(tables_.begin(), tables_.end(),
                              [&](const Table& one) { return in_capitals(one.instance) == capitals; });
    if (table == tables_.end()) {
      table = tables_.insert(instance.empty() ? tables_.begin() : tables_.end(), Table{.instance = instance});
    }
    table->lines.emplace_back(name + " = " + std::move(text), std::move(comment));
  }

  [[nodiscard]] std::string text(std::string_view title) const {
    for (const auto& name : names_) {
      if (instances_.contains(name)) {
        throw std::invalid_argument(name + " is a value and an instance");
      }
    }
    std::string text;
    for (const Table& table : tables_) {
      text += fmt::format("\n[{}{}{}]\n", title, table.instance.empty() ? "" : ".", table.instance);
      std::size_t widest = 0;
      for (const auto& [line, comment] : table.lines) {
        widest = std::max(widest, comment.empty() ? 0 : line.size());
      }
      for (const auto& [line, comment] : table.lines) {
        text += comment.empty() ? line + "\n" : fmt::format("{:<{}}  # {}\n", line, widest, comment);
      }
    }
    return text;
  }

 private:
  struct Table {
    std::string instance{};
    std::vector<std::pair<std::string, std::string>> lines{};
  };

  std::vector<Table> tables_;
  std::set<std::string> names_;
  std::set<std::string> instances_;
};

std::string one_line(std::string_view text) {
  std::string line(text);
  std::replace_if(
      line.begin(), line.end(), [](char c) { return c == '\n' || c == '\r' || c == '\t'; }, ' ');
  return printable(line);
}

std::string comment_of(const Remark& remark) {
  std::string text = one_line(remark.unit);
  const auto append = [&](const std::string& part) { text += (text.empty() || part.empty() ? "" : ", ") + part; };
  append(one_line(remark.meaning));
  if (remark.standard_error) {
    append(fmt::format("standard error {:.2g}", *remark.standard_error));
  }
  return text;
}

std::string settings_of(const FitSetting& fit) {
  std::string text;
  const auto add = [&](std::string_view key, const std::optional<PlacedNumber>& number, bool bound) {
    if (number) {
      text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", key,
                          bound ? bound_text(number->value) : real_text(number->value));
    }
  };
  add("min", fit.minimum, true);
  add("max", fit.maximum, true);
  add("start", fit.start, false);
  add("scale", fit.scale, false);
  return "{" + text + "}";
}

std::string list_of(const std::vector<PlacedText>& names) {
  std::string text;
  for (const PlacedText& name : names) {
    text += fmt::format("{}\"{}\"", text.empty() ? "" : ", ", name.text);
  }
  return "[" + text + "]";
}

std::string list_of(const std::vector<Interval>& intervals) {
  std::string text;
  for (const Interval& interval : intervals) {
    text += fmt::format("{}[{}, {}]", text.empty() ? "" : ", ", real_text(interval.begin), real_text(interval.end));
  }
  return intervals.size() == 1 ? text : "[" + text + "]";
}

std::string tune_text(const TuneSettings& tune) {
  std::string text;
  if (!tune.outputs.empty()) {
    text += "outputs = " + list_of(tune.outputs) + "\n";
  }
  if (tune.loss == Loss::Huber) {
    text += "loss = \"huber\"\n";
  }
  if (!tune.train.empty()) {
    text += "train = " + list_of(tune.train) + "\n";
  }
  if (!tune.test.empty()) {
    text += "test = " + list_of(tune.test) + "\n";
  }
  if (!tune.initial_states.empty()) {
    text += "initial_states = " + list_of(tune.initial_states) + "\n";
  }
  return text.empty() ? text : "\n[tune]\n" + text;
}

}  // namespace

std::string parameter_text(const ParameterFile& file, const Remarks& remarks, std::string_view heading) {
  std::string text;
  while (!heading.empty()) {
    const auto end = heading.find('\n');
    const auto line = heading.substr(0, end);
    text += line.empty() ? "#\n" : "# " + one_line(line) + "\n";
    heading.remove_prefix(end == std::string_view::npos ? heading.size() : end + 1);
  }
  Tables values;
  for (const ParameterValue& value : file.values) {
    const auto remark = remarks.find(in_capitals(value.path));
    values.add(value.path, value_text(value.value),
               remark == remarks.end() ? std::string() : comment_of(remark->second));
  }
  Tables fits;
  for (const FitSetting& fit : file.fits) {
    fits.add(fit.path, settings_of(fit));
  }
  text += values.text("parameters") + fits.text("fit") + tune_text(file.tune);
  text.erase(0, text.find_first_not_of('\n'));  // where there is no heading
  return text;
}

void write_parameter_file(const std::filesystem::path& path, const ParameterFile& file, const Remarks& remarks,
                          std::string_view heading) {
  write_file_atomically(path, parameter_text(file, remarks, heading));
}

}  // namespace hysteron::parameters
