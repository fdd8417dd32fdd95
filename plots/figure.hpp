// A figure: panels of curves, as data. It becomes an SVG (figure_svg.hpp) or a part of a page with zoom (page.hpp).
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace hysteron::plots {

enum class Stroke {
  Line,
  Steps,  ///< each value holds until the next
  Dots    ///< points that no line joins
};

struct Curve {
  std::string name{};  ///< in the legend
  std::vector<double> x{};
  std::vector<double> y{};
  Stroke stroke = Stroke::Line;
  std::size_t colour = 0;        ///< number of a colour of the palette; the same in all panels for the same thing
  std::vector<double> errors{};  ///< half the length of a bar at each point; empty: none
};

/// A name for each part of the x axis, such as those of the train and test intervals.
struct Stretch {
  double begin = 0.0;
  double end = 0.0;
  std::string name{};
};

struct FigurePanel {
  std::string title{};
  std::string x_label{};
  std::string y_label{};
  std::vector<Curve> curves{};
  std::vector<std::pair<std::string, double>> x_names{};  ///< instead of numbers along the x axis
};

struct Figure {
  std::string title{};
  std::vector<FigurePanel> panels{};
  bool over_time = true;  ///< x rises in every curve, and all panels share it; else each is a curve in a plane
  std::vector<Stretch> stretches{};  ///< shaded behind the curves
};

/// "Y [um]"; the name alone where there is no unit, or none but 1.
[[nodiscard]] std::string axis_label(const std::string& name, const std::string& unit);

}  // namespace hysteron::plots
