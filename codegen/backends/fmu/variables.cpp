#include "codegen/backends/fmu/variables.hpp"

#include <fmt/format.h>

#include <charconv>
#include <string_view>
#include <utility>

#include "codegen/backends/c/dialect.hpp"
#include "codegen/backends/c_family/names.hpp"
#include "codegen/graph/units.hpp"
#include "support/element_name.hpp"

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

double as_float(double value) {
  return static_cast<double>(static_cast<float>(value));
}

/// The array that an element belongs to, in.x of in.x[3], and its place in it; an empty name where it is none.
std::pair<std::string_view, std::size_t> array_of(std::string_view member) {
  const auto bracket = member.ends_with(']') ? member.rfind('[') : std::string_view::npos;
  std::size_t place = 0;
  if (bracket == std::string_view::npos ||
      std::from_chars(member.data() + bracket + 1, member.data() + member.size() - 1, place).ec != std::errc()) {
    return {};
  }
  return {member.substr(0, bracket), place};
}

/// The elements of an array as one variable: they differ in their start values alone.
std::vector<FmuVariable> joined(const std::vector<FmuVariable>& elements) {
  std::vector<FmuVariable> list;
  for (const FmuVariable& one : elements) {
    const auto [array, place] = array_of(one.member);
    FmuVariable* const last = list.empty() ? nullptr : &list.back();
    if (!array.empty() && place > 0 && last != nullptr && last->array && array_of(last->member).first == array &&
        last->start.size() == place) {
      last->start.push_back(one.start.front());
      continue;
    }
    list.push_back(one);
    if (!array.empty() && place == 0) {
      list.back().array = true;
      list.back().name.resize(one.name.rfind('['));
    }
  }
  return list;
}

}  // namespace

std::vector<FmuVariable> fmu_variables(const Program& program, const FmuOptions& options) {
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
                      .start = {parameter.value[k]},
                      .minimum = parameter.field.minimum,
                      .maximum = parameter.field.maximum,
                      .above_minimum = parameter.field.above_minimum,
                      .member = fmt::format("params.{}{}{}{}", member.group, member.group.empty() ? "" : ".",
                                            member.name, array ? fmt::format("[{}]", k) : "")});
    }
  }
  for (FmuVariable& one : list) {
    if (options.float32 && one.type == Type::Real) {
      one.start.front() = as_float(one.start.front());
      one.minimum = as_float(one.minimum);
      one.maximum = as_float(one.maximum);
    }
  }
  return options.version == FmiVersion::Three ? joined(list) : list;
}

}  // namespace hysteron
