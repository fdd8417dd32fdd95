#include "codegen/import/network_check.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "codegen/import/expression.hpp"
#include "codegen/import/types.hpp"
#include "codegen/plcopen/tc6.hpp"
#include "support/names.hpp"

namespace hysteron::import {
namespace {

bool is_constant(const DrawnPou& pou, const DrawnElement& element) {
  if (element.kind != tc6::in_variable) {
    return false;
  }
  const auto variable = std::ranges::find_if(
      pou.variables, [&](const DrawnVariable& one) { return equal_ignoring_case(one.name, element.text); });
  return variable == pou.variables.end() ? type_of_literal(with_known_literals(element.text)).has_value()
                                         : variable->section == DrawnVariable::Section::Constant ||
                                               variable->remark.find("@param") != std::string::npos;
}

}  // namespace

std::vector<Objection> objections_to(const DrawnPou& pou) {
  static const std::set<std::string_view> known{tc6::in_variable,  tc6::out_variable, tc6::block,     tc6::connector,
                                                tc6::continuation, tc6::contact,      tc6::coil,      tc6::left_rail,
                                                tc6::right_rail,   tc6::comment,      "vendorElement"};
  std::vector<Objection> result;
  std::map<std::string, int> targets;
  std::set<std::string> instances;
  for (const DrawnElement& element : pou.elements) {
    const auto object = [&](std::string why, std::string mend) {
      result.push_back({.element = &element, .why = std::move(why), .mend = std::move(mend)});
    };
    if (!known.contains(element.kind)) {
      object("no diagram has such an element", "Draw it with blocks and variables, or write it as text.");
    }
    if ((element.kind == tc6::out_variable || element.kind == tc6::coil) && ++targets[in_capitals(element.text)] == 2) {
      object("it is assigned twice", "Assign it once: choose between the values by SEL or OR.");
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

std::set<std::string> targets_of(const DrawnPou& pou) {
  std::set<std::string> targets;
  for (const DrawnElement& element : pou.elements) {
    if (element.kind == tc6::out_variable || element.kind == tc6::coil) {
      targets.insert(in_capitals(element.text));
    }
  }
  return targets;
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
        const auto source = std::ranges::find(pou.elements, link.element, &DrawnElement::id);
        return source == pou.elements.end() || !is_constant(pou, *source);
      });
    }
  }
  return false;
}

}  // namespace hysteron::import
