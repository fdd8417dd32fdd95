// Where a wire is seen from outside. A block that is used twice has one text, so that a change in it changes both
// instances; what is meant for one of them is written where that one is called.
#pragma once

#include <cstdint>
#include <vector>

#include "codegen/graph/schedule.hpp"

namespace hysteron {

/// The outermost place at which a wire is written, and in how many blocks that place lies.
struct OuterPlace {
  std::uint32_t level = 0;
  language::Span span{};
};
/// Beside Graph::wires.
using OuterPlaces = std::vector<OuterPlace>;

/// schedule(), which shows a loop by its outermost wires.
Schedule schedule(const Graph& graph, const OuterPlaces& places, Diagnostics& diagnostics);

}  // namespace hysteron
