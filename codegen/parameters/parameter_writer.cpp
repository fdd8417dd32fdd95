#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

#include "codegen/parameters/parameter_file.hpp"
#include "support/atomic_file.hpp"
#include "support/element_name.hpp"
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
  if (const auto* const truths = std::get_if<std::vector<bool>>(&value)) {
    for (const bool element : *truths) {
      text += fmt::format("{}{}", text.size() > 1 ? ", " : "", element);
    }
    return text + "]";
  }
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

/// A line of the file: a key with its value, or the head of a table.
struct Entry {
  std::string key{};  ///< in capitals, with its table
  std::string text{};
  std::string remark{};
  bool head = false;
};

/// Values by instance, in the order in which instances first appear; those of the diagram itself first, because a
/// table below ends the one above.
class Tables {
 public:
  explicit Tables(std::string_view title) : title_(title) {}

  void add(const std::string& path, const std::string& text, const Remarks& remarks = {});
  void append_to(std::vector<Entry>& entries) const;

 private:
  struct Table {
    std::string instance{};
    std::vector<Entry> entries{};
  };

  std::string title_;
  std::vector<Table> tables_;
  std::set<std::string> names_;
  std::set<std::string> instances_;
};

void Tables::add(const std::string& path, const std::string& text, const Remarks& remarks) {
  const auto [instance, name] = split(path);
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
  const auto key = in_capitals(title_ + "." + path);
  const auto remark = remarks.find(key);
  table->entries.push_back({.key = key,
                            .text = toml_key(name) + " = " + text,
                            .remark = remark == remarks.end() ? std::string() : comment_of(remark->second)});
}

void Tables::append_to(std::vector<Entry>& entries) const {
  for (const auto& name : names_) {
    if (instances_.contains(name)) {
      throw std::invalid_argument(name + " is a value and an instance");
    }
  }
  for (const Table& table : tables_) {
    const std::string head = title_ + (table.instance.empty() ? "" : ".") + table.instance;
    entries.push_back({.key = in_capitals(head), .text = "[" + head + "]", .remark = {}, .head = true});
    entries.insert(entries.end(), table.entries.begin(), table.entries.end());
  }
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

/// A basic string of TOML. Control characters stand in no setting: the reader has refused them.
std::string toml_string(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      result += '\\';
    }
    result += c;
  }
  return result + "\"";
}

/// The name of a signal as a key: MAIN.u, Y[2] and * stand in quotes.
std::string signal_key(const std::string& name) {
  const auto is_bare = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-'; };
  return std::ranges::all_of(name, is_bare) ? name : toml_string(name);
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

void append_diagnose(const DiagnoseSettings& diagnose, std::vector<Entry>& entries) {
  if (!diagnose.ignore.empty()) {
    entries.push_back({.key = "DIAGNOSE", .text = "[diagnose]", .remark = {}, .head = true});
    entries.push_back({.key = "DIAGNOSE.IGNORE", .text = "ignore = " + list_of(diagnose.ignore), .remark = {}});
  }
}

void append_record(const RecordSettings& record, std::vector<Entry>& entries) {
  // hold, of all signals, is a setting; Q=hold, and hold of the others, are a table.
  std::vector<RecordSettings::Setting> settings;
  std::vector<RecordSettings::Setting> ways;
  for (const RecordSettings::Setting& one : record.settings) {
    const auto equals = one.value.text.rfind('=');
    const bool of_one = equals != std::string::npos;
    if (one.key == "resample") {
      ways.push_back({.key = of_one ? one.value.text.substr(0, equals) : "*",
                      .value = {.text = one.value.text.substr(of_one ? equals + 1 : 0)}});
    } else {
      settings.push_back(one);
    }
  }
  if (ways.size() == 1 && ways.front().key == "*") {
    settings.push_back({.key = "resample", .value = ways.front().value});
    ways.clear();
  }
  const auto add = [&](const std::string& table, const std::vector<RecordSettings::Setting>& of_table) {
    if (!of_table.empty()) {
      entries.push_back({.key = in_capitals(table), .text = "[" + table + "]", .remark = {}, .head = true});
    }
    for (const RecordSettings::Setting& one : of_table) {
      entries.push_back({.key = in_capitals(table + "." + one.key),
                         .text = signal_key(one.key) + " = " + toml_string(one.value.text),
                         .remark = {}});
    }
  };
  add("record", settings);
  add("record.resample", ways);
  add("record.columns", record.columns);
}

void append_tune(const TuneSettings& tune, std::vector<Entry>& entries) {
  const std::size_t head = entries.size();
  entries.push_back({.key = "TUNE", .text = "[tune]", .remark = {}, .head = true});
  const auto add = [&](const std::string& key, const std::string& value) {
    entries.push_back({.key = in_capitals("tune." + key), .text = key + " = " + value, .remark = {}});
  };
  if (!tune.outputs.empty()) {
    add("outputs", list_of(tune.outputs));
  }
  if (tune.loss == Loss::Huber) {
    add("loss", "\"huber\"");
  }
  if (!tune.train.empty()) {
    add("train", list_of(tune.train));
  }
  if (!tune.test.empty()) {
    add("test", list_of(tune.test));
  }
  if (!tune.initial_states.empty()) {
    add("initial_states", list_of(tune.initial_states));
  }
  if (entries.size() == head + 1) {
    entries.pop_back();
  }
}

void append_goal(const GoalSettings& goal, std::vector<Entry>& entries) {
  if (!goal.is_given()) {
    return;
  }
  const auto head = [&](const std::string& table) {
    entries.push_back({.key = in_capitals(table), .text = "[" + table + "]", .remark = {}, .head = true});
  };
  const auto add = [&](const std::string& table, const std::string& key, const std::string& value) {
    entries.push_back({.key = in_capitals(table + "." + key), .text = key + " = " + value, .remark = {}});
  };
  head("goal");
  for (const auto& [key, text] : {std::pair("input", &goal.input), {"output", &goal.output}}) {
    if (*text) {
      add("goal", key, toml_string((*text)->text));
    }
  }
  if (goal.signal != GoalSettings::Signal::Step) {
    add("goal", "signal", goal.signal == GoalSettings::Signal::Ramp ? "\"ramp\"" : "\"record\"");
  }
  for (const auto& [key, number] : {std::pair("from", &goal.from),
                                    {"size", &goal.size},
                                    {"duration", &goal.duration},
                                    {"rise_time", &goal.rise_time},
                                    {"settling_time", &goal.settling_time},
                                    {"order", &goal.order},
                                    {"damping", &goal.damping},
                                    {"dead_time", &goal.dead_time}}) {
    if (*number) {
      add("goal", key, real_text((*number)->value));
    }
  }
  for (const auto& [key, text] : {std::pair("wished", &goal.wished), {"loop", &goal.loop}, {"effort", &goal.effort}}) {
    if (*text) {
      add("goal", key, toml_string((*text)->text));
    }
  }
  if (goal.effort_weight) {
    add("goal", "effort_weight", real_text(goal.effort_weight->value));
  }
  if (!goal.plants.empty()) {
    add("goal", "plants", list_of(goal.plants));
  }
  if (goal.robust == GoalSettings::Robust::Mean) {
    add("goal", "robust", "\"mean\"");
  }
  if (std::ranges::any_of(goal_limit_keys, [&](const GoalLimitKey& key) { return (goal.*key.setting).has_value(); })) {
    head("goal.limits");
  }
  for (const GoalLimitKey& key : goal_limit_keys) {
    if (const auto& limit = goal.*key.setting) {
      add("goal.limits", std::string(key.name), real_text(limit->value));
    }
  }
}

bool is_below(const std::string& key, const std::string& table) {
  return key.size() > table.size() && key.starts_with(table) && key[table.size()] == '.';
}

/// The entry that a comment goes with: that of its key, else the nearest above it, else the first below; none where the
/// file has nothing of the kind any more.
std::size_t entry_of(const std::string& key, const std::vector<Entry>& entries) {
  std::size_t nearest = entries.size();
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (entries[i].key == key) {
      return i;
    }
    const bool outer = is_below(key, entries[i].key);
    if (outer && (nearest == entries.size() || is_below(entries[i].key, entries[nearest].key))) {
      nearest = i;
    }
  }
  const auto inner =
      std::find_if(entries.begin(), entries.end(), [&](const Entry& entry) { return is_below(entry.key, key); });
  return nearest < entries.size() ? nearest : static_cast<std::size_t>(inner - entries.begin());
}

/// Whether a comment was written by a fit before: it differs from the remark in the standard error alone.
bool is_older_remark(std::string_view comment, std::string_view remark) {
  const auto without_error = [](std::string_view text) {
    text = text.substr(0, text.rfind("standard error "));
    return text.ends_with(", ") ? text.substr(0, text.size() - 2) : text;
  };
  return comment.starts_with("# ") && without_error(comment.substr(2)) == without_error(remark);
}

/// `KEY = [1.0, [2.0, 3.0]]` as "KEY = [" and its elements; no elements where the value is no list.
std::pair<std::string, std::vector<std::string>> list_parts(const std::string& text) {
  const auto value = text.find(" = [");
  if (value == std::string::npos) {
    return {text, {}};
  }
  std::vector<std::string> elements(1);
  int depth = 0;
  bool quoted = false;
  const std::size_t first = value + 4;
  for (std::size_t i = first; i + 1 < text.size(); ++i) {
    const char c = text[i];
    if (quoted && c == '\\') {
      elements.back() += c;
      elements.back() += text[++i];
      continue;
    }
    quoted = quoted != (c == '"');
    depth += quoted ? 0 : c == '[' || c == '{' ? 1 : c == ']' || c == '}' ? -1 : 0;
    if (c == ',' && depth == 0 && !quoted) {
      elements.emplace_back();
      ++i;  // the blank behind it
    } else {
      elements.back() += c;
    }
  }
  return {text.substr(0, first), std::move(elements)};
}

/// What stands inside of a list, by the number of elements before it.
struct InsideList {
  std::map<std::size_t, std::string> beside{};
  std::map<std::size_t, std::string> below{};

  [[nodiscard]] bool is_empty() const { return beside.empty() && below.empty(); }
  void take(const Comment& comment, std::size_t elements) {
    auto& place = comment.where == Comment::Where::InList ? below : beside;
    std::string& text = place[std::min<std::size_t>(comment.element, elements)];
    text += (text.empty() ? "" : comment.where == Comment::Where::InList ? "\n  " : " ") + comment.text;
  }
};

/// A list with an element to a line, and the comments that stand there.
std::string list_over_lines(const std::string& entry, const InsideList& inside) {
  const auto [head, elements] = list_parts(entry);
  std::string text;
  for (std::size_t i = 0; i <= elements.size(); ++i) {
    text += i == 0 ? head : "  " + elements[i - 1] + ",";
    const auto beside = inside.beside.find(i);
    text += (beside == inside.beside.end() ? "" : "  " + beside->second) + "\n";
    if (const auto below = inside.below.find(i); below != inside.below.end()) {
      text += "  " + below->second + "\n";
    }
  }
  return text + "]";
}

/// Entries with their comments and remarks; the remarks of one table below each other.
std::string entries_text(const std::vector<Entry>& entries, const std::vector<Comment>& comments) {
  std::vector<std::string> above(entries.size());
  std::vector<std::string> beside(entries.size());
  std::vector<InsideList> inside(entries.size());
  std::string end;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    beside[i] = entries[i].remark.empty() ? "" : "# " + entries[i].remark;
  }
  for (const Comment& comment : comments) {
    const std::size_t i = comment.where == Comment::Where::End ? entries.size() : entry_of(comment.key, entries);
    if (comment.where == Comment::Where::Head) {
      continue;
    }
    if (i == entries.size()) {
      end += "\n" + comment.text + "\n";
      continue;
    }
    const bool was_inside = comment.where == Comment::Where::InList || comment.where == Comment::Where::BesideElement;
    if (was_inside && comment.key == entries[i].key) {
      if (const std::size_t elements = list_parts(entries[i].text).second.size(); elements > 0) {
        inside[i].take(comment, elements);
        continue;
      }
    }
    const bool was_beside = comment.where == Comment::Where::Beside && comment.key == entries[i].key;
    if (was_beside && beside[i].empty()) {
      beside[i] = comment.text;
    } else if (!was_beside || !is_older_remark(comment.text, entries[i].remark)) {
      above[i] += comment.text + "\n";
    }
  }
  std::string text;
  std::size_t widest = 0;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const bool head = entries[i].head;
    if (head) {
      widest = 0;
      for (std::size_t k = i + 1; k < entries.size() && !entries[k].head; ++k) {
        widest = std::max(widest, beside[k].empty() || !inside[k].is_empty() ? 0 : entries[k].text.size());
      }
    }
    text += (head ? "\n" : "") + above[i];
    if (!inside[i].is_empty()) {
      text += list_over_lines(entries[i].text, inside[i]) + (beside[i].empty() ? "" : "  " + beside[i]) + "\n";
      continue;
    }
    text += beside[i].empty() ? entries[i].text + "\n"
                              : fmt::format("{:<{}}  {}\n", entries[i].text, head ? 0 : widest, beside[i]);
  }
  return text + end;
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
  for (const Comment& comment : file.comments) {
    if (comment.where == Comment::Where::Head) {
      text += (text.empty() ? "" : "\n") + comment.text + "\n";
    }
  }
  Tables values("parameters");
  for (const ParameterValue& value : file.values) {
    values.add(value.path, value_text(value.value), remarks);
  }
  Tables initial("initial");
  for (const ParameterValue& value : file.initial) {
    initial.add(value.path, value_text(value.value), remarks);
  }
  Tables fits("fit");
  Tables each_record("fit.record");
  for (const FitSetting& fit : file.fits) {
    (fit.by_record ? each_record : fits).add(fit.path, settings_of(fit));
  }
  std::vector<Entry> entries;
  values.append_to(entries);
  initial.append_to(entries);
  fits.append_to(entries);
  each_record.append_to(entries);
  append_tune(file.tune, entries);
  append_goal(file.goal, entries);
  append_diagnose(file.diagnose, entries);
  append_record(file.record, entries);
  text += entries_text(entries, file.comments);
  text.erase(0, text.find_first_not_of('\n'));  // where there is no heading
  return text;
}

}  // namespace hysteron::parameters
