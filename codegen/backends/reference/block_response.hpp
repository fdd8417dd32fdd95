// The response of a block to a standard stimulus: a small diagram around the block, and what it does when it is run.
//
// It is the example and the picture on the block's page. The stimulus is chosen by the block's pins, so that a new
// block has a picture at once; where that would show little, a line in block_stimuli.cpp chooses a better one.
#pragma once

#include <string>
#include <vector>

#include "codegen/trace/block_type.hpp"

namespace hysteron {

/// One signal of a response, by step.
struct ResponseTrace {
  std::string name{};
  Type type = Type::Real;
  bool is_input = false;
  std::vector<double> values{};
};

struct BlockResponse {
  double sample_time = 0.0;  ///< in seconds
  std::vector<ResponseTrace> traces{};
  /// The trace to be drawn along the x axis; empty: everything is drawn over time.
  std::string abscissa{};
};

/// A diagram with one instance of the block and its stimulus as inputs, in the house's layout. It compiles.
[[nodiscard]] std::string response_diagram(const BlockType& block);

/// That diagram, run by the interpreter.
[[nodiscard]] BlockResponse block_response(const BlockType& block);

}  // namespace hysteron
