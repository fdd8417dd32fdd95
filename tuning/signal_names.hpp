// Signals inside a diagram, and its ports, by their names.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "codegen/graph/graph.hpp"
#include "codegen/parameters/parameter_file.hpp"
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

[[nodiscard]] std::vector<std::string> names_of(const std::vector<Port>& ports);

/// The place of an input or of an output, which `kind` says, among the ports of a graph. Reports HY603 where there is
/// none of that name.
[[nodiscard]] std::optional<std::size_t> find_port(const Graph& graph, const std::vector<Port>& ports,
                                                   std::string_view kind, const parameters::PlacedText& wanted,
                                                   Diagnostics& diagnostics);

}  // namespace hysteron
