// A block with a sequential body: its statements are executed once, with wires for values.
#include <fmt/format.h>

#include <map>
#include <set>
#include <string>
#include <utility>

#include "codegen/graph/body/body.hpp"
#include "codegen/graph/body/memory_ranges.hpp"
#include "codegen/graph/elaborator.hpp"

namespace hysteron {

void Elaborator::elaborate_body(const Instance& instance) {
  const Definition& definition = *instance.definition;
  std::set<std::uint32_t> warned;  // in a loop, each place once
  const auto report = [&](int number, Span span, std::string cause, std::string mend) {
    if (number == error::other_meaning_elsewhere) {
      if (!warned.insert(span.offset).second) {
        return;
      }
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
  const auto& unit = library.units[definition.block->body];
  bodies::Surroundings around{.builder = builder_,
                              .report = report,
                              .add_parameter = add_parameter,
                              .path = instance.path,
                              .rate = instance.rate,
                              .sample_time_ns = graph_.sample_time_ns * instance.rate.every};
  const bodies::MemoryRanges memory = bodies::memory_ranges(library, unit, around, inputs);
  around.memory = memory.empty() ? nullptr : &memory;
  bodies::Body body(library, unit, std::move(around));
  for (const auto* const global : body.shared()) {
    const auto [owner, is_first] = owners_.try_emplace(global->name.text, instance.path);
    if (!is_first) {
      const auto instance_name = [](std::string_view path) { return path.substr(0, path.size() - 1); };
      error(error::refused_section, global->name.span,
            fmt::format("the global variable '{}' joins the instances {} and {}", global->name.text,
                        instance_name(owner->second), instance_name(instance.path)),
            "Each has a memory of its own: put the variable into their block, or hand it over as input and output.");
    }
  }
  auto results = body.run(inputs);
  levels_.resize(graph_.nodes.size(), instance.level);
  for (std::size_t i = 0; i < definition.variables.size(); ++i) {
    const Declared& declared = definition.variables[i];
    Slot& slot = slots_[instance.first_slot + i];
    if (declared.kind == Declared::Kind::Output) {
      const auto found = results.find(declared.port);
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
