#include "codegen/parameters/settings_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "codegen/parameters/parameter_names.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"
#include "support/toml_text.hpp"
#include "support/utf8.hpp"

namespace hysteron::parameters {

Place SettingsReader::at(const toml::node& node) const {
  return place_of(file_, node.source());
}
Place SettingsReader::at(const toml::key& key) const {
  return place_of(file_, key.source());
}

void SettingsReader::wrong_type(const toml::key& key, const toml::node& node, std::string_view wanted,
                                std::string_view example) {
  diagnostics_.error(error::wrong_value_type, at(node),
                     fmt::format("{} must be {}, but is {}.", key.str(), wanted, toml_kind(node)),
                     fmt::format("write it as in {}.", example));
}

void SettingsReader::wrong_element(const toml::key& key, const toml::node& element, std::string_view wanted,
                                   std::string_view example) {
  diagnostics_.error(
      error::wrong_value_type, at(element),
      fmt::format("Each element of {} must be {}, but here is {}.", key.str(), wanted, toml_kind(element)),
      fmt::format("write it as in {}.", example));
}

void SettingsReader::no_name(const toml::key& key, const toml::node& node, std::string_view text,
                             std::string_view example) {
  diagnostics_.error(error::wrong_value_type, at(node),
                     fmt::format("{} names {}, which is no name.", key.str(),
                                 text.empty() ? "an empty text" : fmt::format("\"{}\"", printable(text))),
                     fmt::format("write it as in {}.", example));
}

void SettingsReader::contradiction(const Place& place, std::string cause, std::string mend) {
  diagnostics_.error(error::contradicting_range, place, std::move(cause), std::move(mend));
}

bool SettingsReader::known_key(const toml::key& key, const toml::node& node, std::span<const std::string_view> known,
                               std::string_view table) {
  if (std::find(known.begin(), known.end(), key.str()) != known.end()) {
    return true;
  }
  const auto near = nearest_name(key.str(), known);
  std::string mend = fmt::format("remove it, or use one of {}.", fmt::join(known, ", "));
  if (!near.empty()) {
    mend = fmt::format("did you mean {}?", near);
  } else if (table.empty()) {
    mend = fmt::format("values stand under [parameters], those of the instance {0} under [parameters.{0}].",
                       node.is_table() && is_path(key.str()) ? key.str() : "INV");
  }
  diagnostics_.error(error::unknown_key, at(key),
                     table.empty() ? fmt::format("There is no table or key {} in a parameter file.", key.str())
                                   : fmt::format("There is no key {} in {}.", key.str(), table),
                     mend);
  return false;
}

const toml::table* SettingsReader::as_table(const toml::key& key, const toml::node& node) {
  if (!node.is_table()) {
    wrong_type(key, node, "a table", fmt::format("[{}]", key.str()));
  }
  return node.as_table();
}

std::optional<PlacedNumber> SettingsReader::number_of(const toml::key& key, const toml::node& node) {
  const auto number = node.is_number() ? node.value<double>() : std::nullopt;
  if (!number) {
    wrong_type(key, node, "a number", fmt::format("{} = 0.05", key.str()));
    return std::nullopt;
  }
  return PlacedNumber{.value = *number, .place = at(node)};
}

void SettingsReader::not_finite(const toml::key& key, const PlacedNumber& number, std::string_view mend) {
  diagnostics_.error(error::parameter_not_finite, number.place,
                     fmt::format("{} is {}.", key.str(), std::isnan(number.value) ? "not a number" : "infinite"),
                     std::string(mend));
}

std::optional<PlacedNumber> SettingsReader::finite(const toml::key& key, const toml::node& node) {
  auto number = number_of(key, node);
  if (number && !std::isfinite(number->value)) {
    not_finite(key, *number, "write a finite number.");
    return std::nullopt;
  }
  return number;
}

std::optional<PlacedText> SettingsReader::name_of(const toml::key& key, const toml::node& node,
                                                  std::string_view example, bool (*is_name)(std::string_view)) {
  const auto text = node.value<std::string_view>();
  if (!node.is_string()) {
    wrong_type(key, node, "a name", example);
    return std::nullopt;
  }
  if (!is_name(*text)) {
    no_name(key, node, *text, example);
    return std::nullopt;
  }
  return PlacedText{.text = std::string(*text), .place = at(node)};
}

std::vector<PlacedText> SettingsReader::names_of(const toml::key& key, const toml::node& node, std::string_view example,
                                                 bool (*is_name)(std::string_view)) {
  std::vector<PlacedText> names;
  const auto* const list = node.as_array();
  if (list == nullptr || list->empty()) {
    wrong_type(key, node, "a list of names", example);
    return {};
  }
  for (const toml::node& element : *list) {
    const auto text = element.value<std::string_view>();
    if (!text) {
      wrong_element(key, element, "a name", example);
      continue;
    }
    if (!is_name(*text)) {
      no_name(key, element, *text, example);
      continue;
    }
    const auto first = std::find_if(names.begin(), names.end(),
                                    [&](const PlacedText& name) { return equal_ignoring_case(name.text, *text); });
    if (first != names.end()) {
      diagnostics_.error(error::duplicate_key, at(element), fmt::format("{} stands in the list twice.", *text),
                         "keep one of the two; case makes no difference.",
                         {{.place = first->place, .text = "the first"}});
      continue;
    }
    names.push_back({.text = std::string(*text), .place = at(element)});
  }
  return names;
}

std::optional<std::size_t> SettingsReader::word_of(const toml::key& key, const toml::node& node,
                                                   std::span<const std::string_view> words) {
  const auto text = node.is_string() ? node.value<std::string_view>() : std::nullopt;
  if (!text) {
    wrong_type(key, node, "a text", fmt::format("{} = \"{}\"", key.str(), words.front()));
    return std::nullopt;
  }
  const auto found = std::ranges::find(words, *text);
  if (found == words.end()) {
    const auto near = nearest_name(*text, words);
    diagnostics_.error(error::wrong_value_type, at(node), fmt::format("There is no {} \"{}\".", key.str(), *text),
                       near.empty() ? fmt::format("write \"{}\".", fmt::join(words, "\" or \""))
                                    : fmt::format("did you mean \"{}\"?", near));
    return std::nullopt;
  }
  return static_cast<std::size_t>(found - words.begin());
}

}  // namespace hysteron::parameters
