#include "codegen/backends/reference/svg_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace hysteron {
namespace {

constexpr std::string_view axis_colour = "#444444";
constexpr std::string_view grid_colour = "#dddddd";

using Range = std::pair<double, double>;

Range range_of(const std::vector<PlottedLine>& lines, std::vector<double> Polyline::*coordinate) {
  Range range{HUGE_VAL, -HUGE_VAL};
  for (const PlottedLine& one : lines) {
    for (const double value : one.line.*coordinate) {
      range.first = std::min(range.first, value);
      range.second = std::max(range.second, value);
    }
  }
  if (!(range.first < range.second)) {
    const double room = range.first == 0.0 ? 1.0 : 0.5 * std::abs(range.first);
    return {range.first - room, range.first + room};
  }
  const double room = 0.05 * (range.second - range.first);
  return {range.first - room, range.second + room};
}

/// Round numbers within a range, by steps of 1, 2 or 5 times a power of ten.
std::vector<double> round_numbers(Range range, int most) {
  const double rough = (range.second - range.first) / most;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  const double digit = rough / power;
  const double step = power * (digit <= 1.0 ? 1.0 : (digit <= 2.0 ? 2.0 : (digit <= 5.0 ? 5.0 : 10.0)));
  std::vector<double> numbers;
  for (double k = std::ceil(range.first / step - 1e-9); k * step <= range.second + 1e-9 * step; k += 1.0) {
    numbers.push_back(k * step + 0.0);  // no -0
  }
  return numbers;
}

/// From the data of a panel to pixels.
struct Scale {
  Range data;
  double begin;
  double end;

  [[nodiscard]] double operator()(double value) const {
    return begin + (value - data.first) / (data.second - data.first) * (end - begin);
  }
};

std::string line_text(double x1, double y1, double x2, double y2, std::string_view colour) {
  return fmt::format("<path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\" stroke=\"{}\" stroke-width=\"0.8\"/>\n", x1, y1, x2, y2,
                     colour);
}

std::string label_text(double x, double y, std::string_view anchor, std::string_view text) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", x, y, anchor, text);
}

}  // namespace

void Polyline::add(double px, double py) {
  const std::size_t count = x.size();
  if (count >= 2) {
    const double ax = x[count - 1] - x[count - 2];
    const double ay = y[count - 1] - y[count - 2];
    const double bx = px - x[count - 1];
    const double by = py - y[count - 1];
    const bool straight = std::abs(ax * by - ay * bx) <= 1e-9 * std::hypot(ax, ay) * std::hypot(bx, by);
    if (straight && ax * bx + ay * by >= 0.0) {
      x.back() = px;
      y.back() = py;
      return;
    }
  }
  x.push_back(px);
  y.push_back(py);
}

Range Panel::x_range() const {
  return fixed_x.first < fixed_x.second ? fixed_x : range_of(lines, &Polyline::x);
}

Range Panel::y_range() const {
  return fixed_y.first < fixed_y.second ? fixed_y : range_of(lines, &Polyline::y);
}

SvgPlot::SvgPlot(int width, int height)
    : head_(
          fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" "
                      "font-family=\"DejaVu Sans, Verdana, sans-serif\" font-size=\"11\">\n"
                      "<rect width=\"{0}\" height=\"{1}\" fill=\"#ffffff\"/>\n",
                      width, height)) {}

void SvgPlot::draw(const Panel& panel) {
  draw_axes(panel);
  const Scale x{panel.x_range(), panel.left, panel.right};
  const Scale y{panel.y_range(), panel.bottom, panel.top};
  for (const PlottedLine& one : panel.lines) {
    std::string points;
    for (std::size_t i = 0; i < one.line.x.size(); ++i) {
      points += fmt::format("{}{:.1f} {:.1f}", i == 0 ? "M" : "L", x(one.line.x[i]), y(one.line.y[i]));
    }
    body_ +=
        fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" stroke-linejoin=\"round\"{}/>\n",
                    points, one.style.colour, one.style.width, one.style.dashed ? " stroke-dasharray=\"5 3\"" : "");
  }
  if (panel.legend) {
    draw_legend(panel);
  }
}

void SvgPlot::draw_axes(const Panel& panel) {
  const Scale x{panel.x_range(), panel.left, panel.right};
  const Scale y{panel.y_range(), panel.bottom, panel.top};
  for (const double number : round_numbers(x.data, 7)) {
    body_ += line_text(x(number), panel.top, x(number), panel.bottom, grid_colour);
    if (panel.x_numbers) {
      body_ += label_text(x(number), panel.bottom + 16, "middle", fmt::format("{:.6g}", number));
    }
  }
  if (panel.y_names.empty()) {
    for (const double number : round_numbers(y.data, 6)) {
      body_ += line_text(panel.left, y(number), panel.right, y(number), grid_colour);
      body_ += label_text(panel.left - 6, y(number) + 4, "end", fmt::format("{:.6g}", number));
    }
  }
  for (const auto& [name, at] : panel.y_names) {
    body_ += label_text(panel.left - 6, y(at) + 4, "end", name);
  }
  body_ +=
      fmt::format("<path d=\"M{0:.1f} {1:.1f}V{2:.1f}H{3:.1f}\" fill=\"none\" stroke=\"{4}\" stroke-width=\"1\"/>\n",
                  panel.left, panel.top, panel.bottom, panel.right, axis_colour);
  if (!panel.x_label.empty()) {
    body_ += label_text(0.5 * (panel.left + panel.right), panel.bottom + 33, "middle", panel.x_label);
  }
}

void SvgPlot::draw_legend(const Panel& panel) {
  double at = panel.top + 8;
  for (const PlottedLine& one : panel.lines) {
    body_ += fmt::format("<path d=\"M{:.1f} {:.1f}h18\" stroke=\"{}\" stroke-width=\"{}\"{}/>\n", panel.right + 8, at,
                         one.style.colour, one.style.width, one.style.dashed ? " stroke-dasharray=\"5 3\"" : "");
    body_ += label_text(panel.right + 30, at + 4, "start", one.name);
    at += 16;
  }
}

std::string SvgPlot::text() const {
  return head_ + body_ + "</svg>\n";
}

}  // namespace hysteron
