#include "plots/svg_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "support/markup.hpp"
#include "support/utf8.hpp"

namespace hysteron::plots {
namespace {

constexpr std::string_view axis_colour = "#444444";
constexpr std::string_view grid_colour = "#dddddd";

Reach range_of(const std::vector<PlottedLine>& lines, std::vector<double> Polyline::*coordinate) {
  Reach range;
  for (const PlottedLine& one : lines) {
    range.take(one.line.*coordinate);
    for (std::size_t i = 0; coordinate == &Polyline::y && i < one.errors.size(); ++i) {
      range.take(one.line.y[i] - one.errors[i]);
      range.take(one.line.y[i] + one.errors[i]);
    }
  }
  return range.with_room(0.05);
}

/// From the data of a panel to pixels.
struct Scale {
  Reach data{};
  double begin = 0.0;
  double end = 0.0;

  [[nodiscard]] double operator()(double value) const {
    return begin + (value - data.low) / (data.high - data.low) * (end - begin);
  }
};

std::string line_text(double x1, double y1, double x2, double y2, std::string_view colour) {
  return fmt::format("<path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\" stroke=\"{}\" stroke-width=\"0.8\"/>\n", x1, y1, x2, y2,
                     colour);
}

std::string label_text(double x, double y, std::string_view anchor, std::string_view text) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", x, y, anchor,
                     escaped(printable(text)));
}

double step_of(const std::vector<double>& numbers) {
  return numbers.size() > 1 ? numbers[1] - numbers[0] : 0.0;
}

/// The line through points, with a gap where one is not finite and a dot where one stands alone.
std::string path_of(const Polyline& line, const Scale& x, const Scale& y) {
  std::string path;
  std::size_t drawn = 0;  // since the pen came down
  const auto lift = [&] {
    path += drawn == 1 ? "h0" : "";
    drawn = 0;
  };
  for (std::size_t i = 0; i < line.x.size(); ++i) {
    if (!std::isfinite(line.x[i]) || !std::isfinite(line.y[i])) {
      lift();
      continue;
    }
    path += fmt::format("{}{:.1f} {:.1f}", drawn == 0 ? "M" : "L", x(line.x[i]), y(line.y[i]));
    ++drawn;
  }
  lift();
  return path;
}

std::string dots_of(const PlottedLine& one, const Scale& x, const Scale& y) {
  std::string text;
  for (std::size_t i = 0; i < one.line.x.size(); ++i) {
    const double px = one.line.x[i];
    const double py = one.line.y[i];
    if (!std::isfinite(px) || !std::isfinite(py)) {
      continue;
    }
    if (i < one.errors.size() && std::isfinite(one.errors[i])) {
      text += fmt::format("<path d=\"M{0:.1f} {1:.1f}V{2:.1f}m-4 0h8M{3:.1f} {1:.1f}h8\" stroke=\"{4}\"/>\n", x(px),
                          y(py - one.errors[i]), y(py + one.errors[i]), x(px) - 4.0, one.style.colour);
    }
    text += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\" fill=\"{}\"/>\n", x(px), y(py), one.style.colour);
  }
  return text;
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

Reach Panel::x_range() const {
  return fixed_x.low < fixed_x.high ? fixed_x : range_of(lines, &Polyline::x);
}

Reach Panel::y_range() const {
  return fixed_y.low < fixed_y.high ? fixed_y : range_of(lines, &Polyline::y);
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
    if (one.style.dots) {
      body_ += dots_of(one, x, y);
      continue;
    }
    const std::string path = path_of(one.line, x, y);
    body_ +=
        fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" stroke-linejoin=\"round\"{}{}/>\n",
                    path, one.style.colour, one.style.width, one.style.dashed ? " stroke-dasharray=\"5 3\"" : "",
                    path.find("h0") == std::string::npos ? "" : " stroke-linecap=\"round\"");
  }
  if (panel.legend == Legend::Beside) {
    draw_legend(panel);
  } else if (panel.legend == Legend::Above) {
    draw_legend_above(panel);
  }
}

void SvgPlot::draw_axes(const Panel& panel) {
  const Scale x{panel.x_range(), panel.left, panel.right};
  const Scale y{panel.y_range(), panel.bottom, panel.top};
  for (const Shade& shade : panel.shades) {
    const double begin = std::clamp(x(shade.begin), panel.left, panel.right);
    const double end = std::clamp(x(shade.end), panel.left, panel.right);
    body_ += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"#eef3f8\"/>\n",
                         begin, panel.top, end - begin, panel.bottom - panel.top);
    body_ += label_text(begin + 4, panel.top + 12, "start", shade.name);
  }
  const auto along = round_numbers(x.data, panel.right - panel.left < 450 ? 7 : 10);
  for (const double number : panel.x_names.empty() ? along : std::vector<double>()) {
    body_ += line_text(x(number), panel.top, x(number), panel.bottom, grid_colour);
    if (panel.x_numbers) {
      body_ += label_text(x(number), panel.bottom + 16, "middle", tick_text(number, step_of(along)));
    }
  }
  for (const auto& [name, at] : panel.x_names) {
    body_ += line_text(x(at), panel.top, x(at), panel.bottom, grid_colour);
    body_ += panel.x_numbers ? label_text(x(at), panel.bottom + 16, "middle", name) : std::string();
  }
  if (panel.y_names.empty()) {
    const auto up = round_numbers(y.data, panel.bottom - panel.top < 150 ? 4 : 6);
    for (const double number : up) {
      body_ += line_text(panel.left, y(number), panel.right, y(number), grid_colour);
      body_ += label_text(panel.left - 6, y(number) + 4, "end", tick_text(number, step_of(up)));
    }
  }
  for (const auto& [name, at] : panel.y_names) {
    body_ += label_text(panel.left - 6, y(at) + 4, "end", name);
  }
  body_ +=
      fmt::format("<path d=\"M{0:.1f} {1:.1f}V{2:.1f}H{3:.1f}\" fill=\"none\" stroke=\"{4}\" stroke-width=\"1\"/>\n",
                  panel.left, panel.top, panel.bottom, panel.right, axis_colour);
  draw_labels(panel);
}

void SvgPlot::draw_labels(const Panel& panel) {
  if (!panel.x_label.empty()) {
    body_ += label_text(0.5 * (panel.left + panel.right), panel.bottom + 33, "middle", panel.x_label);
  }
  if (!panel.y_label.empty()) {
    body_ += fmt::format("<text transform=\"translate({:.1f} {:.1f}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n",
                         panel.left - 62, 0.5 * (panel.top + panel.bottom), escaped(printable(panel.y_label)));
  }
  if (!panel.title.empty()) {
    head(panel.left, panel.top - 8, panel.title);
  }
}

void SvgPlot::head(double x, double y, std::string_view text) {
  body_ +=
      fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" font-weight=\"bold\">{}</text>\n", x, y, escaped(printable(text)));
}

/// From the right end of the panel to the left, as wide as the names are.
void SvgPlot::draw_legend_above(const Panel& panel) {
  constexpr double width_of_letter = 6.6;
  double at = panel.right;
  for (auto one = panel.lines.rbegin(); one != panel.lines.rend(); ++one) {
    at -= width_of_letter * static_cast<double>(character_count(one->name));
    body_ += label_text(at, panel.top - 8, "start", one->name);
    body_ += fmt::format("<path d=\"M{:.1f} {:.1f}h18\" stroke=\"{}\" stroke-width=\"2\"/>\n", at - 23, panel.top - 12,
                         one->style.colour);
    at -= 38;
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

}  // namespace hysteron::plots
