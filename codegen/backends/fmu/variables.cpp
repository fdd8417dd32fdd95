#include "codegen/backends/fmu/variables.hpp"

#include <fmt/format.h>

#include "codegen/backends/c/dialect.hpp"
#include "codegen/backends/c_family/names.hpp"
#include "codegen/graph/units.hpp"

namespace hysteron {
namespace {

FmuVariable of_port(const Port& port, FmuVariable::Role role, std::string_view group, std::string_view member) {
  return {.name = port.name,
          .role = role,
          .type = port.type,
          .unit = port.unit,
          .meaning = port.meaning,
          .start = port.preset,
          .minimum = port.minimum,
          .maximum = port.maximum,
          .member = fmt::format("{}.{}", group, member)};
}

double as_float(double value) {
  return static_cast<double>(static_cast<float>(value));
}

}  // namespace

std::vector<FmuVariable> fmu_variables(const Program& program, bool float32) {
  const Graph& graph = program.graph;
  const Routine routine = make_routine(program);
  const StructLayout layout(graph, routine, c_words());
  const Layout& names = layout.names();
  std::vector<FmuVariable> list;
  for (std::size_t i = 0; i < graph.inputs.size(); ++i) {
    list.push_back(of_port(graph.inputs[i], FmuVariable::Role::Input, "in", names.inputs[i]));
  }
  for (std::size_t i = 0; i < graph.outputs.size(); ++i) {
    list.push_back(of_port(graph.outputs[i], FmuVariable::Role::Output, "out", names.outputs[i]));
  }
  const auto units = units::Solution(graph, program.schedule).parameters();
  for (std::size_t i = 0; i < graph.parameters.size(); ++i) {
    const Parameter& parameter = graph.parameters[i];
    const Member& member = names.parameters[i];
    for (std::size_t k = 0; k < parameter.value.size(); ++k) {
      const bool array = parameter.field.length > 1;
      list.push_back({.name = array ? fmt::format("{}[{}]", parameter.path, k + 1) : parameter.path,
                      .role = FmuVariable::Role::Parameter,
                      .type = parameter.field.type,
                      .unit = units[i],
                      .meaning = std::string(parameter.field.meaning),
                      .start = parameter.value[k],
                      .minimum = parameter.field.minimum,
                      .maximum = parameter.field.maximum,
                      .above_minimum = parameter.field.above_minimum,
                      .member = fmt::format("params.{}{}{}{}", member.group, member.group.empty() ? "" : ".",
                                            member.name, array ? fmt::format("[{}]", k) : "")});
    }
  }
  for (FmuVariable& one : list) {
    if (float32 && one.type == Type::Real) {
      one.start = as_float(one.start);
      one.minimum = as_float(one.minimum);
      one.maximum = as_float(one.maximum);
    }
  }
  return list;
}

}  // namespace hysteron
