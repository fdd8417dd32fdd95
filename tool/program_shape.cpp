#include "tool/program_shape.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "codegen/backends/shared/routine.hpp"
#include "codegen/graph/fmu_block.hpp"
#include "codegen/graph/relations.hpp"
#include "codegen/graph/sample_time.hpp"
#include "codegen/graph/units.hpp"
#include "codegen/program_hash.hpp"
#include "runtime/task/layout_text.hpp"

namespace hysteron::tool {
namespace {

using runtime::PointType;
using runtime::ProgramShape;
using runtime::ProgramSignal;

ProgramSignal signal_of(const Port& port) {
  return {.name = port.name,
          .unit = port.unit,
          .meaning = port.meaning,
          .type = point_type(port.type),
          .preset = port.preset,
          .low = port.minimum,
          .high = port.maximum};
}

/// With elements of arrays counted one by one, as the parameters of a shape are.
std::vector<runtime::ProgramRelation> relations_of(const Graph& graph) {
  std::vector<std::size_t> first;
  std::size_t count = 0;
  for (const Parameter& parameter : graph.parameters) {
    first.push_back(count);
    count += parameter.value.size();
  }
  const auto number_of = [&](const RisingNumbers::Number& one) {
    return one.parameter ? runtime::RelatedNumber{.parameter = first[*one.parameter] + one.element}
                         : runtime::RelatedNumber{.constant = one.constant};
  };
  std::vector<runtime::ProgramRelation> relations;
  for (const RisingNumbers& rising : rising_numbers(graph)) {
    runtime::ProgramRelation relation{.strictly = rising.strictly};
    std::ranges::transform(rising.numbers, std::back_inserter(relation.numbers), number_of);
    if (rising.count) {
      relation.count = number_of(*rising.count);
    }
    relations.push_back(std::move(relation));
  }
  return relations;
}

std::vector<runtime::StateField> state_of(const Program& program, const units::Solution& units, bool float32) {
  const Graph& graph = program.graph;
  const Routine routine = make_routine(program);
  const auto of_states = units.states();
  const auto of_outputs = units.outputs();
  std::vector<runtime::StateField> state;
  for (const CellInfo& cell : routine.cells) {
    runtime::StateField field{
        .name = std::string(cell.instance) + (cell.instance.empty() ? "" : ".") + std::string(cell.field.name),
        .type = cell.field.type == Type::Real && float32 ? PointType::real32 : point_type(cell.field.type),
        .length = cell.field.length};
    const BlockType* const block = cell.instance.empty() ? nullptr : graph.nodes[cell.node].block;
    if (block != nullptr) {
      field.block = block->about.name;
      field.unit = cell.held ? of_outputs[cell.node][cell.place] : of_states[cell.node][cell.place];
    } else if (cell.instance.empty()) {
      field.unit = fmt::format("of {} steps", routine.longest_period);  // of another period it would be another count
    }
    state.push_back(std::move(field));
  }
  return state;
}

}  // namespace

PointType point_type(Type type) {
  switch (type) {
    case Type::Bool:
      return PointType::boolean;
    case Type::Int:
      return PointType::int32;
    case Type::Word:
      return PointType::uint16;
    default:
      return PointType::real64;
  }
}

ProgramShape shape_of(const Program& program, Engine engine, bool float32) {
  const Graph& graph = program.graph;
  require_generable(graph);
  ProgramShape shape{.name = graph.name, .period = graph.sample_time_ns};
  for (const Port& port : graph.inputs) {
    shape.inputs.push_back(signal_of(port));
  }
  for (const Port& port : graph.outputs) {
    shape.outputs.push_back(signal_of(port));
  }
  const units::Solution units(graph, program.schedule);
  const auto of_parameters = units.parameters();
  std::size_t index = 0;
  Program plain = program;
  for (Parameter& parameter : plain.graph.parameters) {
    for (std::size_t element = 0; element < parameter.value.size(); ++element) {
      shape.parameters.push_back(
          {.name = parameter.field.length > 1 ? fmt::format("{}[{}]", parameter.path, element) : parameter.path,
           .unit = of_parameters[index],
           .meaning = std::string(parameter.field.meaning),
           .type = point_type(parameter.field.type),
           .preset = parameter.value[element],
           .low = parameter.field.minimum,
           .high = parameter.field.maximum,
           .low_excluded = parameter.field.above_minimum});
    }
    ++index;
    std::ranges::fill(parameter.value, 0.0);  // the values do not belong to the layout
  }
  shape.relations = relations_of(graph);
  shape.state = state_of(program, units, float32);
  shape.layout = runtime::layout_text(program_hash(plain), engine == Engine::compiled, float32);
  return shape;
}

}  // namespace hysteron::tool
