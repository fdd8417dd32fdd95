#include "codegen/import/function_text.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "codegen/import/expression.hpp"
#include "codegen/import/types.hpp"
#include "codegen/plcopen/tc6.hpp"
#include "support/names.hpp"
#include "support/trimmed.hpp"

namespace hysteron::import {

std::vector<std::size_t> order_of_execution(const DrawnPou& pou) {
  std::vector<std::size_t> list;
  for (std::size_t i = 0; i < pou.elements.size(); ++i) {
    if (is_executed(pou.elements[i])) {
      list.push_back(i);
    }
  }
  std::ranges::stable_sort(list, [&](std::size_t left, std::size_t right) {
    const DrawnElement& a = pou.elements[left];
    const DrawnElement& b = pou.elements[right];
    const auto rank = [](const DrawnElement& one) { return one.order ? 0 : one.kind == tc6::block ? 2 : 1; };
    if (rank(a) != rank(b)) {
      return rank(a) < rank(b);
    }
    return a.order != b.order ? a.order < b.order : a.y != b.y ? a.y < b.y : a.x < b.x;
  });
  return list;
}

Value applied(const plcopen::OperatorFunction* own, const std::string& name, const std::vector<Value>& arguments) {
  Value result{.type = arguments.back().type};
  if (own == nullptr) {
    for (const Value& one : arguments) {
      result.text += (result.text.empty() ? "" : ", ") + one.text;
    }
    result.text = fmt::format("{}({})", name, result.text);
    const Carried from = result.type.value_or(Type::Real);
    result.type = name == "TRUNC" || name.ends_with("_TO_DINT") ? from.of(Type::Int)
                  : name.ends_with("_TO_LREAL")                 ? from.of(Type::Real)
                                                                : result.type;
    return result;
  }
  for (const Value& one : arguments) {
    result.type = result.type ? result.type : one.type;
  }
  if (own->op == language::Operator::Not) {
    result.text = negated(arguments.front().text);
    return result;
  }
  result.type = own->is_comparison ? result.type.value_or(Type::Bool).of(Type::Bool) : result.type;
  result.text = arguments.front().text;
  for (std::size_t i = 1; i < arguments.size(); ++i) {
    const std::string& left = own->is_comparison ? arguments[i - 1].text : result.text;
    const std::string pair = fmt::format("({} {} {})", left, own->symbol, arguments[i].text);
    result.text = own->is_comparison && i > 1 ? fmt::format("({} AND {})", result.text, pair) : pair;
  }
  return result;
}

std::string wrong_count(const plcopen::OperatorFunction* own, std::string_view name, std::size_t count) {
  const bool is_not = own != nullptr && own->op == language::Operator::Not;
  const bool several = (own != nullptr && !is_not) || name == "MIN" || name == "MAX";
  if (several && count < 2) {
    return "it has one input, and takes two";
  }
  const bool extends =
      own == nullptr || own->takes_more || (own->is_comparison && own->op != language::Operator::NotEqual);
  if (const std::size_t most = is_not ? 1 : 2; !extends && count > most) {
    return fmt::format("it has {} inputs, and {} takes {}", count, name, most == 1 ? "one" : "two");
  }
  return "";
}

std::optional<std::size_t> place_of_input(std::string_view function, std::string_view input, std::size_t next) {
  if (const auto place = plcopen::place_of(function, input)) {
    return place;
  }
  const bool counted = input.size() >= 2 && equal_ignoring_case(input.substr(0, 2), "IN") &&
                       input.find_first_not_of("0123456789", 2) == std::string_view::npos;
  return input.empty() || counted ? std::optional(next) : std::nullopt;
}

std::string negated(const std::string& text) {
  return fmt::format("(NOT {})", text);
}

std::optional<Carried> type_of_text(const Variables& variables, const std::string& text) {
  const auto bracket = text.ends_with(']') ? text.find('[') : std::string::npos;
  const auto variable = variables.find(in_capitals(trimmed(std::string_view(text).substr(0, bracket))));
  if (variable != variables.end()) {
    const auto known = known_type(variable->second->type);
    if (!known) {
      return std::nullopt;
    }
    return bracket == std::string::npos ? known->carried : Carried(known->carried.type);
  }
  const auto literal = type_of_literal(with_known_literals(text));
  return literal ? std::optional<Carried>(*literal) : std::nullopt;
}

std::optional<Carried> result_type(const DrawnPou& pou, const Variables& variables, const DrawnElement& function) {
  const plcopen::OperatorFunction* const own = plcopen::operator_of(function.text);
  if (own != nullptr && own->is_comparison) {
    return Carried(Type::Bool);
  }
  for (const DrawnPin& pin : function.inputs) {
    for (const Link& link : pin.links) {
      const DrawnElement* const found = find_element(pou, link.element);
      if (found != nullptr && found->kind == tc6::in_variable && !equal_ignoring_case(pin.name, "G")) {
        if (const auto type = type_of_text(variables, found->text)) {
          return type;
        }
      }
    }
  }
  return std::nullopt;
}

bool has_input(const DrawnPou* own, const BlockType* block, std::string_view pin) {
  if (own != nullptr) {
    return std::ranges::any_of(own->variables, [&](const DrawnVariable& one) {
      using Section = DrawnVariable::Section;
      return (one.section == Section::Input || one.section == Section::Both) && equal_ignoring_case(one.name, pin);
    });
  }
  for (std::size_t i = 0; i < block->pin_count(); ++i) {
    if (equal_ignoring_case(block->pin(i).name, pin)) {
      return true;
    }
  }
  return false;
}

std::optional<Type> output_type(std::string_view block, std::string_view pin) {
  if (const BlockType* const known = known_block(block)) {
    for (const Field& field : known->outputs) {
      if (equal_ignoring_case(field.name, pin)) {
        return field.type;
      }
    }
  }
  return std::nullopt;
}

}  // namespace hysteron::import
