#include "plots/figure_svg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <unordered_set>

#include "plots/svg_plot.hpp"
#include "plots/thinned.hpp"
#include "support/numbers.hpp"
#include "support/utf8.hpp"

namespace hysteron::plots {
namespace {

constexpr int width = 900;
constexpr double left = 84.0;
constexpr double right = 880.0;
constexpr double first_top = 54.0;
constexpr double gap = 34.0;       ///< between panels over a common axis
constexpr double wide_gap = 72.0;  ///< where each panel has numbers of its own
constexpr double below = 46.0;
/// More rows than these are thinned before a curve in a plane is drawn; a loop keeps its shape.
constexpr std::size_t most_rows_of_loop = 200000;

/// Okabe and Ito's, which differ for the colour-blind as well; black for what was measured.
constexpr std::array<std::string_view, 8> palette{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                  "#e69f00", "#56b4e9", "#8c6d31", "#1b1f24"};

double height_of_panel(const Figure& figure) {
  return !figure.over_time ? 480.0 : figure.panels.size() == 1 ? 340.0 : figure.panels.size() < 4 ? 190.0 : 130.0;
}

/// A curve over time, with two points where it steps.
Polyline over_time(const Curve& curve) {
  Polyline line;
  const auto rows = thinned(curve.x, curve.y, static_cast<std::size_t>(right - left));
  bool has_held = false;
  double held = 0.0;
  for (const std::size_t k : rows) {
    if (curve.stroke == Stroke::Steps && has_held && std::isfinite(curve.y[k])) {
      line.add(curve.x[k], held);
    }
    line.add(curve.x[k], curve.y[k]);
    held = curve.y[k];
    has_held = std::isfinite(held);
  }
  return line;
}

/// A curve in a plane: each piece once, as fine as half a pixel.
Polyline in_plane(const Curve& curve, const Panel& panel) {
  const Reach x = panel.x_range();
  const Reach y = panel.y_range();
  const auto cell = [](double value, const Reach& reach, double pixels) {
    return static_cast<std::uint64_t>(
        std::lround(2.0 * pixels * std::clamp((value - reach.low) / (reach.high - reach.low), 0.0, 1.0)));
  };
  Polyline line;
  std::unordered_set<std::uint64_t> drawn;
  std::uint64_t last = 0;
  bool pen_down = false;
  std::size_t last_row = 0;
  for (const std::size_t k : thinned(curve.x, curve.y, most_rows_of_loop)) {
    if (!std::isfinite(curve.x[k]) || !std::isfinite(curve.y[k])) {
      line.add(not_a_number, not_a_number);
      pen_down = false;
      continue;
    }
    const std::uint64_t here =
        (cell(curve.x[k], x, panel.right - panel.left) << 16U) | cell(curve.y[k], y, panel.bottom - panel.top);
    const std::uint64_t from = pen_down ? last : here;
    const bool is_new =
        (!pen_down || here != last) && drawn.insert((std::min(from, here) << 32U) | std::max(from, here)).second;
    if (is_new) {
      if (pen_down && (line.x.empty() || line.x.back() != curve.x[last_row] || line.y.back() != curve.y[last_row])) {
        line.add(not_a_number, not_a_number);
        line.add(curve.x[last_row], curve.y[last_row]);
      }
      line.add(curve.x[k], curve.y[k]);
    }
    last = here;
    last_row = k;
    pen_down = true;
  }
  return line;
}

}  // namespace

std::string axis_label(const std::string& name, const std::string& unit) {
  return unit.empty() || unit == "1" ? name : name + " [" + unit + "]";
}

namespace {

double height_of(const Figure& figure) {
  const auto count = static_cast<double>(figure.panels.size());
  return first_top + count * height_of_panel(figure) +
         std::max(0.0, count - 1.0) * (figure.over_time ? gap : wide_gap) + below;
}

std::string figure_svg(const Figure& figure) {
  constexpr std::size_t longest_title = 60;
  constexpr std::size_t longest_name = 24;
  const double panel_height = height_of_panel(figure);
  const bool shared = figure.over_time;
  const double distance = shared ? gap : wide_gap;
  SvgPlot plot(width, static_cast<int>(height_of(figure)));
  plot.head(left, 20.0, clipped(figure.title, 2 * longest_title));
  Reach common;
  for (const FigurePanel& one : figure.panels) {
    for (const Curve& curve : one.curves) {
      common.take(curve.x);
    }
  }
  double top = first_top;
  for (const FigurePanel& one : figure.panels) {
    const bool is_last = &one == &figure.panels.back();
    Panel panel{.left = left, .top = top, .right = right, .bottom = top + panel_height};
    panel.title = clipped(one.title, longest_title);
    panel.x_label = shared && !is_last ? std::string() : clipped(one.x_label, longest_title);
    panel.y_label = clipped(one.y_label, static_cast<std::size_t>(panel_height / 6.0));
    panel.x_numbers = !shared || is_last;
    panel.legend = one.curves.size() > 1 ? Legend::Above : Legend::None;
    panel.x_names = one.x_names;
    for (const Stretch& stretch : figure.stretches) {
      panel.shades.push_back({.begin = stretch.begin, .end = stretch.end, .name = stretch.name});
    }
    if (shared) {
      panel.fixed_x = common.with_room(one.x_names.empty() ? 0.0 : 0.05);
    }
    for (const Curve& curve : one.curves) {
      panel.lines.push_back({.name = clipped(curve.name, longest_name),
                             .line = {.x = curve.x, .y = curve.y},
                             .style = {.colour = palette[curve.colour % palette.size()],
                                       .width = 1.4,
                                       .dots = curve.stroke == Stroke::Dots},
                             .errors = curve.errors});
    }
    if (!shared) {
      panel.fixed_x = panel.x_range();
    }
    panel.fixed_y = panel.y_range();
    for (std::size_t i = 0; i < one.curves.size(); ++i) {
      if (one.curves[i].stroke != Stroke::Dots) {
        panel.lines[i].line = shared ? over_time(one.curves[i]) : in_plane(one.curves[i], panel);
      }
    }
    plot.draw(panel);
    top += panel_height + distance;
  }
  return plot.text();
}

}  // namespace

std::string figures_svg(std::span<const Figure> figures) {
  if (figures.size() == 1) {
    return figure_svg(figures.front());
  }
  std::string inside;
  double top = 0.0;
  for (const Figure& figure : figures) {
    constexpr std::string_view open = "<svg ";
    inside += fmt::format("<svg y=\"{}\" {}", top, figure_svg(figure).substr(open.size()));
    top += height_of(figure) + 20.0;
  }
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1:.0f}\" viewBox=\"0 0 {0} {1:.0f}\">\n<rect "
      "width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n{2}</svg>\n",
      width, top, inside);
}

}  // namespace hysteron::plots
