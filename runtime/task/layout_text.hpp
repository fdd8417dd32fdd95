// How a program's layout names its diagram and its engine.
#pragma once

#include <string>
#include <string_view>

namespace hysteron::runtime {

/// 9f3c…-compiled-float32: the hash of a diagram, by whom it is stepped, and in which numbers.
[[nodiscard]] std::string layout_text(std::string_view diagram, bool is_compiled, bool is_float32);

/// A layout without its engine: engines of one diagram have the same values, which lie in other bytes.
[[nodiscard]] std::string diagram_of(std::string layout);

}  // namespace hysteron::runtime
