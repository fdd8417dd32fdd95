#include "codegen/import/made_variables.hpp"

#include <fmt/format.h>

#include "codegen/graph/names.hpp"
#include "codegen/graph/text_order.hpp"
#include "support/names.hpp"

namespace hysteron::import {

std::string identifier_of(std::string_view value) {
  std::string name;
  for (const char letter : value) {
    if (letter != ']') {
      name += letter == '.' || letter == '[' ? '_' : letter == '-' ? 'm' : letter;
    }
  }
  return name;
}

void MadeVariables::take(const std::string& name) {
  taken_.insert(in_capitals(name));
}

std::string MadeVariables::new_name(const std::string& base) {
  std::string name = base;
  for (int number = 1; is_reserved(name) || !taken_.insert(in_capitals(name)).second; ++number) {
    name = fmt::format("{}_{}", base, number);
  }
  return name;
}

std::string MadeVariables::delayed(const std::string& value, Type type, const std::string& start) {
  Delay& delay = delays_[in_capitals(value)];
  if (delay.instance.empty()) {
    delay = {.instance = new_name(identifier_of(value) + "_LAST"), .value = value, .start = start, .type = type};
  }
  return delay.instance + ".XOUT";
}

std::string MadeVariables::statements() const {
  std::string text;
  for (const auto& [value, delay] : delays_) {
    text += fmt::format("  {}(XIN := {});\n", delay.instance, delay.value);
  }
  return text;
}

std::string MadeVariables::declarations() const {
  std::string text;
  for (const auto& [value, delay] : delays_) {
    text += fmt::format("    {} : {}{};\n", delay.instance, delay_of(delay.type),
                        delay.start.empty() ? "" : fmt::format(" := (X0 := {})", delay.start));
  }
  return text;
}

}  // namespace hysteron::import
