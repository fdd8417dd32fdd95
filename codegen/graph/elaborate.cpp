#include "codegen/graph/elaborate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "codegen/graph/finish.hpp"
#include "codegen/graph/lowering.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"

namespace hysteron {
namespace {

using language::ExpressionId;
using language::Span;
using language::upper;

/// A definition being instantiated: its variables stand in a row of slots.
struct Instance {
  const Definition* definition = nullptr;
  std::string path{};  ///< "" at the top, else ending in a dot
  std::uint32_t first_slot = 0;
  Rate rate{};
  bool top = false;
};

class Elaborator {
 public:
  Elaborator(const Definitions& definitions, Diagnostics& diagnostics)
      : definitions_(definitions), source_(*definitions.source), diagnostics_(diagnostics), builder_(graph_) {
    graph_.source = definitions.source;
  }

  Graph run(std::uint32_t top) {
    const Definition& definition = definitions_.list[top];
    graph_.name = std::string(definition.block->name.text);
    graph_.sample_time_ns = definition.sample_time_ns;
    Instance instance{.definition = &definition, .first_slot = add_slots(definition), .top = true};
    for (std::size_t i = 0; i < definition.variables.size(); ++i) {
      declare_top(instance, i);
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
    finish(graph_, slots_, open_parameters_, diagnostics_);
    return std::move(graph_);
  }

 private:
  void error(int number, Span span, std::string cause, std::string mend, std::vector<Note> notes = {}) {
    diagnostics_.error(number, source_.place(span), std::move(cause), std::move(mend), std::move(notes));
  }

  static Wire alias(std::uint32_t slot, Type type) { return {Wire::From::Alias, type, 0, slot}; }

  std::uint32_t add_slots(const Definition& definition) {
    const auto first = static_cast<std::uint32_t>(slots_.size());
    slots_.resize(slots_.size() + definition.variables.size());
    return first;
  }

  Port port_of(const Declared& declared) const {
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

  void declare_top(const Instance& instance, std::size_t variable) {
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

  /// A parameter that nothing in the text drives: it may be set from outside.
  Wire open_parameter(const std::string& path, const Declared& declared, double value) {
    open_parameters_.push_back({.path = path + upper(declared.field.name),
                                .field = declared.field,
                                .value = {value},
                                .span = declared.variable->name.span});
    return {Wire::From::Parameter, declared.field.type, 0, static_cast<std::uint32_t>(open_parameters_.size() - 1)};
  }

  // --- one instance of a definition ---

  void elaborate(const Instance& instance) {
    const Definition& definition = *instance.definition;
    std::vector<Part> parts(definition.variables.size());
    for (std::size_t i = 0; i < definition.variables.size(); ++i) {
      instantiate(instance, i, parts[i]);
    }
    for (std::size_t s = 0; s < definition.block->statements.size(); ++s) {
      const auto& statement = definition.block->statements[s];
      if (const auto* call = std::get_if<language::Call>(&statement)) {
        elaborate_call(instance, parts, *call);
      } else {
        elaborate_assignment(instance, parts, std::get<language::Assignment>(statement));
      }
    }
    for (std::size_t i = 0; i < definition.variables.size(); ++i) {
      close(instance, i, parts[i]);
    }
  }

  /// What an instance variable became: a node, or the slots of a nested definition.
  struct Part {
    std::uint32_t node = 0;
    std::uint32_t first_slot = 0;
    bool called = false;
    Span call{};
  };

  void instantiate(const Instance& instance, std::size_t variable, Part& part) {
    const Declared& declared = instance.definition->variables[variable];
    Slot& slot = slots_[instance.first_slot + variable];
    const Rate rate{instance.rate.every * declared.rate.every,
                    instance.rate.phase + instance.rate.every * declared.rate.phase};
    const std::string path = instance.path + std::string(declared.field.name);
    switch (declared.kind) {
      case Declared::Kind::Constant:
        slot = {.wire = builder_.literal(declared.field.type, declared.field.preset), .driven = true};
        break;
      case Declared::Kind::LibraryBlock:
        part.node = builder_.block(*declared.block, path, rate, declared.variable->name.span);
        apply_settings(instance, declared, part);
        break;
      case Declared::Kind::UserBlock: {
        const Definition& inner = definitions_.list[declared.definition];
        part.first_slot = add_slots(inner);
        apply_settings(instance, declared, part);
        if (inner.usable && instance.definition->usable) {
          elaborate({.definition = &inner, .path = path + ".", .first_slot = part.first_slot, .rate = rate});
        }
        break;
      }
      default:
        break;
    }
  }

  // `INV : HY_M_INVERSE := (C1 := 0.05)`: constants, given once.
  void apply_settings(const Instance& instance, const Declared& declared, Part& part) {
    for (const language::Argument& setting : declared.variable->settings) {
      const Pin pin = find_pin(declared, setting.pin);
      if (!pin.found || !claim(declared, part, pin, setting)) {
        continue;
      }
      std::vector<double> values;
      if (constant_array(setting.value, pin.field, values)) {
        set_constant(instance, declared, part, pin, values, setting);
      }
    }
  }

  bool constant_array(ExpressionId id, const Field& field, std::vector<double>& values) {
    std::vector<ExpressionId> elements{id};
    const Span span = source_.expressions[id].span;
    if (const auto* array = std::get_if<language::ArrayLiteral>(&source_.expressions[id].node)) {
      elements = array->elements;
      if (elements.size() > field.length || field.length == 1) {
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

  // --- pins ---

  struct Pin {
    bool found = false;
    bool parameter = false;
    std::uint32_t index = 0;  ///< pin of a library block, variable of a definition
    Field field{};
  };

  Pin find_pin(const Declared& declared, const language::Name& name) {
    if (declared.kind == Declared::Kind::LibraryBlock) {
      for (std::uint32_t i = 0; i < declared.block->pin_count(); ++i) {
        if (language::same_name(declared.block->pin(i).name, name.text)) {
          return {true, i >= declared.block->inputs.size(), i, declared.block->pin(i)};
        }
      }
    } else {
      const Definition& inner = definitions_.list[declared.definition];
      const auto found = inner.by_name.find(upper(name.text));
      if (found != inner.by_name.end()) {
        const Declared& variable = inner.variables[found->second];
        if (variable.kind == Declared::Kind::Input || variable.kind == Declared::Kind::Parameter) {
          return {true, variable.kind == Declared::Kind::Parameter, found->second, variable.field};
        }
      }
    }
    std::vector<std::string> names = pin_names(declared, true);
    error(error::unknown_pin, name.span, fmt::format("{} has no input '{}'", declared.variable->type.text, name.text),
          fmt::format("Its inputs are {}.", fmt::join(names, ", ")));
    return {};
  }

  std::vector<std::string> pin_names(const Declared& declared, bool inputs) {
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
    return names;
  }

  Wire& pin_wire(const Declared& declared, const Part& part, const Pin& pin) {
    return declared.kind == Declared::Kind::LibraryBlock ? graph_.wires[graph_.nodes[part.node].first_wire + pin.index]
                                                         : slots_[part.first_slot + pin.index].wire;
  }

  void set_span(const Declared& declared, const Part& part, const Pin& pin, Span span) {
    if (declared.kind == Declared::Kind::LibraryBlock) {
      graph_.wire_spans[graph_.nodes[part.node].first_wire + pin.index] = span;
    } else {
      slots_[part.first_slot + pin.index].span = span;
      slots_[part.first_slot + pin.index].driven = true;
    }
  }

  /// Refuses a second value for a pin.
  bool claim(const Declared& declared, const Part& part, const Pin& pin, const language::Argument& argument) {
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

  void set_constant(const Instance& instance, const Declared& declared, const Part& part, const Pin& pin,
                    const std::vector<double>& values, const language::Argument& argument) {
    const Span span = source_.expressions[argument.value].span;
    for (const double value : values) {
      check_range(pin.field, value, span);
    }
    Wire wire;
    if (pin.parameter) {
      std::vector<double> all = values;
      all.resize(pin.field.length, 0.0);
      open_parameters_.push_back(
          {.path = upper(instance.path + std::string(declared.field.name)) + "." + upper(pin.field.name),
           .field = pin.field,
           .value = std::move(all),
           .span = span});
      wire = {Wire::From::Parameter, pin.field.type, 0, static_cast<std::uint32_t>(open_parameters_.size() - 1)};
    } else {
      wire = builder_.literal(pin.field.type, values.front());
    }
    pin_wire(declared, part, pin) = wire;
    set_span(declared, part, pin, span);
  }

  void check_range(const Field& field, double value, Span span) {
    const bool low = field.above_minimum ? !(value > field.minimum) : value < field.minimum;
    if (low || value > field.maximum) {
      error(error::parameter_out_of_range, span, fmt::format("{} = {} lies outside its range", field.name, value),
            fmt::format("{} must be {} {}{}.", field.name, field.above_minimum ? "above" : "at least", field.minimum,
                        field.maximum < std::numeric_limits<double>::infinity()
                            ? fmt::format(" and at most {}", field.maximum)
                            : ""));
    }
  }

  // --- statements ---

  void elaborate_call(const Instance& instance, std::vector<Part>& parts, const language::Call& call) {
    const Definition& definition = *instance.definition;
    const auto found = definition.by_name.find(upper(call.instance.text));
    if (found == definition.by_name.end()) {
      unknown_name(definition, call.instance);
      return;
    }
    const Declared& declared = definition.variables[found->second];
    Part& part = parts[found->second];
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
        continue;
      }
      double value = 0.0;
      Type type = Type::Real;
      const bool array = std::holds_alternative<language::ArrayLiteral>(source_.expressions[argument.value].node);
      if (array || (pin.parameter && constant_value(source_, argument.value, value, type))) {
        std::vector<double> values;
        if (claim(declared, part, pin, argument) && constant_array(argument.value, pin.field, values)) {
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
        set_span(declared, part, pin, span);
      }
    }
  }

  void wrong_type(Span span, const std::string& target, Type wanted, Type given) {
    const bool number = (wanted == Type::Real && given == Type::Int) || (wanted == Type::Int && given == Type::Real);
    error(error::type_mismatch, span,
          fmt::format("{} is {}, the value is {}", target, type_name(wanted), type_name(given)),
          number ? (wanted == Type::Real
                        ? "Write literals with a decimal point (1.0), or convert by DINT_TO_LREAL."
                        : "Write literals without a decimal point (1), or convert by LREAL_TO_DINT or TRUNC.")
                 : "A comparison turns a number into a BOOL; SEL turns a BOOL into a number.");
  }

  void elaborate_assignment(const Instance& instance, std::vector<Part>& parts,
                            const language::Assignment& assignment) {
    const Definition& definition = *instance.definition;
    const auto found = definition.by_name.find(upper(assignment.target.text));
    if (found == definition.by_name.end()) {
      unknown_name(definition, assignment.target);
      return;
    }
    const Declared& declared = definition.variables[found->second];
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
    Slot& target = slots_[instance.first_slot + found->second];
    if (target.driven) {
      error(error::double_drive, assignment.target.span, fmt::format("'{}' is assigned twice", assignment.target.text),
            "Keep one of the two; to switch between signals use SEL or HY_SWITCH.",
            {{source_.place(target.span), "the other is here"}});
      return;
    }
    target.driven = true;
    target.span = assignment.target.span;
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

  Wire lower(const Instance& instance, const std::vector<Part>& parts, ExpressionId id, const std::string& path) {
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

  Wire resolve(const Instance& instance, const std::vector<Part>& parts, const language::Reference& reference) {
    const Definition& definition = *instance.definition;
    const auto found = definition.by_name.find(upper(reference.name.text));
    if (found == definition.by_name.end()) {
      unknown_name(definition, reference.name);
      return {};
    }
    const Declared& declared = definition.variables[found->second];
    if (declared.kind == Declared::Kind::Unknown) {
      return {};
    }
    const bool is_instance =
        declared.kind == Declared::Kind::LibraryBlock || declared.kind == Declared::Kind::UserBlock;
    if (reference.pin.text.empty()) {
      if (is_instance) {
        error(error::type_mismatch, reference.name.span,
              fmt::format("'{}' is an instance, not a value", reference.name.text),
              fmt::format("Name one of its outputs: {}.", fmt::join(pin_names(declared, false), ", ")));
        return {};
      }
      return alias(instance.first_slot + found->second, declared.field.type);
    }
    if (!is_instance) {
      error(error::unknown_pin, reference.pin.span,
            fmt::format("'{}' is a variable and has no outputs", reference.name.text),
            "Leave the dot and what follows away.");
      return {};
    }
    const Part& part = parts[found->second];
    if (declared.kind == Declared::Kind::LibraryBlock) {
      for (std::size_t i = 0; i < declared.block->outputs.size(); ++i) {
        if (language::same_name(declared.block->outputs[i].name, reference.pin.text)) {
          return {Wire::From::Node, declared.block->outputs[i].type, static_cast<std::uint16_t>(i), part.node};
        }
      }
    } else {
      const Definition& inner = definitions_.list[declared.definition];
      const auto output = inner.by_name.find(upper(reference.pin.text));
      if (output != inner.by_name.end() && inner.variables[output->second].kind == Declared::Kind::Output) {
        return alias(part.first_slot + output->second, inner.variables[output->second].field.type);
      }
    }
    error(error::unknown_pin, reference.pin.span,
          fmt::format("{} has no output '{}'", declared.variable->type.text, reference.pin.text),
          fmt::format("Its outputs are {}.", fmt::join(pin_names(declared, false), ", ")));
    return {};
  }

  void unknown_name(const Definition& definition, const language::Name& name) {
    std::vector<std::string> known;
    for (const Declared& declared : definition.variables) {
      known.emplace_back(declared.field.name);
    }
    const auto near = nearest_name(name.text, known);
    error(error::unknown_name, name.span, fmt::format("'{}' is not declared", name.text),
          near.empty() ? "Declare it in a VAR section." : fmt::format("Did you mean {}?", near));
  }

  // --- what is left unconnected ---

  void close(const Instance& instance, std::size_t variable, const Part& part) {
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
          slot = {.wire = builder_.literal(declared.field.type, declared.field.preset), .driven = true};
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

  void check_called(const Declared& declared, const Part& part) {
    if (!part.called) {
      error(error::uncalled_instance, declared.variable->name.span,
            fmt::format("'{}' is never called", declared.field.name),
            fmt::format("Call it: {}(…); or remove the declaration.", declared.field.name));
    }
  }

  Wire unconnected(const std::string& path, const Declared& declared, const Field& field, bool parameter,
                   const Part& part) {
    if (parameter) {
      open_parameters_.push_back({.path = upper(path) + "." + upper(field.name),
                                  .field = field,
                                  .value = std::vector<double>(field.length, field.preset),
                                  .span = declared.variable->name.span});
      return {Wire::From::Parameter, field.type, 0, static_cast<std::uint32_t>(open_parameters_.size() - 1)};
    }
    if (field.required && part.called) {
      error(error::unconnected_input, part.call, fmt::format("{}.{} is not connected", declared.field.name, field.name),
            fmt::format("Connect it: {}({} := …). {}", declared.field.name, field.name, field.meaning));
    }
    return builder_.literal(field.type, field.preset);
  }

  const Definitions& definitions_;
  const language::SourceFile& source_;
  Diagnostics& diagnostics_;
  Graph graph_;
  GraphBuilder builder_;
  std::vector<Slot> slots_;
  std::vector<Parameter> open_parameters_;
};

}  // namespace

Graph elaborate(const Definitions& definitions, std::uint32_t top, Diagnostics& diagnostics) {
  return Elaborator(definitions, diagnostics).run(top);
}

}  // namespace hysteron
