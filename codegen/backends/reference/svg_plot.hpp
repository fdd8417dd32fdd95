// Small plots as SVG: panels with axes, lines and a legend. The bytes depend on the data alone.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace hysteron {

/// Points of a line, without those in the middle of a straight part: pictures stay small.
struct Polyline {
  std::vector<double> x{};
  std::vector<double> y{};

  void add(double px, double py);
};

struct LineStyle {
  std::string_view colour = "#000000";
  double width = 1.5;
  bool dashed = false;
};

struct PlottedLine {
  std::string name{};
  Polyline line{};
  LineStyle style{};
};

/// A pair of axes. Places are in pixels from the upper left corner of the picture.
struct Panel {
  double left = 0.0;
  double top = 0.0;
  double right = 0.0;
  double bottom = 0.0;
  std::string x_label{};
  bool x_numbers = true;
  bool legend = true;
  std::vector<std::pair<std::string, double>> y_names{};  ///< instead of numbers along the y axis
  std::vector<PlottedLine> lines{};

  std::pair<double, double> fixed_x{};  ///< empty: the range of the lines with some room about it
  std::pair<double, double> fixed_y{};

  [[nodiscard]] std::pair<double, double> x_range() const;
  [[nodiscard]] std::pair<double, double> y_range() const;
};

class SvgPlot {
 public:
  SvgPlot(int width, int height);

  void draw(const Panel& panel);
  [[nodiscard]] std::string text() const;

 private:
  void draw_axes(const Panel& panel);
  void draw_legend(const Panel& panel);

  std::string head_;
  std::string body_;
};

}  // namespace hysteron
