#include "runtime/config/toml_reader.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "runtime/config/run_config.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"
#include "support/numbers.hpp"

namespace hysteron::runtime {
namespace {

std::string listed(std::span<const std::string_view> words) {
  std::string text;
  for (const std::string_view word : words) {
    text += (text.empty() ? "" : ", ") + std::string(word);
  }
  return text;
}

}  // namespace

TomlReader::TomlReader(const std::string& file, std::string name, const toml::table& table,
                       std::span<const RunKey> known, Diagnostics& diagnostics)
    : file_(&file), name_(std::move(name)), table_(&table), known_(known), diagnostics_(&diagnostics) {
  for (const auto& [key, node] : table) {
    if (std::ranges::find(known, key.str(), &RunKey::name) == known.end()) {
      std::vector<std::string_view> names;
      for (const RunKey& one : known) {
        names.push_back(one.name);
      }
      const auto near = nearest_name(key.str(), names);
      diagnostics.error(
          error::unknown_run_key, place_of(file, key.source()),
          "There is no key " + std::string(key.str()) + " in " + name_ + ".",
          near.empty() ? "use one of: " + listed(names) + "." : "did you mean " + std::string(near) + "?");
    }
  }
}

const RunKey& TomlReader::declared(std::string_view key) const {
  const auto found = std::ranges::find(known_, key, &RunKey::name);
  if (found == known_.end()) {
    throw std::logic_error("a key is read that is not declared");
  }
  return *found;
}

Place TomlReader::place(std::string_view key) const {
  const auto* const node = table_->get(key);
  return place_of(*file_, node == nullptr ? table_->source() : node->source());
}

Place TomlReader::place(std::string_view key, std::size_t element) const {
  const auto* const list = table_->get_as<toml::array>(key);
  const auto* const node = list == nullptr ? nullptr : list->get(element);
  return node == nullptr ? place(key) : place_of(*file_, node->source());
}

void TomlReader::wrong_type(std::string_view key, const std::string& wanted, const std::string& example) {
  diagnostics_->error(error::wrong_run_value, place(key), std::string(key) + " must be " + wanted + ".",
                      "write it as in " + std::string(key) + " = " + example + ".");
}

/// With the number that stands there, in a unit that the key may have.
void TomlReader::wrong_time(std::string_view key, const toml::node& node, std::int64_t low, std::int64_t high) {
  std::string given = node.value<std::string>().value_or("");
  if (const auto number = node.value<double>(); node.is_number() && number) {
    given = number_text(*number);
  }
  for (const char* const unit : {"s", "ms", "us", "min", "h", "d", "ns"}) {
    const auto time = parse_duration(given + unit);
    if (time && low <= *time && *time <= high) {
      diagnostics_->error(error::wrong_run_value, place(key),
                          std::string(key) + " is a length of time, and " + given + " has no unit.",
                          "write it with its unit, in quotes: " + std::string(key) + " = \"" + given + unit +
                              "\"; units are ns, us, ms, s, min, h and d.");
      return;
    }
  }
  const std::string_view usual = declared(key).otherwise;
  wrong_type(key, "a length of time in ns, us, ms, s, min, h or d",
             usual.starts_with('"')
                 ? std::string(usual)
                 : "\"" + time_text(static_cast<double>(std::clamp<std::int64_t>(5'000'000, low, high))) + "\"");
}

void TomlReader::out_of_range(std::string_view key, const std::string& range) {
  diagnostics_->error(error::run_value_out_of_range, place(key), std::string(key) + " must be " + range + ".",
                      declared(key).otherwise == "(required)" ? "choose a value in that range."
                                                              : "choose a value in that range, or leave the key out.");
}

void TomlReader::read(std::string_view key, bool& into) {
  if (const auto* const node = table_->get(key)) {
    if (!node->is_boolean()) {
      return wrong_type(key, "true or false", "true");
    }
    into = node->as_boolean()->get();
  }
}

void TomlReader::read(std::string_view key, std::string& into) {
  if (const auto* const node = table_->get(key)) {
    if (!node->is_string() || node->as_string()->get().empty()) {
      return wrong_type(key, "a text that is not empty", "\"name\"");
    }
    into = node->as_string()->get();
    if (declared(key).kind == KeyKind::path && (into == "~" || into.starts_with("~/"))) {
      // With the folder named ~ that a start may have made already, for what is kept there.
      diagnostics_->warning(error::wrong_run_value, place(key),
                            std::string(key) + " = \"" + into + "\" lies in a folder named ~, and in no home.",
                            "write the path from / on; only a shell knows what ~ stands for. What lies in the folder ~ "
                            "may have to be moved.");
    }
  }
}

void TomlReader::read(std::string_view key, std::vector<std::string>& into, const char* example) {
  const auto* const node = table_->get(key);
  if (node == nullptr) {
    return;
  }
  const auto* const list = node->as_array();
  if (list == nullptr || (!list->empty() && !list->is_homogeneous<std::string>())) {
    return wrong_type(key, "a list of texts", example);
  }
  for (const toml::node& one : *list) {
    into.push_back(one.as_string()->get());
  }
}

void TomlReader::read(std::string_view key, double& into) {
  const auto [low, high] = std::pair(declared(key).low, declared(key).high);
  const auto* const node = table_->get(key);
  if (node == nullptr) {
    return;
  }
  const auto value = node->is_number() ? node->value<double>() : std::nullopt;
  if (node->is_boolean()) {
    return wrong_type(key, "a number, of a BOOL 0 or 1", node->as_boolean()->get() ? "1" : "0");
  }
  if (!value) {
    return wrong_type(key, "a number", "1.5");
  }
  if (!std::isfinite(*value) || *value < low || *value > high) {
    return out_of_range(key, std::isinf(low)    ? "a finite number"
                             : std::isinf(high) ? "a finite number above 0"
                                                : "from " + number_text(low) + " to " + number_text(high));
  }
  into = *value;
}

std::optional<std::int64_t> TomlReader::whole(std::string_view key) {
  const auto low = static_cast<std::int64_t>(declared(key).low);
  const auto high = static_cast<std::int64_t>(declared(key).high);
  const auto* const node = table_->get(key);
  if (node == nullptr) {
    return std::nullopt;
  }
  if (!node->is_integer()) {
    wrong_type(key, "a whole number", std::to_string(low + 1));
    return std::nullopt;
  }
  const std::int64_t value = node->as_integer()->get();
  if (value < low || value > high) {
    out_of_range(key, "from " + std::to_string(low) + " to " + std::to_string(high));
    return std::nullopt;
  }
  return value;
}

void TomlReader::read_duration(std::string_view key, std::int64_t& into) {
  const RunKey& bounds = declared(key);
  read_duration(key, into, static_cast<std::int64_t>(bounds.low), static_cast<std::int64_t>(bounds.high));
}

void TomlReader::read_duration(std::string_view key, std::chrono::nanoseconds& into) {
  std::int64_t time = into.count();
  read_duration(key, time);
  into = std::chrono::nanoseconds(time);
}

void TomlReader::read_duration(std::string_view key, std::chrono::milliseconds& into) {
  std::chrono::nanoseconds time = into;
  read_duration(key, time);
  into = std::chrono::ceil<std::chrono::milliseconds>(time);
}

void TomlReader::read_duration(std::string_view key, std::int64_t& into, std::int64_t low, std::int64_t high) {
  const auto* const node = table_->get(key);
  if (node == nullptr) {
    return;
  }
  const auto value = node->is_string() ? parse_duration(node->as_string()->get()) : std::nullopt;
  if (!value) {
    return wrong_time(key, *node, low, high);
  }
  if (*value < low || *value > high) {
    return out_of_range(key,
                        "from " + time_text(static_cast<double>(low)) + " to " + time_text(static_cast<double>(high)));
  }
  into = *value;
}

void TomlReader::require(const std::string& key, const std::string& example) {
  if (!has(key)) {
    diagnostics_->error(error::wrong_run_value, place(), name_ + " needs the key " + key + ".",
                        "write it as in " + key + " = " + example + ", or remove the table.");
  }
}

void TomlReader::read_choice(std::string_view key, std::size_t& into) {
  const auto words = declared(key).words;
  const auto* const node = table_->get(key);
  if (node == nullptr) {
    return;
  }
  const auto text = node->value<std::string_view>();
  const auto found = text ? std::ranges::find(words, *text) : words.end();
  if (found == words.end()) {
    // None of them is an example for the others: what was meant is told, or all that there are.
    const std::string_view near = text ? nearest_name(*text, words) : "";
    std::string mend =
        near.empty() ? "write " + std::string(key) + " = " : "did you mean \"" + std::string(near) + "\"?";
    for (std::size_t i = 0; near.empty() && i < words.size(); ++i) {
      mend += (i == 0 ? "\"" : i + 1 < words.size() ? "\", \"" : "\" or \"") + std::string(words[i]);
    }
    diagnostics_->error(error::wrong_run_value, place(key),
                        std::string(key) + " must be one of: " + listed(words) + ".",
                        mend + (near.empty() ? "\"." : ""));
    return;
  }
  into = static_cast<std::size_t>(found - words.begin());
}

}  // namespace hysteron::runtime
