// The signals within a diagram that can be looked at while it runs: what its blocks and expressions give.
#pragma once

#include <string>
#include <vector>

#include "codegen/compile.hpp"

namespace hysteron::tool {

struct InnerSignal {
  std::string name{};  ///< HYST.XOUT; of an expression, the pin or output that it feeds: INV.R1
  std::string unit{};  ///< empty where the diagram does not say
  Type type = Type::Real;
  Wire wire{};
};

/// In the order of the graph, each once. Signals of slower parts are left out: they are no value of every step.
[[nodiscard]] std::vector<InnerSignal> inner_signals(const Program& program);

}  // namespace hysteron::tool
