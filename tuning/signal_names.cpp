#include "tuning/signal_names.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>

#include "support/element_name.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"

namespace hysteron {
namespace {

/// Variables, ports of nested blocks, and the outputs of instances, as INSTANCE.PIN.
std::vector<NamedSignal> signals_of(const Graph& graph) {
  std::vector<NamedSignal> signals;
  for (const NamedWire& named : graph.named) {
    signals.push_back({.name = named.path, .wire = named.wire});
  }
  for (std::uint32_t index = 0; index < graph.nodes.size(); ++index) {
    const Node& node = graph.nodes[index];
    for (std::size_t i = 0; node.block != nullptr && i < node.block->outputs.size(); ++i) {
      signals.push_back(
          {.name = fmt::format("{}.{}", node.path, node.block->outputs[i].name),
           .wire = {Wire::From::Node, node.block->outputs[i].type, static_cast<std::uint16_t>(i), index}});
    }
  }
  return signals;
}

}  // namespace

std::vector<NamedSignal> find_signals(const Graph& graph, const std::string& path, const Place& place) {
  const std::vector<NamedSignal> signals = signals_of(graph);
  std::vector<NamedSignal> found;
  std::vector<std::string> names;
  for (const NamedSignal& one : signals) {
    if (equal_ignoring_case(one.name, path)) {
      return {{.name = path, .wire = one.wire}};
    }
    if (is_or_is_element_of(one.name, path)) {
      found.push_back(one);
    }
    names.push_back(one.name);
  }
  if (!found.empty()) {
    return found;
  }
  const auto near = nearest_name(path, names);
  throw InputError(error::unknown_signal, place, fmt::format("{} has no signal {}.", graph.name, path),
                   near.empty() ? "name a variable, an output of an instance, as INSTANCE.XOUT, or either inside a "
                                  "nested block, as PLANT.HYST.XOUT."
                                : fmt::format("did you mean {}?", near));
}

Wire find_signal(const Graph& graph, const std::string& path, const Place& place) {
  const std::vector<NamedSignal> found = find_signals(graph, path, place);
  if (found.size() > 1) {
    throw InputError(error::unknown_signal, place, fmt::format("{} is a vector, and one signal is meant.", path),
                     fmt::format("name an element, as {}.", found.front().name));
  }
  return found.front().wire;
}

std::vector<std::string> names_of(const std::vector<Port>& ports) {
  std::vector<std::string> names;
  std::ranges::transform(ports, std::back_inserter(names), &Port::name);
  return names;
}

std::optional<std::size_t> find_port(const Graph& graph, const std::vector<Port>& ports, std::string_view kind,
                                     const parameters::PlacedText& wanted, Diagnostics& diagnostics) {
  if (const Port* const found = find_port(ports, wanted.text)) {
    return static_cast<std::size_t>(found - ports.data());
  }
  const std::vector<std::string> names = names_of(ports);
  const auto near = nearest_name(wanted.text, names);
  diagnostics.error(error::unknown_key, wanted.place, fmt::format("{} has no {} {}.", graph.name, kind, wanted.text),
                    near.empty() ? fmt::format("the {}s are {}.", kind, fmt::join(names, ", "))
                                 : fmt::format("did you mean {}?", near));
  return std::nullopt;
}

}  // namespace hysteron
