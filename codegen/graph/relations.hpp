// What the parameters of one block have to keep among themselves, beyond the range of each: the points of a table rise,
// a lower bound is not above the upper one, a dead time fits into the samples that its block holds.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "codegen/graph/graph.hpp"

namespace hysteron {

/// Parameters that cannot work together.
struct Contradiction {
  std::size_t param = 0;  ///< of the block: the one to be shown
  std::string cause{};
  std::string mend{};
};

/// The parameters of an instance against each other. `values` stands beside the block's: the numbers of each, as many
/// as were given; none for one that is not known, or is a signal. `period` is the instance's, in s; 0 where it is not
/// known.
[[nodiscard]] std::vector<Contradiction> contradictions(const BlockType& block, std::string_view instance,
                                                        std::span<const std::span<const double>> values, double period);

/// The numbers of an instance's parameters, for contradictions(): from constants of the text, and from those parameters
/// of the graph that `given` has numbers for.
template <class Given>
std::vector<std::span<const double>> numbers_of_params(const Graph& graph, const Node& node, Given given) {
  std::vector<std::span<const double>> values(node.block->params.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Wire& wire = graph.wire(node, node.block->inputs.size() + i);
    if (wire.from == Wire::From::Literal) {
      values[i] = {&graph.literals[wire.index], 1};
    } else if (wire.from == Wire::From::Parameter) {
      values[i] = given(wire.index);
    }
  }
  return values;
}

/// The same rules for who changes parameters of a running program and has no graph: numbers that must rise from one to
/// the next.
struct RisingNumbers {
  struct Number {
    std::optional<std::size_t> parameter{};  ///< of the graph; else it is constant
    std::size_t element = 0;                 ///< of the parameter
    double constant = 0.0;
  };
  std::vector<Number> numbers{};
  bool strictly = false;          ///< each above the one before; else at least at it
  std::optional<Number> count{};  ///< so many of them count; else all
};
/// Those of all instances in which a parameter of the graph takes part.
[[nodiscard]] std::vector<RisingNumbers> rising_numbers(const Graph& graph);

/// The period of a node in s; 0 where the graph states none.
[[nodiscard]] inline double period_of(const Graph& graph, const Node& node) {
  return static_cast<double>(graph.sample_time_ns) * 1e-9 * node.rate.every;
}

}  // namespace hysteron
