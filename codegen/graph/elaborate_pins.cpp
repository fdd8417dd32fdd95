// Pins of instances: which there are, what they are given, and what stays unconnected.
#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <string_view>
#include <utility>

#include "codegen/graph/elaborator.hpp"
#include "codegen/graph/relations.hpp"
#include "codegen/trace/sized_block.hpp"
#include "support/element_name.hpp"
#include "support/names.hpp"

namespace hysteron {

void Elaborator::apply_settings(const Instance& instance, const Declared& declared, Part& part) {
  for (const language::Argument& setting : declared.variable->settings) {
    if (is_size_setting(declared, setting.pin.text)) {
      continue;
    }
    const Pin pin = find_pin(declared, setting.pin);
    if (!pin.found || !claim(declared, part, pin, setting)) {
      continue;
    }
    std::vector<double> values;
    if (constant_array(setting.value, pin.field, values, is_sized(declared))) {
      set_constant(instance, declared, part, pin, values, setting);
    }
  }
}

bool Elaborator::is_size_setting(const Declared& declared, std::string_view name) {
  return declared.kind == Declared::Kind::LibraryBlock && declared.block->sized != nullptr &&
         std::ranges::any_of(declared.block->sized->kind->settings,
                             [&](std::string_view one) { return language::same_name(one, name); });
}

bool Elaborator::constant_array(ExpressionId id, const Field& field, std::vector<double>& values, bool sized) {
  std::vector<ExpressionId> elements{id};
  const Span span = source_.expressions[id].span;
  if (const auto* array = std::get_if<language::ArrayLiteral>(&source_.expressions[id].node)) {
    elements = array->elements;
    const bool one_of_one = field.length == 1 && elements.size() == 1 && sized;
    if (elements.size() > field.length || (field.length == 1 && !one_of_one)) {
      error(error::type_mismatch, span,
            fmt::format("{} takes {} value{}, here are {}", field.name, field.length,
                        field.length == 1 ? "" : "s at most", elements.size()),
            field.length == 1 ? "Write one value without brackets." : "Leave some out.");
      return false;
    }
  } else if (field.length > 1) {
    error(error::type_mismatch, span, fmt::format("{} is an array", field.name),
          "Write the values in brackets: [0.0, 1.0].");
    return false;
  }
  for (const ExpressionId element : elements) {
    double value = 0.0;
    Type type = Type::Real;
    const Span place = source_.expressions[element].span;
    if (!constant_value(source_, element, value, type)) {
      error(error::type_mismatch, place, fmt::format("the value of {} is not a constant", field.name),
            "Write a literal here; connect signals in the call of the instance.");
      return false;
    }
    if (type != field.type) {
      error(error::type_mismatch, place,
            fmt::format("{} is {}, its value is {}", field.name, type_name(field.type), type_name(type)),
            fmt::format("Write {}.", literal_text(field.type, value)));
      return false;
    }
    values.push_back(value);
  }
  return true;
}

Pin Elaborator::find_pin(const Declared& declared, const language::Name& name) {
  if (declared.kind == Declared::Kind::LibraryBlock) {
    for (std::uint32_t i = 0; i < declared.block->pin_count(); ++i) {
      if (language::same_name(declared.block->pin(i).name, name.text)) {
        return {true, i >= declared.block->inputs.size(), i, declared.block->pin(i)};
      }
    }
  } else {
    const Definition& inner = definitions_.list[declared.definition];
    if (const std::uint32_t* const found = inner.by_name.find(name.text)) {
      const Declared& variable = inner.variables[*found];
      if (variable.kind == Declared::Kind::Input || variable.kind == Declared::Kind::Parameter) {
        return {true, variable.kind == Declared::Kind::Parameter, *found, variable.field};
      }
    }
  }
  std::vector<std::string> names = pin_names(declared, true);
  error(error::unknown_pin, name.span, fmt::format("{} has no input '{}'", type_of(declared), name.text),
        one_of_pins(name.text, names, "inputs"));
  return {};
}

std::string Elaborator::one_of_pins(std::string_view name, const std::vector<std::string>& pins,
                                    std::string_view kind) {
  const std::string_view meant = meant_member(name, pins);
  return fmt::format("{}Its {} are {}.", meant.empty() ? std::string() : fmt::format("Did you mean {}? ", meant), kind,
                     fmt::join(pins, ", "));
}

std::string_view Elaborator::type_of(const Declared& declared) {
  const bool sized = declared.kind == Declared::Kind::LibraryBlock && declared.block->sized != nullptr;
  return sized ? declared.block->sized->kind->about.name : declared.variable->type.text;
}

std::vector<std::string> Elaborator::pin_names(const Declared& declared, bool inputs) {
  std::vector<std::string> names;
  if (declared.kind == Declared::Kind::LibraryBlock) {
    if (inputs) {
      for (std::size_t i = 0; i < declared.block->pin_count(); ++i) {
        names.emplace_back(declared.block->pin(i).name);
      }
    } else {
      for (const Field& field : declared.block->outputs) {
        names.emplace_back(field.name);
      }
    }
  } else {
    for (const Declared& variable : definitions_.list[declared.definition].variables) {
      const bool is_input = variable.kind == Declared::Kind::Input || variable.kind == Declared::Kind::Parameter;
      if (inputs ? is_input : variable.kind == Declared::Kind::Output) {
        names.emplace_back(variable.field.name);
      }
    }
  }
  // A vector is one pin: XIN[0], XIN[1] and XIN[2] are XIN[0..2].
  std::vector<std::string> pins;
  for (std::size_t i = 0; i < names.size();) {
    const auto first = element_of(names[i]);
    std::size_t end = i + 1;
    while (first && end < names.size() && element_of(names[end]) && element_of(names[end])->vector == first->vector) {
      ++end;
    }
    pins.push_back(first ? fmt::format("{}[{}..{}]", first->vector, first->index, element_of(names[end - 1])->index)
                         : names[i]);
    i = end;
  }
  return pins;
}

Wire& Elaborator::pin_wire(const Declared& declared, const Part& part, const Pin& pin) {
  return declared.kind == Declared::Kind::LibraryBlock ? graph_.wires[graph_.nodes[part.node].first_wire + pin.index]
                                                       : slots_[part.first_slot + pin.index].wire;
}

void Elaborator::set_span(const Instance& instance, const Declared& declared, const Part& part, const Pin& pin,
                          Span span) {
  if (declared.kind == Declared::Kind::LibraryBlock) {
    graph_.wire_spans[graph_.nodes[part.node].first_wire + pin.index] = span;
  } else {
    slots_[part.first_slot + pin.index].span = span;
    slots_[part.first_slot + pin.index].driven = true;
    slots_[part.first_slot + pin.index].level = instance.level;
  }
}

bool Elaborator::claim(const Declared& declared, const Part& part, const Pin& pin, const language::Argument& argument) {
  if (pin_wire(declared, part, pin).from == Wire::From::Nothing) {
    return true;
  }
  const Span earlier = declared.kind == Declared::Kind::LibraryBlock
                           ? graph_.wire_spans[graph_.nodes[part.node].first_wire + pin.index]
                           : slots_[part.first_slot + pin.index].span;
  error(error::double_drive, argument.pin.span,
        fmt::format("{}.{} is given a value twice", declared.variable->name.text, argument.pin.text),
        "Keep one of the two; to switch between signals use SEL or HY_SWITCH.",
        {{source_.place(earlier), "the other is here"}});
  return false;
}

void Elaborator::set_constant(const Instance& instance, const Declared& declared, const Part& part, const Pin& pin,
                              const std::vector<double>& values, const language::Argument& argument) {
  const Span span = source_.expressions[argument.value].span;
  for (const double value : values) {
    check_range(pin.field, value, span);
  }
  Wire wire;
  if (pin.parameter) {
    std::vector<double> all = values;
    all.resize(pin.field.length, 0.0);
    std::string path = upper(instance.path + std::string(declared.field.name)) + "." + upper(pin.field.name);
    given_.emplace(path, values.size());
    open_parameters_.push_back({.path = std::move(path), .field = pin.field, .value = std::move(all), .span = span});
    wire = {Wire::From::Parameter, pin.field.type, 0, static_cast<std::uint32_t>(open_parameters_.size() - 1)};
  } else {
    wire = builder_.literal(pin.field.type, values.front());
  }
  pin_wire(declared, part, pin) = wire;
  set_span(instance, declared, part, pin, span);
}

void Elaborator::check_range(const Field& field, double value, Span span) {
  const bool low = field.above_minimum ? !(value > field.minimum) : value < field.minimum;
  if (low || value > field.maximum) {
    error(error::parameter_out_of_range, span, fmt::format("{} = {} lies outside its range", field.name, value),
          fmt::format("{} must be {} {}{}.", field.name, field.above_minimum ? "above" : "at least", field.minimum,
                      field.maximum < std::numeric_limits<double>::infinity()
                          ? fmt::format(" and at most {}", field.maximum)
                          : ""));
  }
}

void Elaborator::check_relations() {
  for (const Node& node : graph_.nodes) {
    if (node.block == nullptr || node.block->params.empty()) {
      continue;
    }
    const auto values = numbers_of_params(graph_, node, [&](std::size_t parameter) {
      const Parameter& one = graph_.parameters[parameter];
      const auto given = given_.find(one.path);
      return std::span(one.value).first(given == given_.end() ? 0 : given->second);
    });
    // Named without the way to it, so that a block that is used twice has its faults once.
    const std::string_view name = std::string_view(node.path).substr(node.path.rfind('.') + 1);
    for (Contradiction& one : contradictions(*node.block, name, values, period_of(graph_, node))) {
      error(error::parameter_out_of_range, graph_.wire_spans[node.first_wire + node.block->inputs.size() + one.param],
            std::move(one.cause), std::move(one.mend));
    }
  }
}

void Elaborator::wrong_type(Span span, const std::string& target, Type wanted, Type given) {
  error(error::type_mismatch, span,
        fmt::format("{} is {}, the value is {}", target, type_name(wanted), type_name(given)),
        conversion_in_words(wanted, given));
}

Wire Elaborator::unconnected(const std::string& path, const Declared& declared, const Field& field, bool parameter,
                             const Part& part) {
  if (parameter) {
    open_parameters_.push_back({.path = upper(path) + "." + upper(field.name),
                                .field = field,
                                .value = std::vector<double>(field.length, field.preset),
                                .span = declared.variable->name.span});
    return {Wire::From::Parameter, field.type, 0, static_cast<std::uint32_t>(open_parameters_.size() - 1)};
  }
  // Beside a pin that does not exist, what is not connected is the same mistake.
  if (field.required && part.called && !part.is_misnamed &&
      std::ranges::find(part.given, field.name) == part.given.end()) {
    error(error::unconnected_input, part.call, fmt::format("{}.{} is not connected", declared.field.name, field.name),
          fmt::format("Connect it: {}({} := …). {}", declared.field.name, field.name, field.meaning));
  }
  return builder_.literal(field.type, field.preset);
}

}  // namespace hysteron
