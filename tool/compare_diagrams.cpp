#include <fmt/format.h>

#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "codegen/graph/names.hpp"
#include "support/names.hpp"
#include "support/numbers.hpp"
#include "support/utf8.hpp"
#include "tool/comparison.hpp"

namespace hysteron::tool {
namespace {

/// Expressions of both graphs by number: equal expressions have equal numbers, however many share their parts.
class Expressions {
 public:
  using Number = std::size_t;

  Number of_wire(const Graph& graph, const Wire& wire, std::map<std::uint32_t, Number>& known) {
    switch (wire.from) {
      case Wire::From::Nothing:
      case Wire::From::Alias:
        return leaf("nothing");
      case Wire::From::Literal:
        return leaf(literal_text(wire.type, graph.literals[wire.index]));
      case Wire::From::Parameter:
        return leaf("the parameter " + in_capitals(graph.parameters[wire.index].path));
      case Wire::From::Input:
        return leaf(in_capitals(graph.inputs[wire.index].name));
      case Wire::From::Node:
        break;
    }
    const Node& node = graph.nodes[wire.index];
    if (node.block != nullptr) {
      return leaf(fmt::format("{}.{}", in_capitals(node.path), node.block->outputs[wire.port].name));
    }
    if (const auto found = known.find(wire.index); found != known.end()) {
      return found->second;
    }
    std::vector<Number> parts;
    for (std::size_t pin = 0; pin < node.wire_count; ++pin) {
      parts.push_back(of_wire(graph, graph.wire(node, pin), known));
    }
    const Number number = numbered({std::string(info(node.op).name), node.rate.every, node.rate.phase, parts});
    known.emplace(wire.index, number);
    return number;
  }

  /// As long as a line; the rest of a longer one is left out.
  [[nodiscard]] std::string text(Number number) const { return clipped(text(number, 6), 100); }

 private:
  using Key = std::tuple<std::string, std::uint32_t, std::uint32_t, std::vector<Number>>;

  Number leaf(const std::string& name) { return numbered({name, 0, 0, {}}); }
  Number numbered(const Key& key) {
    const auto [found, is_new] = numbers_.emplace(key, keys_.size());
    if (is_new) {
      keys_.push_back(&found->first);
    }
    return found->second;
  }
  [[nodiscard]] std::string text(Number number, int depth) const {
    const auto& [name, every, phase, parts] = *keys_[number];
    if (parts.empty()) {
      return name;
    }
    if (depth == 0) {
      return "…";
    }
    const bool is_word = std::isalpha(static_cast<unsigned char>(name.front())) != 0;
    if (parts.size() == 2 && !is_word) {
      return fmt::format("({} {} {})", text(parts[0], depth - 1), name, text(parts[1], depth - 1));
    }
    std::string list;
    for (const Number part : parts) {
      list += (list.empty() ? "" : ", ") + text(part, depth - 1);
    }
    return fmt::format("{}({})", name, list);
  }

  std::map<Key, Number> numbers_;
  std::vector<const Key*> keys_;
};

/// What of a diagram has a name, and what it is: one table for each kind of thing.
struct Contents {
  using Table = std::map<std::string, std::string>;
  Table ports{};
  Table blocks{};
  Table parameters{};
  Table wires{};
};

std::string port_text(const Port& port, const char* kind) {
  std::string text = fmt::format("{} {}", kind, type_name(port.type));
  text += port.unit.empty() ? "" : fmt::format(" [{}]", port.unit);
  text += port.preset == 0.0 ? "" : fmt::format(" := {}", literal_text(port.type, port.preset));
  text += std::isinf(port.minimum) ? "" : fmt::format(" @min {}", number_text(port.minimum));
  text += std::isinf(port.maximum) ? "" : fmt::format(" @max {}", number_text(port.maximum));
  return text;
}

std::string numbers_text(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) {
    text += (text.empty() ? "" : ", ") + number_text(value);
  }
  return values.size() == 1 ? text : "[" + text + "]";
}

Contents contents_of(const Graph& graph, Expressions& expressions, std::map<std::string, Expressions::Number>& wires) {
  Contents found;
  found.ports["sample time"] =
      graph.sample_time_ns > 0 ? number_text(static_cast<double>(graph.sample_time_ns) / 1e9) + " s" : "not stated";
  std::map<std::uint32_t, Expressions::Number> known;
  for (const Port& input : graph.inputs) {
    found.ports[in_capitals(input.name)] = port_text(input, "input");
  }
  for (const Port& output : graph.outputs) {
    found.ports[in_capitals(output.name)] = port_text(output, "output");
    wires[in_capitals(output.name)] = expressions.of_wire(graph, output.wire, known);
  }
  for (const Parameter& parameter : graph.parameters) {
    found.parameters[in_capitals(parameter.path)] = numbers_text(parameter.value);
  }
  for (const Node& node : graph.nodes) {
    if (node.block == nullptr) {
      continue;
    }
    found.blocks[in_capitals(node.path)] =
        node.rate == Rate{}
            ? std::string(node.block->about.name)
            : fmt::format("{} @every {} @phase {}", node.block->about.name, node.rate.every, node.rate.phase);
    for (std::size_t pin = 0; pin < node.wire_count; ++pin) {
      const Wire& wire = graph.wire(node, pin);
      if (wire.from != Wire::From::Parameter) {
        wires[fmt::format("{}.{}", in_capitals(node.path), node.block->pin(pin).name)] =
            expressions.of_wire(graph, wire, known);
      }
    }
  }
  for (const InitialState& state : graph.initial_states) {
    const Node& node = graph.nodes[state.node];
    found.parameters[fmt::format("initial {}.{}", in_capitals(node.path), node.block->states[state.state].name)] =
        number_text(state.value);
  }
  return found;
}

void compare_tables(const Contents::Table& a, const Contents::Table& b, const char* kind, Comparison& result) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  const auto add = [&](const std::string& name, const std::optional<std::string>& before,
                       const std::optional<std::string>& after) {
    result.same = false;
    const auto json_of = [](const std::optional<std::string>& text) {
      return text ? nlohmann::ordered_json(*text) : nlohmann::ordered_json();
    };
    list.push_back({{"name", name}, {"a", json_of(before)}, {"b", json_of(after)}});
    result.text += before && after ? fmt::format("{} {}: {} -> {}\n", kind, name, *before, *after)
                   : before        ? fmt::format("{} {}: removed, was {}\n", kind, name, *before)
                                   : fmt::format("{} {}: added, {}\n", kind, name, *after);
  };
  for (const auto& [name, before] : a) {
    const auto found = b.find(name);
    if (found == b.end()) {
      add(name, before, std::nullopt);
    } else if (found->second != before) {
      add(name, before, found->second);
    }
  }
  for (const auto& [name, after] : b) {
    if (!a.contains(name)) {
      add(name, std::nullopt, after);
    }
  }
  result.json[std::string(kind) + "s"] = std::move(list);
}

}  // namespace

Comparison compare_diagrams(const Program& a, const Program& b) {
  Expressions expressions;
  std::map<std::string, Expressions::Number> wires_of_a;
  std::map<std::string, Expressions::Number> wires_of_b;
  Contents one = contents_of(a.graph, expressions, wires_of_a);
  Contents other = contents_of(b.graph, expressions, wires_of_b);
  // Wires of what is there on both sides; those of a new block are told by the block.
  for (const auto& [pin, source] : wires_of_a) {
    const auto found = wires_of_b.find(pin);
    if (found != wires_of_b.end() && found->second != source) {
      one.wires[pin] = "from " + expressions.text(source);
      other.wires[pin] = "from " + expressions.text(found->second);
    }
  }
  Comparison result;
  compare_tables(one.ports, other.ports, "port", result);
  compare_tables(one.blocks, other.blocks, "block", result);
  compare_tables(one.parameters, other.parameters, "parameter", result);
  compare_tables(one.wires, other.wires, "wire", result);
  // Two long expressions may read alike up to where they are cut.
  for (const auto& [pin, text] : one.wires) {
    if (other.wires.at(pin) == text) {
      result.same = false;
      result.text += fmt::format("wire {}: {}, and differs further inside\n", pin, text);
    }
  }
  return result;
}

}  // namespace hysteron::tool
