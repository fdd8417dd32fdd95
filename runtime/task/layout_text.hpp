// How a program's layout names its diagram and its engine.
#pragma once

#include <string>
#include <string_view>

namespace hysteron::runtime {

/// 9f3c…-compiled-float32: the hash of a diagram, by whom it is stepped, and in which numbers.
[[nodiscard]] std::string layout_text(std::string_view diagram, bool is_compiled, bool is_float32);

/// A layout without its engine: engines of one diagram have the same values, which lie in other bytes.
[[nodiscard]] std::string diagram_of(std::string layout);

/// What a layout says of how its program is stepped.
struct LayoutEngine {
  bool is_interpreted = false;
  bool is_float32 = false;

  bool operator==(const LayoutEngine&) const = default;
};
[[nodiscard]] LayoutEngine engine_in(std::string_view layout);

}  // namespace hysteron::runtime
