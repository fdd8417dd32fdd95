#include "codegen/backends/plcopen/known_values.hpp"

#include <fmt/format.h>

#include <bit>

namespace hysteron::plcopen {
namespace {

/// Takes one more value; without one, or with other bits, there is none any more.
void agree(KnownValues::Answer& answer, std::optional<double> value) {
  const bool same =
      value && answer.value && std::bit_cast<std::uint64_t>(*value) == std::bit_cast<std::uint64_t>(*answer.value);
  answer.value = !answer.known || same ? value : std::nullopt;
  answer.known = true;
}

}  // namespace

KnownValues::KnownValues(const Program& program, const Definitions& definitions)
    : program_(program), machine_(program), prefixes_(definitions.list.size()) {
  machine_.step();
  place(definitions, definitions.by_name.at(program.graph.name), "");
}

void KnownValues::place(const Definitions& definitions, std::uint32_t index, const std::string& prefix) {
  prefixes_[index].push_back(prefix);
  for (const Declared& declared : definitions.list[index].variables) {
    if (declared.kind == Declared::Kind::UserBlock) {
      place(definitions, declared.definition, fmt::format("{}{}.", prefix, declared.field.name));
    }
  }
}

KnownValues::Answer KnownValues::parameter(std::uint32_t definition, std::string_view path) const {
  Answer answer;
  for (const std::string& prefix : prefixes_[definition]) {
    const std::int64_t found = find_parameter(program_.graph, fmt::format("{}{}", prefix, path));
    if (found >= 0) {
      const Parameter& one = program_.graph.parameters[static_cast<std::size_t>(found)];
      agree(answer, one.value.size() == 1 ? std::optional(one.value.front()) : std::nullopt);
    }
  }
  return answer;
}

KnownValues::Answer KnownValues::start(std::uint32_t definition, std::string_view instance, std::size_t output) const {
  Answer answer;
  for (const std::string& prefix : prefixes_[definition]) {
    for (std::uint32_t i = 0; i < program_.graph.nodes.size(); ++i) {
      const Node& node = program_.graph.nodes[i];
      if (node.block != nullptr && language::same_name(node.path, fmt::format("{}{}", prefix, instance))) {
        agree(answer, machine_.value({.from = Wire::From::Node,
                                      .type = node.block->outputs[output].type,
                                      .port = static_cast<std::uint16_t>(output),
                                      .index = i}));
      }
    }
  }
  return answer;
}

}  // namespace hysteron::plcopen
