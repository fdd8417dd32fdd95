#include "codegen/graph/vector_pins.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <variant>

#include "codegen/graph/body/body.hpp"
#include "codegen/graph/definition.hpp"
#include "codegen/graph/lowering.hpp"
#include "codegen/graph/names.hpp"
#include "codegen/graph/vectors.hpp"
#include "codegen/trace/sized_block.hpp"
#include "support/errors.hpp"

namespace hysteron {

using language::same_name;
using language::upper;

VectorPins::VectorPins(const language::SourceFile& source, Report report)
    : source_(source), report_(std::move(report)) {
  for (const language::FunctionBlock& block : source.blocks) {
    if (block.sequential) {
      read_border(block);
    }
  }
}

void VectorPins::read_border(const language::FunctionBlock& block) {
  Graph scratch;
  GraphBuilder builder(scratch);
  bodies::Body body(*source_.bodies, source_.bodies->units[block.body],
                    {.builder = builder,
                     .report = [](auto&&...) {},  // told where the block is defined
                     .add_parameter = [](const auto&) { return Wire{}; }});
  Shapes& shapes = shapes_[upper(block.name.text)];
  for (const bodies::BorderPort& port : body.ports(true)) {
    const auto element = element_of(port.name);
    if (!element) {
      shapes.emplace(upper(port.name), PinShape{});
      continue;
    }
    PinShape& shape = shapes.emplace(upper(element->vector), PinShape{.low = element->index}).first->second;
    ++shape.length;
    shapes.emplace(upper(element->vector) + "_OUT", shape).first->second.length = shape.length;
  }
}

void VectorPins::declare(const language::FunctionBlock& block, const language::Variable& variable,
                         std::uint32_t length) {
  shapes_[upper(block.name.text)].emplace(upper(variable.name.text), PinShape{.length = length});
}

PinShape VectorPins::variable(const language::FunctionBlock& block, std::string_view name) const {
  const auto shapes = shapes_.find(upper(block.name.text));
  if (shapes == shapes_.end()) {
    return {};
  }
  const auto found = shapes->second.find(upper(name));
  return found == shapes->second.end() ? PinShape{} : found->second;
}

std::optional<PinShape> VectorPins::pin(const language::FunctionBlock& block, const language::Variable& instance,
                                        std::string_view pin) const {
  if (const auto own = shapes_.find(upper(instance.type.text)); own != shapes_.end()) {
    const auto found = own->second.find(upper(pin));
    return found == own->second.end() ? std::nullopt : std::optional(found->second);
  }
  const std::string_view sized = sized_type(block, instance.name.text);
  const BlockType* const plain = find_block_type(instance.type.text);
  const BlockType* const type = plain != nullptr ? plain : find_sized_block(sized.empty() ? instance.type.text : sized);
  if (type == nullptr) {
    return find_sized_kind(instance.type.text) != nullptr ? std::nullopt : std::optional(PinShape{});
  }
  PinShape shape;
  const auto look_at = [&](const Field& field, bool parameter) {
    const auto element = element_of(field.name);
    if (same_name(field.name, pin)) {
      shape.list = parameter && (field.length > 1 || type->sized != nullptr);
      return true;
    }
    shape.length += element && same_name(element->vector, pin) ? 1U : 0U;
    return false;
  };
  for (std::size_t i = 0; i < type->pin_count(); ++i) {
    if (look_at(type->pin(i), i >= type->inputs.size())) {
      return shape;
    }
  }
  for (const Field& field : type->outputs) {
    if (look_at(field, false)) {
      return shape;
    }
  }
  return shape.length > 0 ? std::optional(shape) : std::nullopt;
}

std::string_view VectorPins::sized_type(const language::FunctionBlock& block, std::string_view name) const {
  const auto found = sized_.find({upper(block.name.text), upper(name)});
  return found == sized_.end() ? std::string_view() : std::string_view(found->second);
}

bool VectorPins::is_setting(const language::Variable& instance, std::string_view pin) {
  const SizedKind* const kind = find_sized_kind(instance.type.text);
  return kind != nullptr && std::ranges::any_of(kind->settings, [&](auto one) { return same_name(one, pin); });
}

std::optional<std::vector<double>> VectorPins::numbers_of(language::ExpressionId id) const {
  std::vector<language::ExpressionId> elements{id};
  if (const auto* list = std::get_if<language::ArrayLiteral>(&source_.expressions[id].node)) {
    elements = list->elements;
  }
  std::vector<double> numbers;
  for (const language::ExpressionId element : elements) {
    Type type = Type::Real;
    if (!constant_value(source_, element, numbers.emplace_back(), type)) {
      return std::nullopt;
    }
  }
  return numbers;
}

void VectorPins::declare_sized(const language::FunctionBlock& block) {
  for (const language::Variable& variable : block.variables) {
    const SizedKind* const kind = find_sized_kind(variable.type.text);
    if (kind == nullptr) {
      continue;
    }
    std::vector<GivenNumbers> given;
    std::vector<language::Span> spans;
    bool refused = false;
    const auto take = [&](const language::Argument& argument) {
      const auto is_it = [&](std::string_view name) { return same_name(name, argument.pin.text); };
      const bool parameter = std::ranges::any_of(kind->params, [&](const auto& one) { return is_it(one.field.name); });
      if (!parameter && std::ranges::none_of(kind->settings, is_it)) {
        return;
      }
      // Settings are counts, but for a discretised block, whose continuous numbers they are.
      if (double value = 0.0; !parameter && !kind->is_discretised) {
        Type type = Type::Int;
        if (constant_value(source_, argument.value, value, type) && type != Type::Int) {
          refused = true;
          report_(error::type_mismatch, source_.expressions[argument.value].span,
                  fmt::format("{} is DINT, the value is {}", upper(argument.pin.text), type_name(type)),
                  conversion_in_words(Type::Int, type));
          return;
        }
      }
      if (auto numbers = numbers_of(argument.value)) {
        given.push_back({.name = argument.pin.text, .numbers = std::move(*numbers)});
        spans.push_back(source_.expressions[argument.value].span);
      } else {
        refused = true;
        report_(error::type_mismatch, source_.expressions[argument.value].span,
                fmt::format("the value of {} is not a constant", upper(argument.pin.text)),
                "Write literals here, as in [1.0, 0.5]: how many there are is the size of the block.");
      }
    };
    std::ranges::for_each(variable.settings, take);
    for (const auto& statement : block.statements) {
      const auto* const call = std::get_if<language::Call>(&statement);
      if (call == nullptr || !same_name(call->instance.text, variable.name.text)) {
        continue;
      }
      for (const language::Argument& argument : call->arguments) {
        if (is_setting(variable, argument.pin.text)) {
          refused = true;
          report_(error::block_sizes, argument.pin.span,
                  fmt::format("{} is no pin of {} and cannot be given in a call", upper(argument.pin.text),
                              kind->about.name),
                  fmt::format("Give it in the declaration: {} : {} := ({} := …);", variable.name.text, kind->about.name,
                              upper(argument.pin.text)));
          continue;
        }
        take(argument);
      }
    }
    if (refused) {
      continue;
    }
    const auto sizes = sizes_of(*kind, given);
    if (const auto* problem = std::get_if<SizeProblem>(&sizes)) {
      language::Span span = variable.name.span;
      for (std::size_t i = 0; i < given.size(); ++i) {
        span = same_name(given[i].name, problem->name) ? spans[i] : span;
      }
      report_(error::block_sizes, span, fmt::format("'{}': {}", variable.name.text, problem->cause), problem->mend);
      continue;
    }
    sized_[{upper(block.name.text), upper(variable.name.text)}] = sized_type_text(*kind, std::get<Sizes>(sizes));
  }
}

}  // namespace hysteron
