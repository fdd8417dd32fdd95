// A line plot as SVG text, for pages that need nothing beside themselves.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace hysteron::tool {

/// Of a plot, in the unit of the picture.
inline constexpr double line_plot_width = 860.0;
inline constexpr double line_plot_height = 300.0;

struct Line {
  std::string name{};
  std::string colour{};  ///< as CSS writes it
  std::span<const double> x{};
  std::span<const double> y{};
};

struct PlotLabels {
  std::string title{};
  std::string x{};
  std::string y{};
};

/// Points that are not finite break the line. Of very many points, those that show at the width of the plot are kept:
/// the least and the largest y among neighbours.
[[nodiscard]] std::string line_plot(const PlotLabels& labels, std::span<const Line> lines);

}  // namespace hysteron::tool
