#include "codegen/import/network_variables.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "codegen/graph/names.hpp"
#include "support/element_name.hpp"
#include "support/names.hpp"

namespace hysteron::import {
namespace {

/// The first value of a variable, or of an element of it; empty where none is given.
std::string initial_of(const DrawnVariable& variable, std::optional<std::int64_t> place) {
  std::string text = with_known_literals(variable.initial);
  const auto known = known_type(variable.type);
  if (!place || !known) {
    return text;
  }
  const std::vector<std::string> list = elements_of_list(text);
  const auto at = static_cast<std::size_t>(*place - known->carried.low);
  return at < list.size() ? real_text(known->carried.type, list[at]) : "";
}

}  // namespace

NetworkVariables::NetworkVariables(const DrawnPou& pou, NetworkText& text) : text_(text) {
  for (const DrawnVariable& variable : pou.variables) {
    made_.take(variable.name);
    made_.take(name_of_output(variable));
    variables_.emplace(in_capitals(variable.name), &variable);
  }
}

void NetworkVariables::expect(const Assigners& assigners) {
  for (const auto& [key, elements] : assigners) {
    to_come_.emplace(key, elements.size());
    if (const auto element = element_of(key)) {
      if (const DrawnVariable* const variable = find(std::string(element->vector))) {
        by_elements_.emplace(element->vector, variable);
      }
    }
  }
}

const DrawnVariable* NetworkVariables::find(const std::string& name) const {
  const auto found = variables_.find(in_capitals(name));
  return found == variables_.end() ? nullptr : found->second;
}

void NetworkVariables::declare(const std::string& name, const Carried& carried) {
  text_.locals += fmt::format("    {} : {};\n", name, declared_text(carried));
}

void NetworkVariables::assign(const std::string& key, const std::string& value, std::optional<std::uint64_t> order,
                              const Refuse& refuse) {
  const auto element = element_of(key);
  const DrawnVariable& variable = *variables_.at(key.substr(0, key.find('[')));
  const auto before = assigned_.find(key);
  if (before != assigned_.end() && order < before->second.order) {
    refuse(fmt::format("it assigns {} behind an element of a higher order, which feeds what runs earlier", key),
           "Give what is fed the higher executionOrderId.");
  }
  const bool last = --to_come_.at(key) == 0;
  const auto type = known_type(variable.type);
  const std::string output = name_of_output(variable);
  std::string target = element ? element_name(output, element->index) : output;
  if (last) {
    text_.assigned.push_back(in_capitals(output));
  } else {
    target = new_name(identifier_of(element ? element_name(variable.name, element->index) : variable.name) + "_BEFORE");
    if (type) {
      declare(target, element ? Carried(type->carried.type) : type->carried);
    }
  }
  text_.statements += fmt::format("  {} := {};\n", target, value);
  assigned_[key] = {.name = target, .order = order};
}

std::string NetworkVariables::read(const NameRead& name, const Refuse& refuse) {
  const DrawnVariable* const variable = find(name.name);
  if (variable == nullptr) {
    refuse(fmt::format("{} is not declared in the POU", name.name), "Make it an input of the POU.");
    return "FALSE";
  }
  const auto type = known_type(variable->type);
  if (name.place && type && !type->carried.has_place(*name.place)) {
    refuse(fmt::format("it reads {}, and {} is of type {}", element_name(variable->name, *name.place), variable->name,
                       variable->type),
           "Read an element that it has.");
    return "FALSE";
  }
  const std::string whole = in_capitals(name.name);
  const std::string key = name.place ? element_name(whole, *name.place) : whole;
  if (const auto assigned = assigned_.find(key); assigned != assigned_.end()) {
    return assigned->second.name;
  }
  if (const auto assigned = assigned_.find(whole); assigned != assigned_.end()) {
    return element_name(assigned->second.name, *name.place);
  }
  if (!name.place && by_elements_.contains(whole)) {
    return whole_by_elements(*variable, refuse);
  }
  std::string text = name.place ? element_name(variable->name, *name.place) : variable->name;
  if (variable->section == DrawnVariable::Section::Both) {
    text_.taken_in.push_back(whole);
    return text;
  }
  const bool is_later = to_come_.contains(key) || to_come_.contains(whole);
  return is_later && type ? delayed(text, name.place ? Carried(type->carried.type) : type->carried,
                                    initial_of(*variable, name.place))
                                .text
                          : text;
}

/// The whole of an array is read where its elements are assigned: all of them before, or the cycles would be mixed.
std::string NetworkVariables::whole_by_elements(const DrawnVariable& variable, const Refuse& refuse) const {
  const std::string name = in_capitals(variable.name);
  const auto is_to_come = [&](const auto& one) {
    const auto element = element_of(one.first);
    return element && element->vector == name && one.second > 0;
  };
  const auto later = std::ranges::find_if(to_come_, is_to_come);
  if (later != to_come_.end()) {
    refuse(fmt::format("it reads the whole of {} before {} is assigned", variable.name, later->first),
           "Give what assigns its elements the lower executionOrderId, or read the elements one by one.");
  }
  return name_of_output(variable);
}

Value NetworkVariables::delayed(const std::string& text, const Carried& carried, const std::string& start) {
  if (!carried.is_vector()) {
    return {made_.delayed(text, carried.type, start), carried};
  }
  std::string& name = vectors_of_last_cycle_[text];
  if (name.empty()) {
    name = new_name(identifier_of(text) + "_LAST");
    declare(name, carried);
    const std::vector<std::string> starts = elements_of_list(start);
    for (std::int64_t place = carried.low; place <= carried.high; ++place) {
      const auto at = static_cast<std::size_t>(place - carried.low);
      const std::string begin = at < starts.size() ? real_text(carried.type, starts[at]) : "";
      text_.statements += fmt::format("  {} := {};\n", element_name(name, place),
                                      made_.delayed(element_name(text, place), carried.type, begin));
    }
  }
  return {name, carried};
}

void NetworkVariables::finish() {
  for (const auto& [name, variable] : by_elements_) {
    const auto type = known_type(variable->type);
    const Carried carried = type ? type->carried : Carried();
    for (std::int64_t place = carried.low; place <= carried.high; ++place) {
      if (to_come_.contains(element_name(name, place))) {
        continue;
      }
      std::string value = initial_of(*variable, place);
      if (variable->section == DrawnVariable::Section::Both) {
        text_.taken_in.push_back(name);
        value = element_name(variable->name, place);
      }
      text_.statements += fmt::format("  {} := {};\n", element_name(name_of_output(*variable), place),
                                      value.empty() ? literal_text(carried.type, 0.0) : value);
    }
  }
  text_.statements += made_.statements();
  text_.locals += made_.declarations();
}

}  // namespace hysteron::import
