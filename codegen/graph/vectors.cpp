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
#include "codegen/graph/vector_values.hpp"
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

class VectorExpansion {
 public:
  VectorExpansion(const SourceFile& written, Diagnostics& diagnostics)
      : written_(written),
        file_(written),
        diagnostics_(diagnostics),
        pins_(written, [this](auto&&... what) { error(std::forward<decltype(what)>(what)...); }),
        values_(written, file_, pins_, [this](auto&&... what) { error(std::forward<decltype(what)>(what)...); }) {
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
        values_.enter(written_.blocks[i]);
        expand(file_.blocks[i]);
      }
    }
    return std::move(file_);
  }

 private:
  void error(int number, Span span, std::string cause, std::string mend) {
    diagnostics_.error(number, written_.place(span), std::move(cause), std::move(mend));
  }
  void declare(const FunctionBlock& block) {
    values_.enter(block);
    for (const Variable& variable : block.variables) {
      pins_.declare(block, variable, variable.is_vector() ? length_of(variable) : 0);
    }
    pins_.declare_sized(block);
  }

  /// 1 where the bounds were refused: the rest of the text is read as if they were right.
  std::uint32_t length_of(const Variable& variable) {
    std::int64_t first = 0;
    std::int64_t last = 0;
    if (!values_.whole_constant(variable.first, first) || !values_.whole_constant(variable.last, last)) {
      error(error::vector_bounds, values_.span_of(variable.first),
            fmt::format("the bounds of the vector '{}' are not whole constants", variable.name.text),
            "Write whole numbers, or a DINT of VAR CONSTANT: ARRAY[0..3], ARRAY[0..N - 1].");
    } else if (first != 0) {
      error(error::vector_bounds, values_.span_of(variable.first),
            fmt::format("the vector '{}' begins at {}", variable.name.text, first),
            fmt::format("In a diagram a vector begins at 0: ARRAY[0..{}].", std::max<std::int64_t>(last - first, 0)));
    } else if (last < 0 || last >= longest_vector) {
      error(error::vector_bounds, values_.span_of(variable.last),
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
    const PinShape shape = pins_.variable(values_.block(), written.name.text);
    Variable variable = written;
    variable.settings = expand_arguments(written, written.settings);
    if (const std::string_view sized = pins_.sized_type(values_.block(), written.name.text); !sized.empty()) {
      variable.type.text = values_.keep(std::string(sized));
    }
    if (!written.is_vector()) {
      variables.push_back(std::move(variable));
      return;
    }
    variable.first = variable.last = no_expression;
    std::optional<Elements> initial;
    if (written.initial != no_expression) {
      initial = values_.fitting(written.initial, shape, fmt::format("the vector '{}'", written.name.text));
    }
    for (std::uint32_t i = 0; i < shape.length; ++i) {
      variables.push_back(variable);
      variables.back().name = values_.element(written.name, i);
      variables.back().initial = initial ? initial->at(i) : no_expression;
    }
  }

  Call expand_call(const Call& call) {
    Call result = call;
    if (const Variable* const instance = values_.find_variable(call.instance.text)) {
      result.arguments = expand_arguments(*instance, call.arguments);
    }
    return result;  // what is not declared is told by who looks for it
  }

  std::vector<Argument> expand_arguments(const Variable& instance, const std::vector<Argument>& arguments) {
    std::vector<Argument> result;
    for (const Argument& argument : arguments) {
      const auto shape = pins_.pin(values_.block(), instance, argument.pin.text);
      const bool list = std::holds_alternative<language::ArrayLiteral>(file_.expressions[argument.value].node);
      const bool setting = VectorPins::is_setting(instance, argument.pin.text);
      if (!shape || setting || (shape->list && list)) {
        result.push_back(argument);
        continue;
      }
      const auto value =
          values_.fitting(argument.value, *shape, fmt::format("{}.{}", instance.name.text, upper(argument.pin.text)));
      if (!value) {
        continue;
      }
      for (std::size_t i = 0; i < value->elements.size(); ++i) {
        const Name pin =
            shape->length == 0
                ? argument.pin
                : Name{values_.keep(element_name(argument.pin.text, shape->low + static_cast<std::int64_t>(i))),
                       argument.pin.span};
        result.push_back({.pin = pin, .value = value->elements[i]});
      }
    }
    return result;
  }

  void expand_assignment(const Assignment& written, std::vector<language::Statement>& statements) {
    if (values_.find_variable(written.target.text) == nullptr) {  // told by who looks for it
      Assignment unknown = written;
      unknown.index = no_expression;
      statements.emplace_back(unknown);
      return;
    }
    const PinShape shape = pins_.variable(values_.block(), written.target.text);
    Assignment assignment = written;
    assignment.index = no_expression;
    PinShape wanted = shape;
    std::string target = fmt::format("'{}'", written.target.text);
    if (written.index != no_expression) {
      const auto at = values_.index(written.index, shape, written.target.text);
      if (!at) {
        return;
      }
      assignment.target = values_.element(written.target, *at);
      target = fmt::format("'{}'", assignment.target.text);
      wanted = {};
    }
    const auto value = values_.fitting(written.value, wanted, target);
    if (!value) {
      return;
    }
    for (std::size_t i = 0; i < value->elements.size(); ++i) {
      assignment.target = wanted.length > 0 ? values_.element(written.target, i) : assignment.target;
      assignment.value = value->elements[i];
      statements.emplace_back(assignment);
    }
  }

  const SourceFile& written_;
  SourceFile file_;  ///< that is being made
  Diagnostics& diagnostics_;
  VectorPins pins_;
  VectorValues values_;
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
