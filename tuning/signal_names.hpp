// Signals inside a diagram by their names.
#pragma once

#include <string>
#include <vector>

#include "codegen/graph/graph.hpp"
#include "support/diagnostic.hpp"

namespace hysteron {

struct NamedSignal {
  std::string name{};
  Wire wire{};
};

/// A variable, an output of an instance, as PID.XOUT, or either inside a nested block, as PLANT.HYST.XOUT, without
/// regard to case; of a vector, each of its elements. Variables are known only to a graph that was compiled with
/// keep_names. Throws InputError HY708 at `place` where there is none.
[[nodiscard]] std::vector<NamedSignal> find_signals(const Graph& graph, const std::string& path, const Place& place);

/// The same of one signal. Throws InputError HY708 for a vector, too.
[[nodiscard]] Wire find_signal(const Graph& graph, const std::string& path, const Place& place);

}  // namespace hysteron
