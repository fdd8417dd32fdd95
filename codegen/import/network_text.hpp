// From the elements of a network to the statements of a diagram.
//
// The elements run in the order that an editor gives them: by their order of execution, then by their place, and what
// feeds an element runs before it. A value that is read before it is worked out is the last cycle's: it becomes a
// HY_DELAY.
#pragma once

#include <string>
#include <vector>

#include "codegen/import/drawing.hpp"
#include "codegen/import/network_check.hpp"
#include "support/diagnostic.hpp"

namespace hysteron::import {

struct NetworkText {
  std::string locals{};  ///< declarations of what the network has beside the POU's own variables
  std::string statements{};
  std::vector<std::string> called{};    ///< instances, in capitals
  std::vector<std::string> assigned{};  ///< variables, in capitals; of one that is input and output the output's name
  std::vector<std::string> taken_in{};  ///< of those that are input and output: what is read before it is assigned
};

/// Throws InputError HY744 with every element that no diagram can express.
NetworkText text_of_network(const std::string& file, const DrawnPou& pou, const OwnBlocks& own, const Targets& targets);

}  // namespace hysteron::import
