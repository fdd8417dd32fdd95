// The structures of a step in C++: Params, State, In and Out, each member with its unit and meaning beside it.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "codegen/backends/c_family/names.hpp"
#include "codegen/backends/c_family/printer.hpp"
#include "codegen/backends/shared/generated_file.hpp"
#include "codegen/backends/shared/layout.hpp"
#include "codegen/backends/shared/port_groups.hpp"
#include "codegen/backends/shared/routine.hpp"

namespace hysteron {

/// `literal(type, value)` is a value as text.
template <class Literal>
struct CppStructs {
  const Graph& graph;
  const Routine& routine;
  const Layout& names;
  const DialectOfC& dialect;
  Literal literal;
  bool in_braces = false;              ///< a literal is one in braces: an array of them needs a second pair round it
  std::string_view counter_meaning{};  ///< of the counter of steps; what the routine says of it where it is empty

  void append_to(std::string& text) const {
    append(text, "struct Params {\n");
    StructLayout::append_grouped(text, names.parameters, [&](std::size_t i) {
      const Parameter& one = graph.parameters[i];
      append_member(text, type_of(dialect, one.field.type), one.field, names.parameters[i], &one.value);
    });
    append(text, "};\n\nstruct State {\n");
    const std::vector<std::uint32_t> lengths = declared_lengths(routine.cells);
    StructLayout::append_grouped(text, names.cells, [&](std::size_t i) { append_cell(text, i, lengths[i]); });
    append(text, "};\n\n");
    append_ports(text, "In", graph.inputs, names.inputs);
    append_ports(text, "Out", graph.outputs, names.outputs);
  }

 private:
  /// Without a value: reset gives it. The counter of steps is one number, whatever an integer of the dialect is.
  void append_cell(std::string& text, std::size_t i, std::uint32_t length) const {
    if (length == 0) {
      return;
    }
    Field field = routine.cells[i].field;
    field.length = static_cast<std::uint16_t>(length);
    const bool is_counter = routine.longest_period > 1 && i == routine.counter;
    field.meaning = is_counter && !counter_meaning.empty() ? counter_meaning : field.meaning;
    append_member(text, is_counter ? "std::int32_t" : type_of(dialect, field.type), field,
                  {.group = names.cells[i].group, .name = variable_of(names.cells[i].name)}, nullptr);
  }

  void append_member(std::string& text, std::string_view type, const Field& field, const Member& member,
                     const std::vector<double>* values) const {
    append(text, member.group.empty() ? "  " : "    ");
    if (field.length > 1) {
      append(text, "std::array<", type, ", ", std::to_string(field.length), "> ");
    } else {
      append(text, type, " ");
    }
    append(text, member.name);
    if (values == nullptr) {
      append(text, "{}");
    } else if (field.length > 1) {
      for (std::size_t i = 0; i < values->size(); ++i) {
        append(text, i > 0 ? ", " : (in_braces ? "{{" : "{"), literal(field.type, (*values)[i]));
      }
      append(text, in_braces ? "}}" : "}");
    } else {
      append(text, " = ", literal(field.type, values->front()));
    }
    append(text, ";");
    append_comment(text, "  // ", field.unit, field.meaning, "");
    append(text, "\n");
  }

  void append_ports(std::string& text, std::string_view name, const std::vector<Port>& ports,
                    const std::vector<std::string_view>& members) const {
    append(text, "struct ", name, " {\n");
    for (const PortGroup& group : port_groups(ports)) {
      const Port& port = ports[group.first];
      Field field;
      field.type = port.type;
      field.unit = port.unit;
      field.meaning = port.meaning;
      field.length = static_cast<std::uint16_t>(group.length);
      std::vector<double> presets;
      for (std::uint32_t i = 0; i < group.length; ++i) {
        presets.push_back(ports[group.first + i].preset);
      }
      append_member(text, type_of(dialect, port.type), field, {.name = variable_of(members[group.first])}, &presets);
    }
    append(text, "};\n\n");
  }
};

}  // namespace hysteron
