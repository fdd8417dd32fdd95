// Texts in the language of Graphviz: names in quotes, labels in its HTML.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace hysteron::dot {

inline constexpr std::string_view faint = "#5a5a5a";  ///< the colour of what is beside the point

/// How a picture begins: its name, its title as a label, and what all boxes and wires have in common.
std::string opening(std::string_view name, std::string_view title);

/// 50 µs, 1 ms.
std::string duration_of(std::int64_t nanoseconds);

/// A name, in quotes.
std::string quoted(std::string_view text);

/// For a label.
std::string escaped(std::string_view text);

/// For a label, small and faint.
std::string small_text(std::string_view text);

/// Broken at spaces into lines that a box can hold; what does not fit into the last one is cut.
std::vector<std::string> lines_of(std::string_view text);

/// The items of a list with commas, none of them broken.
std::vector<std::string> lines_of(const std::vector<std::string>& items);

/// A text broken into lines, as a label.
std::string broken(std::string_view text);

}  // namespace hysteron::dot
