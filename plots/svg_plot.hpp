// Plots as SVG: panels with axes, lines and a legend. The bytes depend on the data alone.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "plots/axis.hpp"

namespace hysteron::plots {

/// Points of a line, without those in the middle of a straight part: pictures stay small. A point that is not finite
/// is a gap.
struct Polyline {
  std::vector<double> x{};
  std::vector<double> y{};

  void add(double px, double py);
};

struct LineStyle {
  std::string_view colour = "#000000";
  double width = 1.5;
  bool dashed = false;
  bool dots = false;  ///< a dot at each point, and no line
};

struct PlottedLine {
  std::string name{};
  Polyline line{};
  LineStyle style{};
  std::vector<double> errors{};  ///< half the length of a bar at each point; empty: none
};

/// A part of the x axis that is shaded, with its name at the top.
struct Shade {
  double begin = 0.0;
  double end = 0.0;
  std::string name{};
};

enum class Legend { None, Beside, Above };

/// A pair of axes. Places are in pixels from the upper left corner of the picture.
struct Panel {
  double left = 0.0;
  double top = 0.0;
  double right = 0.0;
  double bottom = 0.0;
  std::string title{};  ///< above the panel
  std::string x_label{};
  std::string y_label{};
  bool x_numbers = true;
  Legend legend = Legend::Beside;
  std::vector<std::pair<std::string, double>> x_names{};  ///< instead of numbers along the x axis
  std::vector<std::pair<std::string, double>> y_names{};  ///< instead of numbers along the y axis
  std::vector<PlottedLine> lines{};
  std::vector<Shade> shades{};

  Reach fixed_x{};  ///< empty: the range of the lines with some room about it
  Reach fixed_y{};

  [[nodiscard]] Reach x_range() const;
  [[nodiscard]] Reach y_range() const;
};

class SvgPlot {
 public:
  SvgPlot(int width, int height);

  void draw(const Panel& panel);
  /// A line of text, bold.
  void head(double x, double y, std::string_view text);
  [[nodiscard]] std::string text() const;

 private:
  void draw_axes(const Panel& panel);
  void draw_labels(const Panel& panel);
  void draw_legend(const Panel& panel);
  void draw_legend_above(const Panel& panel);

  std::string head_;
  std::string body_;
};

}  // namespace hysteron::plots
