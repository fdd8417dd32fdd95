// Where the boxes of a network stand: Graphviz finds the places.
#pragma once

#include <string>
#include <vector>

#include "codegen/backends/plcopen/network.hpp"

namespace hysteron::plcopen {

struct Size {
  int width = 0;
  int height = 0;
};

/// Of a box, in pixels.
[[nodiscard]] Size size_of(const Element& element);

/// The height of an input's or output's pin below the top of its box, by its place.
[[nodiscard]] int pin_height(const Element& element, std::size_t place);

/// A text for `dot -Tplain`, with a graph for each network.
[[nodiscard]] std::string placing_dot(const std::vector<Network>& networks);

/// Gives every element its place from what `dot -Tplain` answered. Throws InputError HY741 where an element has none.
void take_places(const std::string& plain, std::vector<Network>& networks);

}  // namespace hysteron::plcopen
