#include "codegen/graph/vectors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <unordered_map>
#include <utility>
#include <variant>
#include <vector>

#include "codegen/graph/definition.hpp"
#include "codegen/graph/lowering.hpp"
#include "codegen/graph/vector_pins.hpp"
#include "codegen/trace/sized_block.hpp"
#include "support/errors.hpp"

namespace hysteron {
namespace {

using language::Argument;
using language::Assignment;
using language::Call;
using language::Expression;
using language::ExpressionId;
using language::FunctionBlock;
using language::Name;
using language::no_expression;
using language::Operator;
using language::Reference;
using language::same_name;
using language::SourceFile;
using language::Span;
using language::upper;
using language::Variable;

/// A value: one expression, or one for each element.
struct Elements {
  std::vector<ExpressionId> elements{};
  bool vector = false;
  [[nodiscard]] ExpressionId at(std::size_t i) const { return vector ? elements[i] : elements.front(); }
};

class VectorExpansion {
 public:
  VectorExpansion(const SourceFile& written, Diagnostics& diagnostics)
      : written_(written),
        file_(written),
        diagnostics_(diagnostics),
        pins_(written, [this](auto&&... what) { error(std::forward<decltype(what)>(what)...); }) {
    file_.names = std::make_shared<std::deque<std::string>>();
    file_.has_vectors = false;
  }

  SourceFile run() {
    for (std::size_t i = 0; i < file_.blocks.size(); ++i) {
      if (!file_.blocks[i].sequential) {
        declare(written_.blocks[i]);
      }
    }
    for (std::size_t i = 0; i < file_.blocks.size(); ++i) {
      if (!file_.blocks[i].sequential) {
        block_ = &written_.blocks[i];
        expand(file_.blocks[i]);
      }
    }
    return std::move(file_);
  }

 private:
  void error(int number, Span span, std::string cause, std::string mend) {
    diagnostics_.error(number, written_.place(span), std::move(cause), std::move(mend));
  }
  std::string_view keep(std::string text) { return file_.names->emplace_back(std::move(text)); }
  Name element(const Name& vector, std::size_t index) {
    return {keep(element_name(vector.text, static_cast<std::int64_t>(index))), vector.span};
  }
  ExpressionId make(Expression expression) {
    file_.expressions.push_back(std::move(expression));
    return static_cast<ExpressionId>(file_.expressions.size() - 1);
  }
  [[nodiscard]] Span span_of(ExpressionId id) const { return file_.expressions[id].span; }

  void declare(const FunctionBlock& block) {
    block_ = &block;
    for (const Variable& variable : block.variables) {
      pins_.declare(block, variable, variable.is_vector() ? length_of(variable) : 0);
    }
    pins_.declare_sized(block);
  }

  /// 1 where the bounds were refused: the rest of the text is read as if they were right.
  std::uint32_t length_of(const Variable& variable) {
    std::int64_t first = 0;
    std::int64_t last = 0;
    if (!whole_constant(variable.first, first) || !whole_constant(variable.last, last)) {
      error(error::vector_bounds, span_of(variable.first),
            fmt::format("the bounds of the vector '{}' are not whole constants", variable.name.text),
            "Write whole numbers, or a DINT of VAR CONSTANT: ARRAY[0..3], ARRAY[0..N - 1].");
    } else if (first != 0) {
      error(error::vector_bounds, span_of(variable.first),
            fmt::format("the vector '{}' begins at {}", variable.name.text, first),
            fmt::format("In a diagram a vector begins at 0: ARRAY[0..{}].", std::max<std::int64_t>(last - first, 0)));
    } else if (last < 0 || last >= longest_vector) {
      error(error::vector_bounds, span_of(variable.last),
            last < 0 ? fmt::format("the vector '{}' ends at {}, before it begins", variable.name.text, last)
                     : fmt::format("the vector '{}' has {} elements; {} are the most", variable.name.text, last + 1,
                                   longest_vector),
            last < 0 ? "Write the greatest index: ARRAY[0..3] has four elements."
                     : "Every element is a variable of the step: use fewer.");
    } else {
      return static_cast<std::uint32_t>(last) + 1;
    }
    return 1;
  }

  /// A constant that may name the constants of the block.
  bool whole_constant(ExpressionId id, std::int64_t& value) {
    Graph scratch;
    GraphBuilder builder(scratch);
    const auto resolve = [&](const Reference& reference, Span /*span*/) -> Wire {
      double number = 0.0;
      Type type = Type::Real;
      for (const Variable& variable : block_->variables) {
        const bool constant = variable.section == language::Section::Constant && !variable.is_vector() &&
                              variable.initial != no_expression;
        if (constant && reference.pin.text.empty() && same_name(variable.name.text, reference.name.text) &&
            constant_value(written_, variable.initial, number, type)) {
          return builder.literal(type, number);
        }
      }
      return {};
    };
    Lowering lowering(builder, file_, resolve, [](int, auto, auto, auto) {});
    const Wire wire = lowering.lower(id, "");
    if (wire.from != Wire::From::Literal || wire.type != Type::Int) {
      return false;
    }
    value = static_cast<std::int64_t>(scratch.literals[wire.index]);
    return true;
  }

  void expand(FunctionBlock& block) {
    std::vector<Variable> variables;
    for (Variable& variable : block.variables) {
      expand_variable(variable, variables);
    }
    block.variables = std::move(variables);
    std::vector<language::Statement> statements;
    block.origins.clear();
    for (std::uint32_t i = 0; i < block.statements.size(); ++i) {
      if (const auto* call = std::get_if<Call>(&block.statements[i])) {
        statements.emplace_back(expand_call(*call));
      } else {
        expand_assignment(std::get<Assignment>(block.statements[i]), statements);
      }
      block.origins.resize(statements.size(), i);
    }
    block.statements = std::move(statements);
  }

  void expand_variable(const Variable& written, std::vector<Variable>& variables) {
    const PinShape shape = pins_.variable(*block_, written.name.text);
    Variable variable = written;
    variable.settings = expand_arguments(written, written.settings);
    if (const std::string_view sized = pins_.sized_type(*block_, written.name.text); !sized.empty()) {
      variable.type.text = keep(std::string(sized));
    }
    if (!written.is_vector()) {
      variables.push_back(std::move(variable));
      return;
    }
    variable.first = variable.last = no_expression;
    std::optional<Elements> initial;
    if (written.initial != no_expression) {
      initial = fitting(written.initial, shape, fmt::format("the vector '{}'", written.name.text));
    }
    for (std::uint32_t i = 0; i < shape.length; ++i) {
      variables.push_back(variable);
      variables.back().name = element(written.name, i);
      variables.back().initial = initial ? initial->at(i) : no_expression;
    }
  }

  Call expand_call(const Call& call) {
    Call result{.instance = call.instance, .arguments = {}, .span = call.span};
    for (const Variable& variable : block_->variables) {
      if (same_name(variable.name.text, call.instance.text)) {
        result.arguments = expand_arguments(variable, call.arguments);
        return result;
      }
    }
    return call;  // what is not declared is told by who looks for it
  }

  std::vector<Argument> expand_arguments(const Variable& instance, const std::vector<Argument>& arguments) {
    std::vector<Argument> result;
    for (const Argument& argument : arguments) {
      const auto shape = pins_.pin(*block_, instance, argument.pin.text);
      const bool list = std::holds_alternative<language::ArrayLiteral>(file_.expressions[argument.value].node);
      const bool setting = VectorPins::is_setting(instance, argument.pin.text);
      if (!shape || setting || (shape->list && list)) {
        result.push_back(argument);
        continue;
      }
      const auto value =
          fitting(argument.value, *shape, fmt::format("{}.{}", instance.name.text, upper(argument.pin.text)));
      if (!value) {
        continue;
      }
      for (std::size_t i = 0; i < value->elements.size(); ++i) {
        const Name pin = shape->length == 0
                             ? argument.pin
                             : Name{keep(element_name(argument.pin.text, shape->low + static_cast<std::int64_t>(i))),
                                    argument.pin.span};
        result.push_back({.pin = pin, .value = value->elements[i]});
      }
    }
    return result;
  }

  void expand_assignment(const Assignment& written, std::vector<language::Statement>& statements) {
    const PinShape shape = pins_.variable(*block_, written.target.text);
    Assignment assignment = written;
    assignment.index = no_expression;
    PinShape wanted = shape;
    std::string target = fmt::format("'{}'", written.target.text);
    if (written.index != no_expression) {
      const auto at = index(written.index, shape, written.target);
      if (!at) {
        return;
      }
      assignment.target = element(written.target, *at);
      target = fmt::format("'{}'", assignment.target.text);
      wanted = {};
    }
    const auto value = fitting(written.value, wanted, target);
    if (!value) {
      return;
    }
    for (std::size_t i = 0; i < value->elements.size(); ++i) {
      assignment.target = wanted.length > 0 ? element(written.target, i) : assignment.target;
      assignment.value = value->elements[i];
      statements.emplace_back(assignment);
    }
  }

  /// The value for a place of a shape; none where an error was reported.
  std::optional<Elements> fitting(ExpressionId id, const PinShape& shape, const std::string& target) {
    auto result = value(id);
    if (!result) {
      return std::nullopt;
    }
    if (shape.length == 0 && result->vector) {
      error(error::vector_for_value, span_of(id),
            fmt::format("{} takes one value, here is a vector of {}", target, result->elements.size()),
            "Name one element, V[0], or make one value of the vector: SUM(V), DOT(V, W), NORM(V).");
      return std::nullopt;
    }
    if (shape.length > 0 && !result->vector) {
      error(error::scalar_for_vector, span_of(id),
            fmt::format("{} takes a vector of {}, here is one value", target, shape.length),
            fmt::format("Give a vector of {}, or a list of the elements: [A, B, …]; an element by itself is set by its "
                        "index.",
                        shape.length));
      return std::nullopt;
    }
    if (shape.length > 0 && result->elements.size() != shape.length) {
      error(error::vector_size, span_of(id),
            fmt::format("{} has {} element{}, the value has {}", target, shape.length, shape.length == 1 ? "" : "s",
                        result->elements.size()),
            "Declare both with the same size.");
      return std::nullopt;
    }
    return result;
  }

  std::optional<Elements> value(ExpressionId id) {
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
      }
      return result;
    }
    return Elements{.elements = {id}};
  }

  std::optional<Elements> value_of(const Reference& reference, ExpressionId id) {
    PinShape shape = pins_.variable(*block_, reference.name.text);
    const bool pin = !reference.pin.text.empty();
    if (pin) {
      for (const Variable& variable : block_->variables) {
        if (same_name(variable.name.text, reference.name.text)) {
          shape = pins_.pin(*block_, variable, reference.pin.text).value_or(PinShape{});
        }
      }
    }
    const Name& named = pin ? reference.pin : reference.name;
    const Span span = span_of(id);
    const auto one = [&](std::int64_t index) {
      Reference element = reference;
      element.index = no_expression;
      Name& own = pin ? element.pin : element.name;
      own.text = keep(element_name(named.text, shape.low + index));
      return make({.node = element, .span = span});
    };
    if (reference.index != no_expression) {
      const auto at = index(reference.index, shape, named);
      return !at ? std::nullopt : std::optional(Elements{.elements = {one(*at)}});
    }
    if (shape.length == 0) {
      return Elements{.elements = {id}};
    }
    Elements result{.elements = {}, .vector = true};
    for (std::uint32_t i = 0; i < shape.length; ++i) {
      result.elements.push_back(one(i));
    }
    return result;
  }

  /// The place of an element within its vector, from 0.
  std::optional<std::uint32_t> index(ExpressionId id, const PinShape& shape, const Name& name) {
    if (shape.length == 0) {
      error(error::vector_index, span_of(id), fmt::format("'{}' is no vector and has no elements", name.text),
            "Leave the brackets away, or declare it as ARRAY[0..3] OF LREAL.");
      return std::nullopt;
    }
    std::int64_t at = 0;
    const std::int64_t last = shape.low + shape.length - 1;
    if (!whole_constant(id, at)) {
      error(error::vector_index, span_of(id), fmt::format("the index of '{}' is not a whole constant", name.text),
            fmt::format("Write a number from {} to {} or a DINT of VAR CONSTANT. Which element is meant, a signal "
                        "chooses by MUX(K, {}[{}], …), or in a block with (* @body *) behind its name.",
                        shape.low, last, name.text, shape.low));
      return std::nullopt;
    }
    if (at < shape.low || at > last) {
      error(error::vector_index, span_of(id),
            fmt::format("'{}' has the elements {} to {}, not {}", name.text, shape.low, last, at),
            fmt::format("Write an index from {} to {}.", shape.low, last));
      return std::nullopt;
    }
    return static_cast<std::uint32_t>(at - shape.low);
  }

  std::optional<Elements> value_of(const language::Binary& binary, Span span, ExpressionId id) {
    const auto left = value(binary.left);
    const auto right = value(binary.right);
    if (!left || !right) {
      return std::nullopt;
    }
    if ((left->vector || right->vector) && (binary.op == Operator::Equal || binary.op == Operator::NotEqual)) {
      error(error::vector_for_value, span,
            "whether vectors are equal can be meant for each element, or for all of them",
            "Compare elements, V[0] = W[0], or a distance: NORM(V - W) < 0.001.");
      return std::nullopt;
    }
    return each({*left, *right}, span, id, [&](const auto& one) -> Expression {
      return {.node = language::Binary{binary.op, one[0], one[1]}, .span = span};
    });
  }

  std::optional<Elements> value_of(const language::FunctionCall& call, Span span, ExpressionId id) {
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
  std::optional<Elements> reduced(const std::string& name, const language::FunctionCall& call,
                                  const std::vector<Elements>& values, Span span) {
    const std::size_t wanted = name == "DOT" ? 2 : 1;
    const bool positions =
        std::ranges::all_of(call.arguments, [](const auto& argument) { return argument.formal.text.empty(); });
    if (values.size() != wanted || !positions) {
      error(error::unknown_function, span,
            fmt::format("{} takes {} and no names of them", name, wanted == 2 ? "two vectors" : "one vector"),
            wanted == 2 ? "Write DOT(V, W)." : fmt::format("Write {}(V).", name));
      return std::nullopt;
    }
    for (std::size_t i = 0; i < wanted; ++i) {
      if (!values[i].vector) {
        error(error::scalar_for_vector, span_of(call.arguments[i].value),
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

  std::optional<Elements> sizes_differ(std::size_t a, std::size_t b, Span span) {
    error(error::vector_size, span, fmt::format("vectors of {} and of {} elements stand together", a, b),
          "Give both the same size; one value stands for every element.");
    return std::nullopt;
  }

  /// An operation for each element; one value stands for every element.
  template <class Make>
  std::optional<Elements> each(const std::vector<Elements>& operands, Span span, ExpressionId id, Make make_one) {
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
    Elements result{.elements = {}, .vector = vector != nullptr};
    for (std::size_t i = 0; i < (vector != nullptr ? vector->elements.size() : 1); ++i) {
      std::vector<ExpressionId> one;
      for (const Elements& operand : operands) {
        one.push_back(operand.at(i));
      }
      result.elements.push_back(make(make_one(one)));
    }
    return result;
  }

  const SourceFile& written_;
  SourceFile file_;  ///< that is being made
  Diagnostics& diagnostics_;
  VectorPins pins_;
  const FunctionBlock* block_ = nullptr;
};

}  // namespace

std::shared_ptr<const SourceFile> expand_vectors(std::shared_ptr<const SourceFile> source, Diagnostics& diagnostics) {
  const auto is_sized = [](const Variable& variable) { return find_sized_kind(variable.type.text) != nullptr; };
  const bool sized = std::ranges::any_of(source->blocks, [&](const language::FunctionBlock& block) {
    return std::ranges::any_of(block.variables, is_sized);
  });
  if (!source->has_vectors && !sized && source->bodies == nullptr) {
    return source;
  }
  return std::make_shared<const SourceFile>(VectorExpansion(*source, diagnostics).run());
}

}  // namespace hysteron
