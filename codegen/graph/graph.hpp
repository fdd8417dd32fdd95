// The graph of a diagram: blocks and operations, and the wires between them, with all hierarchy flattened.
//
// It is what the checks, the scheduler, the interpreter and every back-end work on. Nothing in it depends on the
// order in which the text named things: nodes are sorted by name.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "blocks/description.hpp"
#include "codegen/language/syntax.hpp"
#include "codegen/trace/block_type.hpp"
#include "codegen/trace/operation.hpp"
#include "support/diagnostic.hpp"

namespace hysteron {

/// Where a pin gets its value.
struct Wire {
  enum class From : std::uint8_t {
    Nothing,
    Literal,
    Parameter,
    Input,
    Node,
    Alias  ///< a variable of the text; only while a graph is being built
  };
  From from = From::Nothing;
  Type type = Type::Real;
  std::uint16_t port = 0;   ///< From::Node: which output
  std::uint32_t index = 0;  ///< which literal, parameter, input or node

  bool operator==(const Wire&) const = default;
};

/// An input or output of the diagram.
struct Port {
  std::string name{};
  std::string unit{};
  std::string meaning{};
  Type type = Type::Real;
  double preset = 0.0;
  double minimum = -std::numeric_limits<double>::infinity();
  double maximum = std::numeric_limits<double>::infinity();
  Wire wire{};  ///< outputs: what drives it
  language::Span span{};
};

/// A number that is constant over a run and may be set and tuned: a block's parameter, or an input marked @param.
struct Parameter {
  std::string path{};         ///< INV.C1; upper case
  Field field{};              ///< name, unit, range, meaning
  std::vector<double> value;  ///< one number, or the elements of an array
  language::Span span{};
};

/// How often a node runs: in the steps k with k mod every = phase.
struct Rate {
  std::uint32_t every = 1;
  std::uint32_t phase = 0;
  bool operator==(const Rate&) const = default;
};

/// An instance of a block (type set), or an operation of an expression.
struct Node {
  const BlockType* block = nullptr;  ///< null: an operation
  Op op = Op::Add;
  Rate rate{};
  std::uint32_t first_wire = 0;  ///< pins of a block in the order of its description; operands of an operation
  std::uint32_t wire_count = 0;
  std::string path{};  ///< PLANT.HYST; for an operation, the pin that it feeds: INV.R1#0
  language::Span span{};
  /// What the text calls it: the block, or the pin that an operation feeds, INV.R1.
  [[nodiscard]] std::string_view owner() const { return std::string_view(path).substr(0, path.find('#')); }
};

/// A variable of the text, an input, or a port of a nested block, and what drives it: RATE, PLANT.RATE, PLANT.Y.
struct NamedWire {
  std::string path{};
  Wire wire{};
};

/// The value of a state after a reset, instead of the one that its block says.
struct InitialState {
  std::uint32_t node = 0;
  std::uint32_t state = 0;  ///< of type LREAL, and no array
  double value = 0.0;
};

/// The generated counter of steps is a DINT, and counts up to the time after which all rates repeat together.
constexpr std::uint32_t longest_common_period = std::numeric_limits<std::int32_t>::max();

struct Graph {
  std::string name{};                                    ///< of the top block, as written
  std::shared_ptr<const language::SourceFile> source{};  ///< the text; spans point into it, fields name parts of it
  std::int64_t sample_time_ns = 0;                       ///< 0: not stated
  language::Span sample_time_span{};                     ///< where @ts states it; the block's name where nothing does
  std::vector<Port> inputs{};
  std::vector<Port> outputs{};
  std::vector<Parameter> parameters{};
  std::vector<Port> inner{};       ///< what else states a unit: variables, inner ports; without a name, a constant
  std::vector<NamedWire> named{};  ///< signals that are no outputs of a block; only where they are asked for
  std::vector<InitialState> initial_states{};
  std::vector<Node> nodes{};
  std::vector<Wire> wires{};
  std::vector<language::Span> wire_spans{};  ///< beside wires: where each was written
  std::vector<double> literals{};

  [[nodiscard]] const Wire& wire(const Node& node, std::size_t pin) const { return wires[node.first_wire + pin]; }
  [[nodiscard]] Place place(language::Span span) const { return source ? source->place(span) : Place{}; }
  [[nodiscard]] double sample_time() const { return static_cast<double>(sample_time_ns) * 1e-9; }
};

/// The number of outputs of a node.
inline std::size_t output_count(const Node& node) {
  return node.block != nullptr ? node.block->outputs.size() : 1;
}

/// The type of a node's output.
inline Type output_type(const Node& node, std::size_t port) {
  return node.block != nullptr ? node.block->outputs[port].type : info(node.op).result;
}

/// The port of a name, without regard to case; null where there is none.
const Port* find_port(const std::vector<Port>& ports, std::string_view name);

/// The parameter of a path, without regard to case; its index, or -1.
std::int64_t find_parameter(const Graph& graph, std::string_view path);

}  // namespace hysteron
