#include "codegen/backends/st/sections.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <bit>
#include <cstdint>
#include <span>
#include <utility>

#include "codegen/backends/shared/calls.hpp"
#include "codegen/backends/st/comment.hpp"
#include "codegen/backends/st/declarations.hpp"
#include "codegen/graph/defaults.hpp"
#include "support/numbers.hpp"

namespace hysteron {

StVariable StSections::of_field(std::string_view name, const Field& field, std::string remark) const {
  return {.name = std::string(name),
          .type = type(field.type),
          .length = field.length,
          .values = {},
          .remark = std::move(remark)};
}

/// Where the blocks of the library stand in the same file, arrays are handed from one to another.
bool StSections::has_array_types() const {
  return (options_.library || options_.calls != nullptr) && options_.dialect.shape == StDialect::Shape::OneFile;
}

StVariable StSections::of_ports(const std::vector<Port>& ports, const PortGroup& group, std::string_view name,
                                std::string_view meaning, bool with_value) const {
  const Port& port = ports[group.first];
  StVariable variable{.name = std::string(variable_of(name)),
                      .type = type(port.type),
                      .length = group.length,
                      .values = {},
                      .remark = st_remark(port.unit, port.minimum, port.maximum, false, meaning)};
  for (std::uint32_t i = 0; with_value && i < group.length; ++i) {
    variable.values.push_back(printer_.literal(port.type, ports[group.first + i].preset));
  }
  return variable;
}

std::vector<StSection> StSections::all() const {
  std::vector<StSection> list;
  if (options_.dialect.shape == StDialect::Shape::Source) {
    std::vector<StVariable> both = inputs();
    for (StVariable& one : parameters()) {
      both.push_back(std::move(one));
    }
    list.push_back({.keyword = "VAR_INPUT", .variables = std::move(both)});
  } else {
    list.push_back({.keyword = "VAR_INPUT", .variables = inputs()});
    list.push_back({.keyword = "VAR_INPUT",
                    .remark = options_.library ? "parameters" : "parameters, at their tuned values",
                    .variables = parameters()});
  }
  list.push_back({.keyword = "VAR_OUTPUT", .variables = outputs()});
  list.push_back({.keyword = "VAR CONSTANT", .variables = constants()});
  if (options_.calls != nullptr) {
    list.push_back({.keyword = "VAR", .remark = "blocks", .variables = instances()});
  }
  list.push_back({.keyword = "VAR", .remark = "memory, from step to step", .variables = memory()});
  list.push_back({.keyword = options_.dialect.temporary_section ? "VAR_TEMP" : "VAR",
                  .remark = "values within a step",
                  .variables = locals(),
                  .names_share_lines = true});
  std::erase_if(list, [](const StSection& one) { return one.variables.empty(); });
  return list;
}

std::vector<StVariable> StSections::inputs() const {
  std::vector<StVariable> list;
  for (const PortGroup& group : names_.groups(graph_.inputs)) {
    const Port& port = graph_.inputs[group.first];
    list.push_back(
        of_ports(graph_.inputs, group, names_.layout().inputs[group.first], port.meaning, has_default(graph_, port)));
  }
  list.push_back({.name = std::string(names_.reset()),
                  .type = "BOOL",
                  .values = {"FALSE"},
                  .remark = options_.library ? "TRUE: the memory begins anew, and no step is made"
                                             : "TRUE: the memory begins anew, before this step"});
  if (has_no_memory()) {
    list.pop_back();
  }
  return list;
}

std::vector<StVariable> StSections::parameters() const {
  std::vector<StVariable> list;
  for (std::size_t i = 0; i < graph_.parameters.size(); ++i) {
    if (options_.calls == nullptr || (!options_.calls->made.is_setting[i] && graph_.parameters[i].field.length == 1)) {
      list.push_back(parameter(i));
    }
  }
  if (options_.library && printer_.uses_sample_time) {
    list.push_back({.name = std::string(names_.own().sample_time),
                    .type = type(Type::Real),
                    .values = {printer_.literal(Type::Real, graph_.sample_time())},
                    .remark = "[s] sample time: how often the block is called"});
  }
  return list;
}

StVariable StSections::parameter(std::size_t i) const {
  const Field& field = graph_.parameters[i].field;
  StVariable variable =
      of_field(names_.layout().parameters[i].name, field,
               st_remark(field.unit, field.minimum, field.maximum, field.above_minimum, field.meaning));
  if (has_array_types() && field.length > 1) {
    variable.array_type = st_array_type(field.length);
  }
  for (std::size_t element = 0; element < field.length; ++element) {
    variable.values.push_back(printer_.literal(field.type, graph_.parameters[i].value[element]));
  }
  return variable;
}

/// The blocks of the diagram, with the parameters that are theirs alone, and the arrays that are handed to them.
std::vector<StVariable> StSections::instances() const {
  std::vector<StVariable> list;
  for (std::size_t i = 0; i < options_.calls->made.instances.size(); ++i) {
    const BlockInstance& one = options_.calls->made.instances[i];
    const Node& node = graph_.nodes[one.node];
    std::vector<std::string> settings;
    for (const std::uint32_t index : one.settings) {
      const Parameter& given = graph_.parameters[index];
      if (std::bit_cast<std::uint64_t>(given.value.front()) != std::bit_cast<std::uint64_t>(given.field.preset)) {
        settings.push_back(fmt::format("{} := {}", printer_.pin_name(given.field.name),
                                       printer_.literal(given.field.type, given.value.front())));
      }
    }
    if (options_.calls->blocks[i].sample_time && node.rate.every > 1) {
      const double seconds = static_cast<double>(graph_.sample_time_ns * node.rate.every) * 1e-9;
      settings.push_back(fmt::format("TS := {}", printer_.literal(Type::Real, seconds)));
    }
    StVariable variable{.name = std::string(names_.layout().instances[one.node]),
                        .type = options_.calls->blocks[i].type};
    if (!settings.empty()) {
      variable.values = {fmt::format("({})", fmt::join(settings, ", "))};
    }
    list.push_back(std::move(variable));
  }
  for (std::size_t i = 0; i < graph_.parameters.size(); ++i) {
    if (graph_.parameters[i].field.length > 1) {
      list.push_back(parameter(i));
    }
  }
  return list;
}

std::vector<StVariable> StSections::outputs() const {
  std::vector<StVariable> list;
  for (const PortGroup& group : names_.groups(graph_.outputs)) {
    const Port& port = graph_.outputs[group.first];
    list.push_back(of_ports(graph_.outputs, group, names_.layout().outputs[group.first], port.meaning,
                            options_.library && port.preset != 0.0));
  }
  return list;
}

std::vector<StVariable> StSections::constants() const {
  std::vector<StVariable> list;
  const auto add = [&](std::string_view name, double value, std::string_view remark) {
    list.push_back({.name = std::string(name),
                    .type = type(Type::Real),
                    .values = {printer_.literal(Type::Real, value)},
                    .remark = std::string(remark)});
  };
  if (printer_.uses_sample_time && !options_.library) {
    add(names_.own().sample_time, graph_.sample_time(), "sample time, in seconds");
  }
  if (printer_.uses_largest) {
    add(names_.own().largest, infinity, "stands for infinity");
  }
  return list;
}

std::vector<StVariable> StSections::memory() const {
  std::vector<StVariable> list;
  const std::size_t first = options_.calls != nullptr ? options_.calls->made.output_cells : 0;
  const std::vector<std::uint32_t> lengths = declared_lengths(std::span(routine_.cells).subspan(first));
  for (std::size_t i = first; i < routine_.cells.size(); ++i) {
    Field field = routine_.cells[i].field;
    field.length = static_cast<std::uint16_t>(lengths[i - first]);
    if (field.length > 0) {
      list.push_back(of_field(variable_of(names_.layout().cells[i].name), field, std::string(field.meaning)));
    }
  }
  list.push_back(
      {.name = std::string(names_.started()), .type = "BOOL", .values = {"FALSE"}, .remark = "a step has run"});
  if (has_no_memory()) {
    list.clear();
  }
  return list;
}

std::vector<StVariable> StSections::locals() const {
  std::vector<StVariable> list;
  for (const StLocal& local : writer_.locals) {
    list.push_back({.name = std::string(local.name), .type = type(local.type), .length = local.length});
  }
  if (writer_.uses_place) {
    list.push_back({.name = std::string(names_.own().place), .type = "DINT", .remark = "place in an array"});
  }
  if (writer_.uses_term) {
    list.push_back({.name = std::string(writer_.term_name), .type = "DINT", .remark = "term of a sum"});
  }
  return list;
}

}  // namespace hysteron
