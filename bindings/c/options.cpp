#include "bindings/c/options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "support/diagnostic.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"
#include "support/numbers.hpp"

namespace hysteron::bindings {
namespace {

using Value = nlohmann::json;

[[noreturn]] void refuse(std::string_view key, std::string_view wanted, const Value& given) {
  throw InputError(error::bad_usage, {}, fmt::format("The option {} is {}.", key, given.dump()),
                   fmt::format("give it {}.", wanted));
}

std::string text_of(std::string_view key, const Value& value) {
  if (value.is_number_integer()) {
    return value.dump();
  }
  if (value.is_number()) {
    return number_text(value.get<double>());
  }
  if (!value.is_string()) {
    refuse(key, "a text", value);
  }
  return value.get<std::string>();
}

}  // namespace

Options::Options(const char* text) : object_(nlohmann::json::object()) {
  if (text == nullptr || *text == '\0') {
    return;
  }
  object_ = nlohmann::json::parse(text, nullptr, false);
  if (!object_.is_object()) {
    throw InputError(error::bad_usage, {}, fmt::format("The options {} are no object of JSON.", text),
                     "write them as {\"params\": \"tuned.toml\"}.");
  }
}

const Value* Options::find(std::string_view key) {
  known_.emplace_back(key);
  const auto found = object_.find(key);
  return found == object_.end() || found->is_null() ? nullptr : &*found;
}

std::string Options::text(std::string_view key) {
  const Value* const value = find(key);
  return value != nullptr ? text_of(key, *value) : std::string();
}

bool Options::flag(std::string_view key) {
  const Value* const value = find(key);
  if (value != nullptr && !value->is_boolean()) {
    refuse(key, "true or false", *value);
  }
  return value != nullptr && value->get<bool>();
}

std::optional<double> Options::number(std::string_view key) {
  const Value* const value = find(key);
  if (value == nullptr) {
    return std::nullopt;
  }
  if (!value->is_number()) {
    refuse(key, "a number", *value);
  }
  return value->get<double>();
}

std::optional<long long> Options::whole(std::string_view key, long long least, long long most) {
  const std::optional<double> value = number(key);
  if (value && (*value != std::floor(*value) || !(static_cast<double>(least) <= *value) ||
                !(*value <= static_cast<double>(most)))) {
    refuse(key, fmt::format("a whole number from {} to {}", least, most), *value);
  }
  return value ? std::optional(static_cast<long long>(*value)) : std::nullopt;
}

std::vector<std::string> Options::texts(std::string_view key) {
  const Value* const value = find(key);
  std::vector<std::string> result;
  if (value == nullptr) {
    return result;
  }
  if (!value->is_array()) {
    refuse(key, "a list of texts", *value);
  }
  for (const Value& one : *value) {
    result.push_back(text_of(key, one));
  }
  return result;
}

std::vector<std::pair<std::string, Value>> Options::members(std::string_view key) {
  const Value* const value = find(key);
  std::vector<std::pair<std::string, Value>> result;
  if (value == nullptr) {
    return result;
  }
  if (!value->is_object()) {
    refuse(key, "an object of names and values", *value);
  }
  for (const auto& [name, one] : value->items()) {
    result.emplace_back(name, one);
  }
  return result;
}

std::vector<std::pair<std::string, Value>> Options::members_or_text(std::string_view key) {
  const auto found = object_.find(key);
  if (found == object_.end() || !found->is_string()) {
    return members(key);
  }
  known_.emplace_back(key);
  return {{std::string(), *found}};
}

void Options::finish() const {
  for (const auto& [key, value] : object_.items()) {
    if (std::ranges::find(known_, key) == known_.end()) {
      const std::string_view near = nearest_name(key, known_);
      throw InputError(error::bad_usage, {}, fmt::format("There is no option {}.", key),
                       !near.empty()    ? fmt::format("did you mean {}?", near)
                       : known_.empty() ? std::string("leave it out: there are none.")
                                        : fmt::format("the options are {}.", fmt::join(known_, ", ")));
    }
  }
}

}  // namespace hysteron::bindings
