#include "codegen/import/network_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

#include "codegen/import/expression.hpp"
#include "codegen/import/types.hpp"
#include "codegen/plcopen/tc6.hpp"
#include "support/element_name.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"

namespace hysteron::import {
namespace {

/// Blocks that hand a variable on to each other.
constexpr std::size_t deepest_handing = 33;

bool is_constant(const DrawnPou& pou, const DrawnElement& element) {
  if (element.kind != tc6::in_variable) {
    return false;
  }
  const DrawnVariable* const variable = find_variable(pou, element.text);
  return variable == nullptr ? type_of_literal(with_known_literals(element.text)).has_value()
                             : variable->section == DrawnVariable::Section::Constant ||
                                   variable->remark.find("@param") != std::string::npos;
}

std::vector<Objection> undecided_assignments(const Assigners& assigners) {
  std::vector<Objection> result;
  for (const auto& [name, elements] : assigners) {
    std::set<std::uint64_t> orders;
    for (const DrawnElement* const element : elements) {
      const bool stated = element->order && orders.insert(*element->order).second;
      if (!stated && elements.size() > 1) {
        const DrawnElement* const other = elements.front() == element ? elements[1] : elements.front();
        result.push_back({.element = element,
                          .why = fmt::format("it assigns {}, as localId {} does, and no order says which is the last",
                                             name, other->id),
                          .mend = "Give each an executionOrderId of its own, or assign it once: choose between the "
                                  "values by SEL or OR."});
        break;
      }
    }
  }
  return result;
}

/// Elements of arrays that are assigned, which there are not, or beside the whole.
std::vector<Objection> wrong_elements(const DrawnPou& pou, const Assigners& assigners) {
  std::vector<Objection> result;
  for (const auto& [key, elements] : assigners) {
    const auto place = element_of(key);
    const std::string name = key.substr(0, key.find('['));
    const DrawnVariable* const variable = find_variable(pou, name);
    const auto known = variable == nullptr ? std::nullopt : known_type(variable->type);
    if (key.find('[') == std::string::npos || variable == nullptr) {
      continue;
    }
    const auto object = [&, &elements = elements](std::string why, std::string mend) {
      result.push_back({.element = elements.front(), .why = std::move(why), .mend = std::move(mend)});
    };
    if (!place) {
      object(fmt::format("it assigns an element of {} whose place is no constant", variable->name),
             "Write the number of the element, or assign it in a POU of Structured Text.");
    } else if (!known || !known->carried.has_place(place->index)) {
      object(fmt::format("it assigns {}, and {} is of type {}", key, variable->name, variable->type),
             "Assign an element that it has.");
    } else if (assigners.contains(name)) {
      object(fmt::format("it assigns an element of {}, which localId {} assigns as a whole", variable->name,
                         assigners.at(name).front()->id),
             "Assign all of it in one of the two ways.");
    }
  }
  return result;
}

/// A wire comes from a localId: it has to be one element's. Rails are all the same, and no wire leads to what tells
/// alone.
std::set<const DrawnElement*> with_a_taken_id(const DrawnPou& pou) {
  std::set<const DrawnElement*> doubles;
  std::map<std::uint64_t, std::string_view> kinds;
  for (const DrawnElement& element : pou.elements) {
    if (element.kind == tc6::comment || element.kind == tc6::vendor_element || element.kind == tc6::right_rail) {
      continue;
    }
    const auto [known, is_new] = kinds.emplace(element.id, element.kind);
    if (!is_new && (element.kind != tc6::left_rail || known->second != tc6::left_rail)) {
      doubles.insert(&element);
    }
  }
  return doubles;
}

}  // namespace

std::vector<Objection> objections_to(const DrawnPou& pou, const OwnBlocks& own, const Assigners& assigners) {
  static const std::set<std::string_view> known{
      tc6::in_variable, tc6::out_variable, tc6::block,      tc6::connector, tc6::continuation,    tc6::contact,
      tc6::coil,        tc6::left_rail,    tc6::right_rail, tc6::comment,   tc6::in_out_variable, tc6::vendor_element};
  std::vector<Objection> result = undecided_assignments(assigners);
  std::ranges::move(wrong_elements(pou, assigners), std::back_inserter(result));
  std::set<std::string> instances;
  const std::set<const DrawnElement*> doubles = with_a_taken_id(pou);
  for (const DrawnElement& element : pou.elements) {
    const auto object = [&](std::string why, std::string mend) {
      result.push_back({.element = &element, .why = std::move(why), .mend = std::move(mend)});
    };
    if (!known.contains(element.kind)) {
      object("no diagram has such an element", "Draw it with blocks and variables, or write it as text.");
    }
    if (!element.unread_order.empty()) {
      object(fmt::format("its executionOrderId {} is no whole number from 0", element.unread_order),
             "Write a number that no other element has, or take the attribute out.");
    }
    for (const std::string& one : element.unread) {
      object(fmt::format("its {} says nothing here", one), "Write true or false, or take the attribute out.");
    }
    if (doubles.contains(&element)) {
      object("another element has this localId", "Give each a number of its own, or export the POU again.");
    }
    if (element.kind == tc6::vendor_element && (!element.inputs.empty() || !element.outputs.empty())) {
      object("nobody but its editor knows what it does", "Draw it with blocks and variables.");
    }
    for (const DrawnPin& pin : element.outputs) {
      if (pin.edge) {
        object(fmt::format("its output {} takes an edge", pin.name), "Put an R_TRIG or F_TRIG behind it.");
      }
    }
    for (const auto* const pins : {&element.inputs, &element.both, &element.outputs}) {
      for (const DrawnPin& pin : *pins) {
        if (!pin.storage.empty() && pin.storage != "none") {
          object(fmt::format("its pin {} sets or resets", pin.name), "Put an SR or RS there.");
        }
      }
    }
    for (const DrawnPin& pin : element.both) {
      const auto callee = own.find(in_capitals(element.text));
      if (callee == own.end() || callee->second->language == tc6::structured_text) {
        object("it has VAR_IN_OUT " + pin.name, "Hand the value in by an input and out by an output.");
      } else if (handed_over(pou, pin).empty()) {
        object("its VAR_IN_OUT " + pin.name + " is handed no variable of the POU",
               "Connect a local variable, an output or a VAR_IN_OUT.");
      }
    }
    const bool wired = element.kind == tc6::in_out_variable && !element.inputs.empty() &&
                       std::ranges::any_of(element.inputs.front().links, [&](const Link& link) {
                         const DrawnElement* const from = find_element(pou, link.element);
                         return from == nullptr || std::ranges::none_of(from->both, [&](const DrawnPin& one) {
                                  return equal_ignoring_case(one.name, link.pin);
                                });
                       });
    if (wired) {
      object("a wire assigns it", "Assign it by an output variable, outVariable.");
    }
    if (element.kind == tc6::block && !element.instance.empty() &&
        !instances.insert(in_capitals(element.instance)).second) {
      object("the instance is called twice", "Call it once, or declare another instance.");
    }
    if (!element.edge.empty() && element.edge != "none") {
      object("it takes an edge", "Put an R_TRIG or F_TRIG there.");
    }
    if (!element.storage.empty() && element.storage != "none") {
      object("it sets or resets", "Put an SR or RS there.");
    }
  }
  return result;
}

std::string handed_over(const DrawnPou& pou, const DrawnPin& pin) {
  const DrawnVariable* const declared = find_variable(pou, pin.expression);
  using Section = DrawnVariable::Section;
  const bool may_change =
      declared != nullptr && (declared->section == Section::Output || declared->section == Section::Local ||
                              declared->section == Section::Both);
  return may_change ? in_capitals(declared->name) : std::string();
}

bool hands_back(const DrawnElement& block, std::string_view pin, const Targets& targets) {
  const auto called = targets.find(in_capitals(block.text));
  return called != targets.end() && called->second.contains(in_capitals(pin));
}

std::string target_key(std::string_view text) {
  std::string key = in_capitals(text);
  std::erase(key, ' ');
  const auto element = element_of(key);
  return element ? element_name(element->vector, element->index) : key;
}

Assigners assigners_in(const DrawnPou& pou, const Targets& called) {
  Assigners assigners;
  for (const DrawnElement& element : pou.elements) {
    if (element.kind == tc6::out_variable || element.kind == tc6::coil) {
      assigners[target_key(element.text)].push_back(&element);
    }
    for (const DrawnPin& pin : element.both) {
      if (const std::string name = handed_over(pou, pin); !name.empty() && hands_back(element, pin.name, called)) {
        assigners[name].push_back(&element);
      }
    }
  }
  return assigners;
}

Targets targets_of_all(const std::string& file, const OwnBlocks& own) {
  Targets targets;
  for (std::size_t pass = 0; pass < deepest_handing; ++pass) {
    bool changed = false;
    for (const auto& [name, pou] : own) {
      std::set<std::string> now;
      for (const auto& [target, assigners] : assigners_in(*pou, targets)) {
        now.insert(target.substr(0, target.find('[')));
      }
      changed = changed || now != targets[name];
      targets[name] = std::move(now);
    }
    if (!changed) {
      return targets;
    }
  }
  throw InputError(error::untranslatable_element, {.file = file},
                   fmt::format("a VAR_IN_OUT is handed on through more than {} blocks", deepest_handing - 1),
                   "Hand the value in by an input and out by an output.");
}

bool is_driven(const DrawnPou& pou, std::string_view instance, std::string_view name) {
  for (const DrawnElement& element : pou.elements) {
    if (in_capitals(element.instance) != instance) {
      continue;
    }
    for (const DrawnPin& pin : element.inputs) {
      if (!equal_ignoring_case(pin.name, name)) {
        continue;
      }
      if (!pin.expression.empty() && !type_of_literal(with_known_literals(pin.expression))) {
        return true;
      }
      return std::ranges::any_of(pin.links, [&](const Link& link) {
        const DrawnElement* const source = find_element(pou, link.element);
        return source == nullptr || !is_constant(pou, *source);
      });
    }
  }
  return false;
}

}  // namespace hysteron::import
