#include "codegen/backends/fmu/variables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "codegen/backends/c/dialect.hpp"
#include "codegen/backends/c_family/names.hpp"
#include "codegen/backends/shared/port_groups.hpp"
#include "codegen/graph/units.hpp"
#include "support/element_name.hpp"
#include "support/single.hpp"

namespace hysteron {
namespace {

FmuVariable of_port(const Port& port, FmuVariable::Role role, std::string_view group, std::string_view member) {
  // The structured names of FMI have no index below 0; in quotes any text is a name.
  const auto element = element_of(port.name);
  return {.name = element && element->index < 0 ? fmt::format("'{}'", port.name) : port.name,
          .role = role,
          .type = port.type,
          .unit = port.unit,
          .meaning = port.meaning,
          .start = {port.preset},
          .minimum = port.minimum,
          .maximum = port.maximum,
          .member = fmt::format("{}.{}", group, member)};
}

}  // namespace

std::vector<FmuVariable> fmu_variables(const Program& program, const FmuOptions& options) {
  const Graph& graph = program.graph;
  const Routine routine = make_routine(program);
  const StructLayout layout(graph, routine, c_words());
  const Layout& names = layout.names();
  std::vector<FmuVariable> list;
  // `array` is the name of the array that this is the element `place` of: they differ in their start values alone.
  const auto add = [&](FmuVariable one, std::string_view array, std::size_t place) {
    const bool joined = !array.empty() && options.version == FmiVersion::Three;
    if (joined && place > 0) {
      list.back().start.push_back(one.start.front());
      return;
    }
    if (joined) {
      one.name = array;
      one.array = true;
    }
    list.push_back(std::move(one));
  };
  const auto add_ports = [&](const std::vector<Port>& ports, FmuVariable::Role role, std::string_view member,
                             const auto& members) {
    for (const PortGroup& group : port_groups(ports)) {
      for (std::uint32_t k = 0; k < group.length; ++k) {
        const std::size_t i = group.first + k;
        add(of_port(ports[i], role, member, members[i]), group.is_array() ? group.name : std::string_view(), k);
      }
    }
  };
  add_ports(graph.inputs, FmuVariable::Role::Input, "in", names.inputs);
  add_ports(graph.outputs, FmuVariable::Role::Output, "out", names.outputs);
  const auto units = units::Solution(graph, program.schedule).parameters();
  for (std::size_t i = 0; i < graph.parameters.size(); ++i) {
    const Parameter& parameter = graph.parameters[i];
    const Member& member = names.parameters[i];
    for (std::size_t k = 0; k < parameter.value.size(); ++k) {
      const bool array = parameter.field.length > 1;
      add({.name = array ? fmt::format("{}[{}]", parameter.path, k + 1) : parameter.path,
           .role = FmuVariable::Role::Parameter,
           .type = parameter.field.type,
           .unit = units[i],
           .meaning = std::string(parameter.field.meaning),
           .start = {parameter.value[k]},
           .minimum = parameter.field.minimum,
           .maximum = parameter.field.maximum,
           .above_minimum = parameter.field.above_minimum,
           .member = fmt::format("params.{}{}{}{}", member.group, member.group.empty() ? "" : ".", member.name,
                                 array ? fmt::format("[{}]", k) : "")},
          array ? std::string_view(parameter.path) : std::string_view(), k);
    }
  }
  for (FmuVariable& one : list) {
    if (options.float32 && one.type == Type::Real) {
      std::ranges::transform(one.start, one.start.begin(), nearest_single);
      one.minimum = nearest_single(one.minimum);
      one.maximum = nearest_single(one.maximum);
    }
  }
  return list;
}

}  // namespace hysteron
