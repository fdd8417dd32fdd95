#include "codegen/graph/elaborate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "codegen/graph/elaborator.hpp"
#include "codegen/graph/fmu_block.hpp"
#include "support/names.hpp"
#include "support/numbers.hpp"

namespace hysteron {

Graph Elaborator::run(std::uint32_t top, OuterPlaces& places) {
  const Definition& definition = definitions_.list[top];
  graph_.name = std::string(definition.block->name.text);
  graph_.sample_time_ns = definition.sample_time_ns;
  graph_.sample_time_span = definition.sample_time_span;
  Instance instance{.definition = &definition, .first_slot = add_slots(definition), .top = true};
  for (std::size_t i = 0; i < definition.variables.size(); ++i) {
    declare_top(instance, i);
  }
  for (const NoisyOutput& noisy : options_.noisy_outputs) {
    declare_noise(instance, noisy);
  }
  elaborate(instance);
  for (std::size_t i = 0; i < definition.variables.size(); ++i) {
    const Declared& declared = definition.variables[i];
    if (declared.kind == Declared::Kind::Output) {
      Port port = port_of(declared);
      port.wire = alias(instance.first_slot + static_cast<std::uint32_t>(i), declared.field.type);
      graph_.outputs.push_back(std::move(port));
    }
  }
  finish(graph_, slots_, open_parameters_, levels_, places, diagnostics_);
  check_relations();
  check_fmu_parameters(graph_, diagnostics_);
  return std::move(graph_);
}

void Elaborator::error(int number, Span span, std::string cause, std::string mend, std::vector<Note> notes) {
  diagnostics_.error(number, source_.place(span), std::move(cause), std::move(mend), std::move(notes));
}

std::uint32_t Elaborator::add_slots(const Definition& definition) {
  const auto first = static_cast<std::uint32_t>(slots_.size());
  slots_.resize(slots_.size() + definition.variables.size());
  return first;
}

Port Elaborator::port_of(const Declared& declared) {
  const Field& field = declared.field;
  return {.name = std::string(field.name),
          .unit = std::string(field.unit),
          .meaning = std::string(field.meaning),
          .type = field.type,
          .preset = field.preset,
          .minimum = field.minimum,
          .maximum = field.maximum,
          .span = declared.variable->name.span};
}

void Elaborator::declare_top(const Instance& instance, std::size_t variable) {
  const Declared& declared = instance.definition->variables[variable];
  Slot& slot = slots_[instance.first_slot + variable];
  if (declared.kind == Declared::Kind::Input) {
    graph_.inputs.push_back(port_of(declared));
    slot.wire = {Wire::From::Input, declared.field.type, 0, static_cast<std::uint32_t>(graph_.inputs.size() - 1)};
    slot.driven = true;
  } else if (declared.kind == Declared::Kind::Parameter) {
    slot.wire = open_parameter("", declared, declared.field.preset);
    slot.driven = true;
  }
}

void Elaborator::declare_noise(const Instance& instance, const NoisyOutput& noisy) {
  const std::uint32_t* const found = instance.definition->by_name.find(noisy.output);
  if (found == nullptr) {
    return;
  }
  const Declared& declared = instance.definition->variables[*found];
  if (declared.kind != Declared::Kind::Output || declared.field.type != Type::Real) {
    return;
  }
  Port port = port_of(declared);
  port.name = noisy.input;
  port.preset = 0.0;
  graph_.inputs.push_back(std::move(port));
  const Wire noise{Wire::From::Input, Type::Real, 0, static_cast<std::uint32_t>(graph_.inputs.size() - 1)};
  const std::uint32_t slot = instance.first_slot + *found;
  noisy_[slot] =
      builder_.operation(Op::Add, {alias(slot, Type::Real), noise}, upper(noisy.input), declared.variable->name.span);
}

Wire Elaborator::open_parameter(const std::string& path, const Declared& declared, double value) {
  open_parameters_.push_back({.path = path + upper(declared.field.name),
                              .field = declared.field,
                              .value = {value},
                              .span = declared.variable->name.span});
  return {Wire::From::Parameter, declared.field.type, 0, static_cast<std::uint32_t>(open_parameters_.size() - 1)};
}

void Elaborator::elaborate(const Instance& instance) {
  const Definition& definition = *instance.definition;
  if (definition.block->sequential) {
    elaborate_body(instance);
    return;
  }
  std::vector<Part> parts(definition.variables.size());
  for (std::size_t i = 0; i < definition.variables.size(); ++i) {
    instantiate(instance, i, parts[i]);
    levels_.resize(graph_.nodes.size(), instance.level);
  }
  for (const auto& statement : definition.block->statements) {
    if (const auto* call = std::get_if<language::Call>(&statement)) {
      elaborate_call(instance, parts, *call);
    } else {
      elaborate_assignment(instance, parts, std::get<language::Assignment>(statement));
    }
  }
  levels_.resize(graph_.nodes.size(), instance.level);
  for (std::size_t i = 0; i < definition.variables.size(); ++i) {
    close(instance, i, parts[i]);
    note_unit(instance, i);
    note_name(instance, i);
  }
}

// A variable of the text leaves no trace in the graph but its unit, and its name where that is asked for.
void Elaborator::note_unit(const Instance& instance, std::size_t variable) {
  const Declared& declared = instance.definition->variables[variable];
  // What is inside a nested block is checked where the block is elaborated by itself; here, what crosses its border.
  const bool checked_here =
      instance.top ? declared.kind == Declared::Kind::Local : declared.kind == Declared::Kind::Input;
  if (!declared.field.unit.empty() && checked_here) {
    graph_.inner.push_back(port_of(declared));
    graph_.inner.back().wire = alias(instance.first_slot + static_cast<std::uint32_t>(variable), declared.field.type);
  }
}

void Elaborator::note_name(const Instance& instance, std::size_t variable) {
  const Declared& declared = instance.definition->variables[variable];
  const bool nested_output = declared.kind == Declared::Kind::Output && !instance.top;
  if (options_.keep_names &&
      (declared.kind == Declared::Kind::Input || declared.kind == Declared::Kind::Local || nested_output)) {
    graph_.named.push_back(
        {.path = instance.path + std::string(declared.field.name),
         .wire = alias(instance.first_slot + static_cast<std::uint32_t>(variable), declared.field.type)});
  }
}

Rate Elaborator::rate_within(Rate outer, const Declared& declared) {
  const std::uint64_t every = std::uint64_t{outer.every} * declared.rate.every;
  if (every > longest_common_period) {
    error(error::rates_too_far_apart, declared.variable->name.span,
          fmt::format("'{}' would run every {} steps, but a counter of steps holds {} at most", declared.field.name,
                      every, longest_common_period),
          "Run the block that contains it, or the instance itself, more often.");
    return declared.rate;
  }
  return {static_cast<std::uint32_t>(every), outer.phase + outer.every * declared.rate.phase};
}

void Elaborator::check_sample_time(const Declared& declared, Rate rate) {
  const Definition& inner = definitions_.list[declared.definition];
  if (inner.sample_time_ns <= 0 || graph_.sample_time_ns <= 0) {
    return;
  }
  const double own = static_cast<double>(inner.sample_time_ns) * 1e-9;
  const double period = graph_.sample_time() * rate.every;
  if (std::abs(period - own) > 1e-12 * own) {
    const auto name = inner.block->name.text;
    error(error::bad_annotation, declared.variable->name.span,
          fmt::format("'{}' runs every {} s here, but {} states @ts {} s", declared.field.name, number_text(period),
                      name, number_text(own)),
          fmt::format("The top's @ts holds for all that is inside: take @ts away from {}, or run the instance at that "
                      "rate by @every.",
                      name),
          {{source_.place(inner.sample_time_span), "stated here"}});
  }
}

void Elaborator::instantiate(const Instance& instance, std::size_t variable, Part& part) {
  const Declared& declared = instance.definition->variables[variable];
  Slot& slot = slots_[instance.first_slot + variable];
  const Rate rate = rate_within(instance.rate, declared);
  const std::string path = instance.path + std::string(declared.field.name);
  switch (declared.kind) {
    case Declared::Kind::Constant:
      slot = {.wire = builder_.literal(declared.field.type, declared.field.preset, declared.field.unit),
              .driven = true};
      break;
    case Declared::Kind::LibraryBlock:
      part.node = builder_.block(*declared.block, path, rate, declared.variable->name.span);
      apply_settings(instance, declared, part);
      discretise(instance, declared, part, rate);
      break;
    case Declared::Kind::UserBlock: {
      const Definition& inner = definitions_.list[declared.definition];
      part.first_slot = add_slots(inner);
      apply_settings(instance, declared, part);
      if (inner.usable && instance.definition->usable) {
        check_sample_time(declared, rate);
        elaborate({.definition = &inner,
                   .path = path + ".",
                   .first_slot = part.first_slot,
                   .rate = rate,
                   .level = instance.level + 1});
      }
      break;
    }
    default:
      break;
  }
}

void Elaborator::elaborate_call(const Instance& instance, std::vector<Part>& parts, const language::Call& call) {
  const Definition& definition = *instance.definition;
  const std::uint32_t* const found = definition.by_name.find(call.instance.text);
  if (found == nullptr) {
    unknown_name(definition, call.instance);
    return;
  }
  const Declared& declared = definition.variables[*found];
  Part& part = parts[*found];
  if (declared.kind == Declared::Kind::Unknown) {
    return;
  }
  if (declared.kind != Declared::Kind::LibraryBlock && declared.kind != Declared::Kind::UserBlock) {
    error(error::type_mismatch, call.instance.span,
          fmt::format("'{}' is not an instance and cannot be called", call.instance.text),
          "Assign to a variable with :=, call an instance of a block.");
    return;
  }
  if (part.called) {
    error(error::double_drive, call.instance.span, fmt::format("'{}' is called twice", call.instance.text),
          "Call each instance once; declare a second instance for a second use.",
          {{source_.place(part.call), "first called here"}});
    return;
  }
  part.called = true;
  part.call = call.instance.span;
  for (const language::Argument& argument : call.arguments) {
    const Pin pin = find_pin(declared, argument.pin);
    if (!pin.found) {
      part.is_misnamed = true;
      continue;
    }
    part.given.push_back(pin.field.name);
    double value = 0.0;
    Type type = Type::Real;
    const bool array = std::holds_alternative<language::ArrayLiteral>(source_.expressions[argument.value].node);
    if (array || (pin.parameter && constant_value(source_, argument.value, value, type))) {
      std::vector<double> values;
      if (claim(declared, part, pin, argument) &&
          constant_array(argument.value, pin.field, values, is_sized(declared))) {
        set_constant(instance, declared, part, pin, values, argument);
      }
      continue;
    }
    const std::string path = fmt::format("{}{}.{}", instance.path, declared.field.name, pin.field.name);
    const Wire wire = lower(instance, parts, argument.value, path);
    if (!claim(declared, part, pin, argument) || wire.from == Wire::From::Nothing) {
      continue;
    }
    const Span span = source_.expressions[argument.value].span;
    if (pin.field.length > 1) {
      error(error::type_mismatch, span, fmt::format("{} is an array", pin.field.name),
            "Write the values in brackets: [0.0, 1.0].");
    } else if (wire.type != pin.field.type) {
      wrong_type(span, fmt::format("{}.{}", declared.field.name, pin.field.name), pin.field.type, wire.type);
    } else {
      pin_wire(declared, part, pin) = wire;
      set_span(instance, declared, part, pin, span);
    }
  }
}

void Elaborator::elaborate_assignment(const Instance& instance, std::vector<Part>& parts,
                                      const language::Assignment& assignment) {
  const Definition& definition = *instance.definition;
  const std::uint32_t* const found = definition.by_name.find(assignment.target.text);
  if (found == nullptr) {
    unknown_name(definition, assignment.target);
    return;
  }
  const Declared& declared = definition.variables[*found];
  if (declared.kind == Declared::Kind::Unknown) {
    return;
  }
  if (declared.kind != Declared::Kind::Output && declared.kind != Declared::Kind::Local) {
    error(declared.kind == Declared::Kind::LibraryBlock || declared.kind == Declared::Kind::UserBlock
              ? error::type_mismatch
              : error::double_drive,
          assignment.target.span, fmt::format("'{}' cannot be assigned to", assignment.target.text),
          "Assign to an output or to a variable declared between VAR and END_VAR.");
    return;
  }
  const Wire wire = lower(instance, parts, assignment.value, instance.path + std::string(declared.field.name));
  Slot& target = slots_[instance.first_slot + *found];
  if (target.driven) {
    error(error::double_drive, assignment.target.span, fmt::format("'{}' is assigned twice", assignment.target.text),
          "Keep one of the two; to switch between signals use SEL or HY_SWITCH.",
          {{source_.place(target.span), "the other is here"}});
    return;
  }
  target.driven = true;
  target.span = assignment.target.span;
  target.level = instance.level;
  if (wire.from == Wire::From::Nothing) {
    return;
  }
  if (wire.type != declared.field.type) {
    wrong_type(source_.expressions[assignment.value].span, std::string(declared.field.name), declared.field.type,
               wire.type);
    return;
  }
  target.wire = wire;
}

Wire Elaborator::lower(const Instance& instance, const std::vector<Part>& parts, ExpressionId id,
                       const std::string& path) {
  if (const auto* reference = std::get_if<language::Reference>(&source_.expressions[id].node)) {
    return resolve(instance, parts, *reference);  // the common case, without an operation
  }
  Lowering lowering(
      builder_, source_,
      [&](const language::Reference& reference, Span /*span*/) { return resolve(instance, parts, reference); },
      [&](int number, Span span, std::string cause, std::string mend) {
        error(number, span, std::move(cause), std::move(mend));
      });
  return lowering.lower(id, path);
}

Wire Elaborator::resolve(const Instance& instance, const std::vector<Part>& parts,
                         const language::Reference& reference) {
  const Definition& definition = *instance.definition;
  const std::uint32_t* const found = definition.by_name.find(reference.name.text);
  if (found == nullptr) {
    unknown_name(definition, reference.name);
    return {};
  }
  const Declared& declared = definition.variables[*found];
  if (declared.kind == Declared::Kind::Unknown) {
    return {};
  }
  const bool is_instance = declared.kind == Declared::Kind::LibraryBlock || declared.kind == Declared::Kind::UserBlock;
  if (reference.pin.text.empty()) {
    if (is_instance) {
      error(error::type_mismatch, reference.name.span,
            fmt::format("'{}' is an instance, not a value", reference.name.text),
            fmt::format("Name one of its outputs: {}.", fmt::join(pin_names(declared, false), ", ")));
      return {};
    }
    if (remembered_ != nullptr && remembered_->contains(&reference)) {
      return builder_.literal(declared.field.type, 0.0);
    }
    const auto noisy = noisy_.find(instance.first_slot + *found);
    return noisy != noisy_.end() ? noisy->second : alias(instance.first_slot + *found, declared.field.type);
  }
  if (!is_instance) {
    error(error::unknown_pin, reference.pin.span,
          fmt::format("'{}' is a variable and has no outputs", reference.name.text),
          language::names_bit(reference.pin.text)
              ? fmt::format("A bit of a WORD is written by its number alone: {}.{}.", reference.name.text,
                            reference.pin.text.substr(1))
              : "Leave the dot and what follows away.");
    return {};
  }
  const Part& part = parts[*found];
  if (declared.kind == Declared::Kind::LibraryBlock) {
    for (std::size_t i = 0; i < declared.block->outputs.size(); ++i) {
      if (language::same_name(declared.block->outputs[i].name, reference.pin.text)) {
        return {Wire::From::Node, declared.block->outputs[i].type, static_cast<std::uint16_t>(i), part.node};
      }
    }
  } else {
    const Definition& inner = definitions_.list[declared.definition];
    const std::uint32_t* const output = inner.by_name.find(reference.pin.text);
    if (output != nullptr && inner.variables[*output].kind == Declared::Kind::Output) {
      return alias(part.first_slot + *output, inner.variables[*output].field.type);
    }
  }
  error(error::unknown_pin, reference.pin.span,
        fmt::format("{} has no output '{}'", type_of(declared), reference.pin.text),
        one_of_pins(reference.pin.text, pin_names(declared, false), "outputs"));
  return {};
}

void Elaborator::unknown_name(const Definition& definition, const language::Name& name) {
  std::vector<std::string> known;
  for (const Declared& declared : definition.variables) {
    known.emplace_back(declared.field.name);
  }
  const auto near = nearest_name(name.text, known);
  error(error::unknown_name, name.span, fmt::format("'{}' is not declared", name.text),
        near.empty() && equal_ignoring_case(name.text, "PI") ? "Write 3.141592653589793."
        : near.empty()                                       ? "Declare it in a VAR section."
                                                             : fmt::format("Did you mean {}?", near));
}

void Elaborator::close(const Instance& instance, std::size_t variable, const Part& part) {
  const Declared& declared = instance.definition->variables[variable];
  const std::string path = instance.path + std::string(declared.field.name);
  switch (declared.kind) {
    case Declared::Kind::Output:
    case Declared::Kind::Local: {
      Slot& slot = slots_[instance.first_slot + variable];
      if (slot.driven) {
        break;
      }
      if (declared.has_preset) {
        slot = {.wire = builder_.literal(declared.field.type, declared.field.preset, declared.field.unit),
                .driven = true};
      } else {
        error(error::undriven_output, declared.variable->name.span,
              fmt::format("nothing is assigned to '{}'", declared.field.name),
              fmt::format("Assign a value: {} := …;", declared.field.name));
      }
      break;
    }
    case Declared::Kind::LibraryBlock:
      check_called(declared, part);
      for (std::uint32_t i = 0; i < declared.block->pin_count(); ++i) {
        Wire& wire = graph_.wires[graph_.nodes[part.node].first_wire + i];
        if (wire.from == Wire::From::Nothing) {
          wire = unconnected(path, declared, declared.block->pin(i), i >= declared.block->inputs.size(), part);
        }
      }
      break;
    case Declared::Kind::UserBlock:
      check_called(declared, part);
      for (std::size_t i = 0; i < definitions_.list[declared.definition].variables.size(); ++i) {
        const Declared& inner = definitions_.list[declared.definition].variables[i];
        Slot& slot = slots_[part.first_slot + i];
        if (inner.kind == Declared::Kind::Parameter && !slot.driven) {
          slot = {.wire = open_parameter(upper(path) + ".", inner, inner.field.preset), .driven = true};
        } else if (inner.kind == Declared::Kind::Input && !slot.driven) {
          Field field = inner.field;
          field.required = !inner.has_preset;
          slot = {.wire = unconnected(path, declared, field, false, part), .driven = true};
        }
      }
      break;
    default:
      break;
  }
}

void Elaborator::check_called(const Declared& declared, const Part& part) {
  if (!part.called) {
    error(error::uncalled_instance, declared.variable->name.span,
          fmt::format("'{}' is never called", declared.field.name),
          fmt::format("Call it: {}(…); or remove the declaration.", declared.field.name));
  }
}

Graph elaborate(const Definitions& definitions, std::uint32_t top, Diagnostics& diagnostics,
                const ElaborateOptions& options, OuterPlaces* places) {
  OuterPlaces unasked;
  return Elaborator(definitions, diagnostics, options).run(top, places != nullptr ? *places : unasked);
}

}  // namespace hysteron
