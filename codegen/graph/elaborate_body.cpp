// A block with a sequential body: its statements are executed once, with wires for values.
#include <map>
#include <string>
#include <utility>

#include "codegen/graph/body/body.hpp"
#include "codegen/graph/elaborator.hpp"
#include "codegen/graph/vectors.hpp"

namespace hysteron {

void Elaborator::elaborate_body(const Instance& instance) {
  const Definition& definition = *instance.definition;
  const auto report = [&](int number, Span span, std::string cause, std::string mend) {
    if (number == error::other_meaning_elsewhere) {
      diagnostics_.warning(number, source_.place(span), std::move(cause), std::move(mend));
      return;
    }
    error(number, span, std::move(cause), std::move(mend));
  };
  const auto add_parameter = [&](Parameter parameter) -> Wire {
    const Type type = parameter.field.type;
    open_parameters_.push_back(std::move(parameter));
    return {Wire::From::Parameter, type, 0, static_cast<std::uint32_t>(open_parameters_.size() - 1)};
  };
  std::map<std::string, Wire> inputs;
  for (std::size_t i = 0; i < definition.variables.size(); ++i) {
    const Declared& declared = definition.variables[i];
    if (declared.kind == Declared::Kind::Input || declared.kind == Declared::Kind::Parameter) {
      const Wire& wire = slots_[instance.first_slot + i].wire;
      // What an instance is given is known when its caller has been read: the variable stands for it till then.
      inputs[upper(declared.field.name)] =
          instance.top ? wire : alias(instance.first_slot + static_cast<std::uint32_t>(i), declared.field.type);
    }
  }
  const auto& library = *source_.bodies;
  bodies::Body body(library, library.units[definition.block->body],
                    {.builder = builder_,
                     .report = report,
                     .add_parameter = add_parameter,
                     .path = instance.path,
                     .rate = instance.rate,
                     .sample_time_ns = graph_.sample_time_ns * instance.rate.every});
  auto results = body.run(inputs);
  levels_.resize(graph_.nodes.size(), instance.level);
  for (std::size_t i = 0; i < definition.variables.size(); ++i) {
    const Declared& declared = definition.variables[i];
    Slot& slot = slots_[instance.first_slot + i];
    if (declared.kind == Declared::Kind::Output) {
      // The output of a VAR_IN_OUT has a name of its own, behind that of the variable.
      const auto element = element_of(declared.field.name);
      const auto name = declared.variable->name.text;
      const auto found = results.find(upper(element ? element_name(name, element->index) : std::string(name)));
      slot.driven = true;
      slot.span = declared.variable->name.span;
      slot.level = instance.level;
      slot.wire = found == results.end() ? builder_.literal(declared.field.type, 0.0) : found->second;
    }
    note_unit(instance, i);
    note_name(instance, i);
  }
}

}  // namespace hysteron
