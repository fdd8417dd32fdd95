// Which points of a curve are drawn, where more of them would lie in one pixel than a reader can see.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace hysteron::plots {

/// Rows to be drawn, rising. Of each of at most `groups` groups of neighbouring rows these are the first, the last,
/// those with the least and the largest x and y, and one that is not finite where there is one: no extreme and no gap
/// is lost. With a group a pixel, the picture is that of all rows (Jugel et al., M4: A Visualization-Oriented Time
/// Series Data Aggregation, VLDB 2014). All rows where they are no more than six a group.
[[nodiscard]] std::vector<std::size_t> thinned(std::span<const double> x, std::span<const double> y,
                                               std::size_t groups);

/// Whether a signal is one of steps, such as a truth value or a command: it holds whole numbers alone, and changes in
/// one sample of eight or fewer.
[[nodiscard]] bool is_of_steps(std::span<const double> values);

/// Whether it changes, and does so in fewer than one sample of eight.
[[nodiscard]] bool changes_seldom(std::span<const double> values);

}  // namespace hysteron::plots
