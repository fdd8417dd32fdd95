#include "tool/line_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "support/markup.hpp"

namespace hysteron::tool {
namespace {

constexpr double width = line_plot_width;
constexpr double height = line_plot_height;
constexpr double left = 70.0;
constexpr double right = 20.0;
constexpr double top = 34.0;
constexpr double bottom = 44.0;
constexpr std::size_t most_groups = 3000;  ///< of neighbouring points; two are drawn of each

struct Axis {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  double step = 1.0;

  void take(std::span<const double> values) {
    for (const double value : values) {
      if (std::isfinite(value)) {
        low = std::min(low, value);
        high = std::max(high, value);
      }
    }
  }
  /// Ticks at 1, 2 or 5 times a power of ten, some six of them.
  void settle() {
    if (!(low <= high)) {
      low = 0.0;
      high = 1.0;
    }
    if (!(high - low > 1e-12 * std::max(std::fabs(low), std::fabs(high)))) {
      const double margin = low == 0.0 ? 1.0 : 0.1 * std::fabs(low);
      low -= margin;
      high += margin;
    }
    const double rough = (high - low) / 6.0;
    const double decade = std::pow(10.0, std::floor(std::log10(rough)));
    const double digit = rough / decade;
    step = decade * (digit < 1.5 ? 1.0 : digit < 3.5 ? 2.0 : digit < 7.5 ? 5.0 : 10.0);
  }
  [[nodiscard]] double share(double value) const { return (value - low) / (high - low); }
};

double across(const Axis& axis, double x) {
  return left + axis.share(x) * (width - left - right);
}
double down(const Axis& axis, double y) {
  return height - bottom - axis.share(y) * (height - top - bottom);
}

std::string path_of(const Line& line, const Axis& x, const Axis& y) {
  const std::size_t count = std::min(line.x.size(), line.y.size());
  const std::size_t group = std::max<std::size_t>(1, count / most_groups);
  std::string path;
  bool pen_down = false;
  const auto draw = [&](std::size_t k) {
    if (!std::isfinite(line.x[k]) || !std::isfinite(line.y[k])) {
      pen_down = false;
      return;
    }
    path += fmt::format("{}{:.1f} {:.1f}", pen_down ? "L" : "M", across(x, line.x[k]), down(y, line.y[k]));
    pen_down = true;
  };
  for (std::size_t begin = 0; begin < count; begin += group) {
    const std::size_t end = std::min(begin + group, count);
    const auto values = line.y.subspan(begin, end - begin);
    const auto [least, largest] = std::minmax_element(values.begin(), values.end());
    const auto first = begin + static_cast<std::size_t>(std::min(least, largest) - values.begin());
    const auto second = begin + static_cast<std::size_t>(std::max(least, largest) - values.begin());
    draw(first);
    if (second != first) {
      draw(second);
    }
  }
  return path;
}

}  // namespace

std::string line_plot(const PlotLabels& labels, std::span<const Line> lines) {
  Axis x;
  Axis y;
  for (const Line& line : lines) {
    x.take(line.x);
    y.take(line.y);
  }
  x.settle();
  y.settle();
  std::string svg = fmt::format(
      "<svg viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" font-family=\"sans-serif\" font-size=\"12\">\n"
      "<text x=\"{2}\" y=\"16\" font-weight=\"bold\">{3}</text>\n",
      width, height, left, escaped(labels.title));
  for (double tick = std::ceil(x.low / x.step) * x.step; tick <= x.high + 1e-9 * x.step; tick += x.step) {
    svg += fmt::format(
        "<path d=\"M{0:.1f} {1}V{2}\" stroke=\"#ddd\"/><text x=\"{0:.1f}\" y=\"{3}\" "
        "text-anchor=\"middle\">{4:.6g}</text>\n",
        across(x, tick), top, height - bottom, height - bottom + 16.0, std::fabs(tick) < 1e-9 * x.step ? 0.0 : tick);
  }
  for (double tick = std::ceil(y.low / y.step) * y.step; tick <= y.high + 1e-9 * y.step; tick += y.step) {
    svg += fmt::format(
        "<path d=\"M{1} {0:.1f}H{2}\" stroke=\"#ddd\"/><text x=\"{3}\" y=\"{4:.1f}\" "
        "text-anchor=\"end\">{5:.6g}</text>\n",
        down(y, tick), left, width - right, left - 6.0, down(y, tick) + 4.0,
        std::fabs(tick) < 1e-9 * y.step ? 0.0 : tick);
  }
  double at = width - right;
  // NOLINTNEXTLINE(modernize-loop-convert): clang 14 does not take std::views::reverse
  for (auto line = lines.rbegin(); line != lines.rend(); ++line) {
    svg += fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.4\"/>\n", path_of(*line, x, y),
                       line->colour);
    svg += fmt::format("<text x=\"{}\" y=\"16\" text-anchor=\"end\" fill=\"{}\">{}</text>\n", at, line->colour,
                       escaped(line->name));
    at -= 8.0 * static_cast<double>(line->name.size()) + 16.0;
  }
  svg += fmt::format(
      "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n"
      "<text transform=\"translate(14 {}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n</svg>\n",
      0.5 * (left + width - right), height - 8.0, escaped(labels.x), 0.5 * (top + height - bottom), escaped(labels.y));
  return svg;
}

}  // namespace hysteron::tool
