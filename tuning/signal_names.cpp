#include "tuning/signal_names.hpp"

#include <fmt/format.h>

#include <vector>

#include "support/errors.hpp"
#include "support/names.hpp"

namespace hysteron {
namespace {

/// Variables, ports of nested blocks, and the outputs of instances, as INSTANCE.PIN.
std::vector<std::string> signal_names(const Graph& graph) {
  std::vector<std::string> names;
  for (const NamedWire& named : graph.named) {
    names.push_back(named.path);
  }
  for (const Node& node : graph.nodes) {
    for (std::size_t i = 0; node.block != nullptr && i < node.block->outputs.size(); ++i) {
      names.push_back(fmt::format("{}.{}", node.path, node.block->outputs[i].name));
    }
  }
  return names;
}

}  // namespace

Wire find_signal(const Graph& graph, const std::string& path, const Place& place) {
  for (const NamedWire& named : graph.named) {
    if (equal_ignoring_case(named.path, path)) {
      return named.wire;
    }
  }
  const auto dot = path.rfind('.');
  for (std::uint32_t index = 0; dot != std::string::npos && index < graph.nodes.size(); ++index) {
    const Node& node = graph.nodes[index];
    if (node.block == nullptr || !equal_ignoring_case(node.path, path.substr(0, dot))) {
      continue;
    }
    for (std::size_t i = 0; i < node.block->outputs.size(); ++i) {
      if (equal_ignoring_case(node.block->outputs[i].name, path.substr(dot + 1))) {
        return {Wire::From::Node, node.block->outputs[i].type, static_cast<std::uint16_t>(i), index};
      }
    }
  }
  const auto names = signal_names(graph);
  const auto near = nearest_name(path, names);
  throw InputError(error::unknown_signal, place, fmt::format("{} has no signal {}.", graph.name, path),
                   near.empty() ? "name a variable, an output of an instance, as INSTANCE.XOUT, or either inside a "
                                  "nested block, as PLANT.HYST.XOUT."
                                : fmt::format("did you mean {}?", near));
}

}  // namespace hysteron
