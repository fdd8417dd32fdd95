#include "codegen/graph/vector_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <utility>
#include <variant>

#include "codegen/graph/definition.hpp"
#include "codegen/graph/lowering.hpp"
#include "support/element_name.hpp"
#include "support/errors.hpp"

namespace hysteron {

using language::Expression;
using language::ExpressionId;
using language::Name;
using language::no_expression;
using language::Operator;
using language::Reference;
using language::same_name;
using language::Span;
using language::upper;
using language::Variable;

Name VectorValues::element(const Name& vector, std::size_t index) {
  return {keep(element_name(vector.text, static_cast<std::int64_t>(index))), vector.span};
}

const Variable* VectorValues::find_variable(std::string_view name) const {
  const auto found = std::ranges::find_if(
      block_->variables, [&](const Variable& variable) { return same_name(variable.name.text, name); });
  return found == block_->variables.end() ? nullptr : &*found;
}

ExpressionId VectorValues::make(Expression expression) {
  file_.expressions.push_back(std::move(expression));
  return static_cast<ExpressionId>(file_.expressions.size() - 1);
}

bool VectorValues::whole_constant(ExpressionId id, std::int64_t& value) {
  Graph scratch;
  GraphBuilder builder(scratch);
  const auto resolve = [&](const Reference& reference, Span /*span*/) -> Wire {
    double number = 0.0;
    Type type = Type::Real;
    const Variable* const variable = reference.pin.text.empty() ? find_variable(reference.name.text) : nullptr;
    const bool constant = variable != nullptr && variable->section == language::Section::Constant &&
                          !variable->is_vector() && variable->initial != no_expression;
    return constant && constant_value(written_, variable->initial, number, type) ? builder.literal(type, number)
                                                                                 : Wire{};
  };
  Lowering lowering(builder, file_, resolve, [](int, auto, auto, auto) {});
  const Wire wire = lowering.lower(id, "");
  if (wire.from != Wire::From::Literal || wire.type != Type::Int) {
    return false;
  }
  value = static_cast<std::int64_t>(scratch.literals[wire.index]);
  return true;
}

std::optional<Elements> VectorValues::fitting(ExpressionId id, const PinShape& shape, const std::string& target) {
  auto result = value(id);
  if (!result) {
    return std::nullopt;
  }
  if (result->unknown) {
    result->vector = shape.length > 0;
    result->elements.assign(std::max(shape.length, 1U), result->elements.front());
    return result;
  }
  if (shape.length == 0 && result->vector) {
    error_(error::vector_for_value, span_of(id),
           fmt::format("{} takes one value, here is a vector of {}", target, result->elements.size()),
           "Name one element, V[0], or make one value of the vector: SUM(V), DOT(V, W), NORM(V).");
    return std::nullopt;
  }
  if (shape.length > 0 && !result->vector) {
    error_(error::scalar_for_vector, span_of(id),
           fmt::format("{} takes a vector of {}, here is one value", target, shape.length),
           fmt::format("Give a vector of {}, or a list of the elements: [A, B, …]; an element by itself is set by its "
                       "index.",
                       shape.length));
    return std::nullopt;
  }
  if (shape.length > 0 && result->elements.size() != shape.length) {
    error_(error::vector_size, span_of(id),
           fmt::format("{} has {} element{}, the value has {}", target, shape.length, shape.length == 1 ? "" : "s",
                       result->elements.size()),
           "Declare both with the same size.");
    return std::nullopt;
  }
  return result;
}

std::optional<Elements> VectorValues::value(ExpressionId id) {
  const Expression written = file_.expressions[id];  // a copy: the list grows
  if (const auto* reference = std::get_if<Reference>(&written.node)) {
    return value_of(*reference, id);
  }
  if (const auto* unary = std::get_if<language::Unary>(&written.node)) {
    const auto operand = value(unary->operand);
    return !operand ? std::nullopt : each({*operand}, written.span, id, [&](const auto& one) -> Expression {
      return {.node = language::Unary{unary->op, one[0]}, .span = written.span};
    });
  }
  if (const auto* binary = std::get_if<language::Binary>(&written.node)) {
    return value_of(*binary, written.span, id);
  }
  if (const auto* call = std::get_if<language::FunctionCall>(&written.node)) {
    return value_of(*call, written.span, id);
  }
  if (const auto* list = std::get_if<language::ArrayLiteral>(&written.node)) {
    Elements result{.elements = {}, .vector = true};
    for (const ExpressionId element : list->elements) {
      const auto one = fitting(element, {}, "An element of a list");
      if (!one) {
        return std::nullopt;
      }
      result.elements.push_back(one->elements.front());
      result.unknown = result.unknown || one->unknown;
    }
    return result;
  }
  return Elements{.elements = {id}};
}

std::optional<Elements> VectorValues::value_of(const Reference& reference, ExpressionId id) {
  const bool pin = !reference.pin.text.empty();
  const Variable* const variable = find_variable(reference.name.text);
  const std::optional<PinShape> shape = variable == nullptr ? std::nullopt
                                        : pin               ? pins_.pin(*block_, *variable, reference.pin.text)
                                                            : pins_.variable(*block_, variable->name.text);
  const Name& named = pin ? reference.pin : reference.name;
  const Span span = span_of(id);
  Reference element = reference;
  element.index = no_expression;
  if (!shape) {
    return Elements{.elements = {make({.node = element, .span = span})}, .unknown = true};
  }
  const auto one = [&](std::int64_t index) {
    (pin ? element.pin : element.name).text = keep(element_name(named.text, shape->low + index));
    return make({.node = element, .span = span});
  };
  if (reference.index != no_expression) {
    const auto at =
        index(reference.index, *shape,
              pin ? fmt::format("{}.{}", reference.name.text, reference.pin.text) : std::string(reference.name.text));
    return !at ? std::nullopt : std::optional(Elements{.elements = {one(*at)}});
  }
  if (shape->length == 0) {
    return Elements{.elements = {id}};
  }
  Elements result{.elements = {}, .vector = true};
  for (std::uint32_t i = 0; i < shape->length; ++i) {
    result.elements.push_back(one(i));
  }
  return result;
}

std::optional<std::uint32_t> VectorValues::index(ExpressionId id, const PinShape& shape, std::string_view named) {
  if (shape.length == 0) {
    // What has a dot is a pin, whose shape its block says.
    error_(error::vector_index, span_of(id), fmt::format("'{}' is no vector and has no elements", named),
           named.find('.') == std::string_view::npos ? "Leave the brackets away, or declare it as ARRAY[0..3] OF LREAL."
                                                     : "Leave the brackets away: this pin is one value.");
    return std::nullopt;
  }
  std::int64_t at = 0;
  const std::int64_t last = shape.low + shape.length - 1;
  if (!whole_constant(id, at)) {
    error_(error::vector_index, span_of(id), fmt::format("the index of '{}' is not a whole constant", named),
           fmt::format("Write a number from {} to {} or a DINT of VAR CONSTANT. Which element is meant, a signal "
                       "chooses by MUX(K, {}[{}], …), or in a block with (* @body *) behind its name.",
                       shape.low, last, named, shape.low));
    return std::nullopt;
  }
  if (at < shape.low || at > last) {
    error_(error::vector_index, span_of(id),
           fmt::format("'{}' has the elements {} to {}, not {}", named, shape.low, last, at),
           fmt::format("Write an index from {} to {}.", shape.low, last));
    return std::nullopt;
  }
  return static_cast<std::uint32_t>(at - shape.low);
}

std::optional<Elements> VectorValues::value_of(const language::Binary& binary, Span span, ExpressionId id) {
  const auto left = value(binary.left);
  const auto right = value(binary.right);
  if (!left || !right) {
    return std::nullopt;
  }
  if (binary.bit >= 0 && left->vector) {
    const auto name = file_.text_of(span);
    const auto vector = name.substr(0, name.rfind('.'));
    error_(error::vector_for_value, span,
           fmt::format("whether '{}' is an element or a bit of each element can be meant", name),
           fmt::format("Write {}[{}] for an element, {}[0].{} for a bit of one.", vector,
                       std::min<std::size_t>(static_cast<std::size_t>(binary.bit), left->elements.size() - 1), vector,
                       binary.bit));
    return std::nullopt;
  }
  if ((left->vector || right->vector) && (binary.op == Operator::Equal || binary.op == Operator::NotEqual)) {
    error_(error::vector_for_value, span, "whether vectors are equal can be meant for each element, or for all of them",
           "Compare elements, V[0] = W[0], or a distance: NORM(V - W) < 0.001.");
    return std::nullopt;
  }
  return each({*left, *right}, span, id, [&](const auto& one) -> Expression {
    return {.node = language::Binary{binary.op, one[0], one[1], binary.bit}, .span = span};
  });
}

std::optional<Elements> VectorValues::value_of(const language::FunctionCall& call, Span span, ExpressionId id) {
  std::vector<Elements> values;
  for (const auto& argument : call.arguments) {
    const auto one = value(argument.value);
    if (!one) {
      return std::nullopt;
    }
    values.push_back(*one);
  }
  const std::string name = upper(call.function.text);
  if (name == "SUM" || name == "NORM" || name == "DOT") {
    return reduced(name, call, values, span);
  }
  return each(values, span, id, [&](const auto& one) -> Expression {
    language::FunctionCall element = call;
    for (std::size_t i = 0; i < one.size(); ++i) {
      element.arguments[i].value = one[i];
    }
    return {.node = std::move(element), .span = span};
  });
}

/// SUM(V) = ((v0 + v1) + v2) + …, DOT(V, W) = SUM(V * W), NORM(V) = SQRT(DOT(V, V)).
std::optional<Elements> VectorValues::reduced(const std::string& name, const language::FunctionCall& call,
                                              const std::vector<Elements>& values, Span span) {
  const std::size_t wanted = name == "DOT" ? 2 : 1;
  const bool positions =
      std::ranges::all_of(call.arguments, [](const auto& argument) { return argument.formal.text.empty(); });
  if (values.size() != wanted || !positions) {
    error_(error::unknown_function, span,
           fmt::format("{} takes {} and no names of them", name, wanted == 2 ? "two vectors" : "one vector"),
           wanted == 2 ? "Write DOT(V, W)." : fmt::format("Write {}(V).", name));
    return std::nullopt;
  }
  for (std::size_t i = 0; i < wanted; ++i) {
    if (values[i].unknown) {
      return values[i];
    }
    if (!values[i].vector) {
      error_(error::scalar_for_vector, span_of(call.arguments[i].value),
             fmt::format("{} takes a vector, here is one value", name),
             "Name a vector, or write a list: [A, B, C]. One value is its own sum.");
      return std::nullopt;
    }
  }
  const Elements& second = values[wanted - 1];
  if (values[0].elements.size() != second.elements.size()) {
    return sizes_differ(values[0].elements.size(), second.elements.size(), span);
  }
  ExpressionId total = no_expression;
  for (std::size_t i = 0; i < second.elements.size(); ++i) {
    const ExpressionId one =
        name == "SUM" ? values[0].elements[i]
                      : make({.node = language::Binary{Operator::Multiply, values[0].elements[i], second.elements[i]},
                              .span = span});
    total = total == no_expression ? one : make({.node = language::Binary{Operator::Add, total, one}, .span = span});
  }
  if (name == "NORM") {
    language::FunctionCall root{.function = {"SQRT", call.function.span},
                                .arguments = {{.formal = {}, .value = total}}};
    total = make({.node = std::move(root), .span = span});
  }
  return Elements{.elements = {total}};
}

std::optional<Elements> VectorValues::sizes_differ(std::size_t a, std::size_t b, Span span) {
  error_(error::vector_size, span, fmt::format("vectors of {} and of {} elements stand together", a, b),
         "Give both the same size; one value stands for every element.");
  return std::nullopt;
}

/// An operation for each element; one value stands for every element.
template <class Make>
std::optional<Elements> VectorValues::each(const std::vector<Elements>& operands, Span span, ExpressionId id,
                                           Make make_one) {
  if (operands.empty()) {
    return Elements{.elements = {id}};
  }
  const Elements* vector = nullptr;
  for (const Elements& one : operands) {
    if (one.vector && vector != nullptr && vector->elements.size() != one.elements.size()) {
      return sizes_differ(vector->elements.size(), one.elements.size(), span);
    }
    vector = one.vector ? &one : vector;
  }
  Elements result{.elements = {},
                  .vector = vector != nullptr,
                  .unknown = std::ranges::any_of(operands, [](const Elements& one) { return one.unknown; })};
  for (std::size_t i = 0; i < (vector != nullptr ? vector->elements.size() : 1); ++i) {
    std::vector<ExpressionId> one;
    one.reserve(operands.size());
    for (const Elements& operand : operands) {
      one.push_back(operand.at(i));
    }
    result.elements.push_back(make(make_one(one)));
  }
  return result;
}

}  // namespace hysteron
