// Places for boxes and the curves between them, signals running from left to right (Sugiyama, Tagawa and Toda 1981):
// cycles cut, boxes in columns, order in the columns by barycentres, heights by least squares without overlaps.
//
// What runs back to the left goes below the boxes, as feedback is drawn by hand. Curves that leave the same port share
// their way as long as they run in parallel. Made for some 30 boxes; the work grows with the square of the edges.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace hysteron::diagnosis::report {

enum class Side : std::uint8_t { Any, Left, Right };

struct LayoutBox {
  double width = 0.0;
  double height = 0.0;
  Side side = Side::Any;  ///< inputs stand at the left, outputs at the right
};

/// From the right side of a box to the left side of another one, at heights below their tops.
struct LayoutEdge {
  std::size_t from = 0;
  double from_height = 0.0;
  std::size_t to = 0;
  double to_height = 0.0;
};

struct Point {
  double x = 0.0;
  double y = 0.0;
};

struct Layout {
  double width = 0.0;
  double height = 0.0;
  std::vector<Point> boxes{};                ///< upper left corners
  std::vector<std::vector<Point>> curves{};  ///< by edge: a point, then three for each cubic Bézier curve
};

[[nodiscard]] Layout layered_layout(const std::vector<LayoutBox>& boxes, const std::vector<LayoutEdge>& edges);

}  // namespace hysteron::diagnosis::report
