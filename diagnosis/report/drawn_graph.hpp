// What of a graph is drawn: inputs, blocks, expressions as one box each, outputs, and the wires between them.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "codegen/graph/graph.hpp"

namespace hysteron::diagnosis::report {

struct DrawnBox {
  enum class Kind : std::uint8_t { Input, Block, Expression, Output, Effect };  ///< Effect: on a wire, without a block
  Kind kind = Kind::Block;
  std::string name{};                  ///< of the instance or port; the text of an expression
  std::string type{};                  ///< of a block, without HY_; the unit of a port
  std::string effect{};                ///< that the block stands for; empty for none
  std::string meaning{};               ///< in a sentence
  std::vector<std::string> pins{};     ///< that wires lead to
  std::vector<std::string> outputs{};  ///< that wires come from
};

struct DrawnWire {
  std::size_t from = 0;
  std::size_t output = 0;
  std::size_t to = 0;
  std::size_t pin = 0;
  std::vector<std::string> source_names{};  ///< in capitals: HYST.XOUT, U
  std::string sink_name{};                  ///< in capitals: HYST.XIN, Y
};

struct DrawnGraph {
  std::vector<DrawnBox> boxes{};
  std::vector<DrawnWire> wires{};
};

[[nodiscard]] DrawnGraph drawn_graph(const Graph& graph);

}  // namespace hysteron::diagnosis::report
