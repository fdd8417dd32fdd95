#include "codegen/backends/st/names.hpp"

#include <fmt/format.h>

#include <set>

#include "codegen/backends/st/words.hpp"
#include "support/element_name.hpp"
#include "support/errors.hpp"

namespace hysteron {

/// A name of the diagram, by which it is known outside: where it cannot be kept, the head of the file says so.
std::string_view StBlockNames::keep(std::string_view name) {
  if (keeps_pins_) {
    return identifiers_.take(st_pin_name(name, dialect_));
  }
  const std::string_view kept = identifiers_.make({name});
  const bool plain = element_of(name) && language::same_name(kept, identifier_text({name}, LetterCase::Upper));
  if (!plain && !language::same_name(kept, name)) {  // of a vector of one element X[0] is X_0, as a matter of course
    const bool odd = name.ends_with('_') || name.find("__") != std::string_view::npos;
    renamed_ += fmt::format("   {} is called {}: {}.\n", name, kept,
                            odd ? "IEC 61131-3 has single underscores, and none at the end of a name"
                                : "its name is taken, or some compiler keeps it for itself");
  }
  return kept;
}

StBlockNames::StBlockNames(const Graph& graph, const Routine& routine, const StDialect& dialect, const StCalls* calls,
                           bool keeps_pins)
    : dialect_(dialect),
      keeps_pins_(keeps_pins),
      identifiers_(dialect.shape == StDialect::Shape::Source ? is_scl_word : is_st_word, LetterCase::Upper) {
  if (calls != nullptr) {
    std::set<std::string_view> taken;
    for (const StCalls::BlockName& one : calls->blocks) {
      if (taken.insert(one.type).second) {
        identifiers_.make({one.type});
      }
    }
  }
  name_ports(graph.inputs, inputs_, layout_.inputs);
  name_ports(graph.outputs, outputs_, layout_.outputs);
  block_ = keep(graph.name);
  reset_ = identifiers_.make({"RESET"});
  if (reset_ != "RESET") {  // the diagram has an input of this name
    reset_ = identifiers_.make({"RESET_ALL"});
  }
  for (const Parameter& parameter : graph.parameters) {
    const bool setting = calls != nullptr && calls->made.is_setting[layout_.parameters.size()];
    layout_.parameters.push_back({.name = setting       ? std::string_view()
                                          : keeps_pins_ ? keep(parameter.path)
                                                        : identifiers_.make({parameter.path})});
  }
  started_ = identifiers_.make({"STARTED"});
  own_ = {.sample_time = identifiers_.make({"TS"}),
          .largest = identifiers_.make({"LARGEST"}),
          .place = identifiers_.make({"PLACE"})};
  if (calls != nullptr) {
    name_instances(graph, *calls);
  }
  for (const PortGroup& cells : cell_groups(std::span(routine.cells).subspan(layout_.cells.size()))) {
    const std::string_view instance = routine.cells[layout_.cells.size()].instance;
    const std::string_view name = identifiers_.make({instance, cells.name});
    for (std::uint32_t i = 0; i < cells.length; ++i) {
      layout_.cells.push_back(
          {.name = cells.is_array() ? std::string_view(elements_.emplace_back(element_name(name, i))) : name});
    }
  }
}

void StBlockNames::name_ports(const std::vector<Port>& ports, std::vector<std::string>& names,
                              std::vector<std::string_view>& list) {
  names = port_names(groups(ports), [this](const PortGroup& group) { return keep(group.name); });
  list.assign(names.begin(), names.end());
}

/// The pins of a block of the library are single ones, since each may be wired by itself.
std::vector<PortGroup> StBlockNames::groups(const std::vector<Port>& ports) const {
  if (!keeps_pins_) {
    return port_groups(ports);
  }
  std::vector<PortGroup> single;
  for (std::uint32_t i = 0; i < ports.size(); ++i) {
    single.push_back({.name = ports[i].name, .first = i});
  }
  return single;
}

void StBlockNames::name_instances(const Graph& graph, const StCalls& calls) {
  layout_.instances.resize(graph.nodes.size());
  for (const BlockInstance& one : calls.made.instances) {
    layout_.instances[one.node] = identifiers_.make({graph.nodes[one.node].path});
  }
  for (std::uint32_t i = 0; i < calls.made.output_cells; ++i) {
    const CellInfo& cell = calls.made.routine.cells[i];
    const std::string pin =
        element_of(cell.field.name) ? st_pin_name(cell.field.name, dialect_) : std::string(cell.field.name);
    outputs_of_instances_.push_back(fmt::format("{}.{}", layout_.instances[cell.node], pin));
    layout_.cells.push_back({.name = outputs_of_instances_.back()});
  }
}

void refuse_long_names(const Graph& graph, const Routine& routine, const Layout& layout, const StDialect& dialect) {
  Diagnostics diagnostics;
  const auto check = [&](std::string_view name, Place place) {
    if (dialect.longest_name != 0 && name.size() > dialect.longest_name) {
      diagnostics.error(
          error::name_too_long, std::move(place),
          fmt::format("{} has {} characters; {} allows {}", name, name.size(), dialect.name, dialect.longest_name),
          "shorten the names of the instances that it is made of");
    }
  };
  for (std::size_t i = 0; i < graph.inputs.size(); ++i) {
    check(layout.inputs[i], graph.place(graph.inputs[i].span));
  }
  for (std::size_t i = 0; i < graph.outputs.size(); ++i) {
    check(layout.outputs[i], graph.place(graph.outputs[i].span));
  }
  for (std::size_t i = 0; i < graph.parameters.size(); ++i) {
    check(layout.parameters[i].name, graph.place(graph.parameters[i].span));
  }
  for (std::size_t i = 0; i < routine.cells.size(); ++i) {
    check(variable_of(layout.cells[i].name), graph.place(graph.nodes[routine.cells[i].node].span));
  }
  if (diagnostics.has_errors()) {
    throw InputError(std::move(diagnostics));
  }
}

}  // namespace hysteron
