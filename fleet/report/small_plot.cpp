#include "fleet/report/small_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "fleet/when.hpp"
#include "plots/axis.hpp"
#include "support/markup.hpp"

namespace hysteron::fleet {
namespace {

constexpr double of_95 = 1.96;
constexpr double band = 3.0;
constexpr double room = 0.06;

struct Frame {
  plots::Reach x{};
  plots::Reach y{};
  double left = 0.0;
  double right = 0.0;
  double top = 0.0;
  double bottom = 0.0;

  [[nodiscard]] double px(double value) const { return left + (value - x.low) / (x.high - x.low) * (right - left); }
  [[nodiscard]] double py(double value) const {
    return std::clamp(bottom - (value - y.low) / (y.high - y.low) * (bottom - top), top - 2.0, bottom + 2.0);
  }
};

std::string opened(int width, int height, const std::string& name) {
  return fmt::format("<svg viewBox=\"0 0 {} {}\" width=\"{}\" height=\"{}\" role=\"img\" aria-label=\"{}\">", width,
                     height, width, height, escaped(name));
}

std::string siblings_band(const Parameter& parameter, const Frame& frame) {
  if (!std::isfinite(parameter.deviation)) {
    return "";
  }
  const double high = frame.py(parameter.median + band * parameter.deviation);
  const double low = frame.py(parameter.median - band * parameter.deviation);
  return fmt::format("<rect class=\"band\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"/>", frame.left,
                     high, frame.right - frame.left, std::max(1.0, low - high));
}

/// Constant, then the ramp or the step.
std::string change_line(const Trend& trend, double last, const Frame& frame) {
  const double since = std::clamp(trend.since, frame.x.low, frame.x.high);
  const double behind = trend.change == Change::Step ? trend.to : trend.from;
  return fmt::format("<path class=\"curve c1\" d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}L{:.1f} {:.1f}L{:.1f} {:.1f}\"/>",
                     frame.left, frame.py(trend.from), frame.px(since), frame.py(trend.from), frame.px(since),
                     frame.py(behind), frame.px(last), frame.py(trend.to));
}

}  // namespace

std::string small_plot(const Track& track, const Parameter& parameter, int width, int height,
                       const std::vector<std::string>& links) {
  const bool large = !links.empty();
  const bool over_time = track.series.time.size() == track.value.size();
  std::vector<double> x = track.series.time;
  for (std::size_t i = 0; !over_time && i < track.value.size(); ++i) {
    i == 0 ? x.assign(1, 0.0) : x.push_back(static_cast<double>(i));
  }
  Frame frame{.left = large ? 56.0 : 3.0, .right = width - 4.0, .top = 6.0, .bottom = height - (large ? 20.0 : 5.0)};
  plots::Reach reach_x;
  plots::Reach reach_y;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double half = std::isfinite(track.error[i]) ? of_95 * track.error[i] : 0.0;
    reach_x.take(x[i]);
    reach_y.take(track.value[i] - half);
    reach_y.take(track.value[i] + half);
  }
  if (large && std::isfinite(parameter.deviation)) {
    reach_y.take(parameter.median);
  }
  frame.x = reach_x.with_room(room);
  frame.y = reach_y.with_room(room);
  std::string svg = opened(width, height, fmt::format("{} of {}", parameter.name, track.machine));
  svg += siblings_band(parameter, frame);
  if (large) {
    svg += fmt::format("<path class=\"axis\" d=\"M{0:.1f} {1:.1f}V{2:.1f}H{3:.1f}\"/>", frame.left, frame.top,
                       frame.bottom, frame.right);
    const auto ticks = plots::round_numbers(frame.y, 3);
    for (const double tick : ticks) {
      svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>", frame.left - 4.0,
                         frame.py(tick) + 4.0, plots::tick_text(tick, ticks.size() > 1 ? ticks[1] - ticks[0] : tick));
    }
    if (over_time) {
      svg += fmt::format(
          "<text x=\"{:.1f}\" y=\"{}\">{}</text><text x=\"{:.1f}\" y=\"{}\" text-anchor=\"end\">{}</text>", frame.left,
          height - 5, date_text(x.front()).substr(0, 10), frame.right, height - 5, date_text(x.back()).substr(0, 10));
    }
  }
  std::string bars;
  std::string dots;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double px = frame.px(x[i]);
    if (std::isfinite(track.error[i])) {
      bars += fmt::format("M{:.1f} {:.1f}V{:.1f}", px, frame.py(track.value[i] - of_95 * track.error[i]),
                          frame.py(track.value[i] + of_95 * track.error[i]));
    }
    if (large) {
      dots += fmt::format(
          "<a href=\"{}\"><circle class=\"dot c0\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\"><title>{}: {:.4g} {}"
          "</title></circle></a>",
          escaped(links[i]), px, frame.py(track.value[i]),
          over_time ? date_text(x[i]) : fmt::format("record {}", i + 1), track.value[i], escaped(parameter.unit));
    } else {
      dots += fmt::format("M{:.1f} {:.1f}h0", px, frame.py(track.value[i]));
    }
  }
  svg += bars.empty() ? std::string() : fmt::format("<path class=\"bars\" d=\"{}\"/>", bars);
  svg += track.changes && over_time ? change_line(track.trend, x.back(), frame) : std::string();
  svg += large ? dots : fmt::format("<path class=\"dots\" d=\"{}\"/>", dots);
  return svg + "</svg>";
}

std::string strip_plot(const Analysis& all, const Parameter& parameter, int width, int height) {
  plots::Reach reach;
  for (const std::size_t i : parameter.tracks) {
    reach.take(all.tracks[i].level);
  }
  const Frame frame{.x = reach.with_room(room), .left = 18.0, .right = width - 18.0, .bottom = height - 18.0};
  // Machines that would lie on each other stand above each other.
  std::map<int, int> heights;
  std::string usual;
  std::string marked;
  for (const std::size_t i : parameter.tracks) {
    const Track& track = all.tracks[i];
    const double px = frame.px(track.level);
    const int above = heights[static_cast<int>(px / 3.0)]++;
    const double py = std::max(3.0, frame.bottom - 5.0 - 2.5 * above);
    if (track.stands_out || track.changes) {
      marked += fmt::format(
          "<circle class=\"dot c1\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.5\"><title>{}: {:.4g} {}</title></circle>", px,
          py, escaped(track.machine), track.level, escaped(parameter.unit));
    } else {
      usual += fmt::format("M{:.1f} {:.1f}h0", px, py);
    }
  }
  std::string axis =
      fmt::format("<path class=\"axis\" d=\"M{:.1f} {:.1f}H{:.1f}\"/>", frame.left, frame.bottom, frame.right);
  const auto ticks = plots::round_numbers(frame.x, 5);
  for (const double tick : ticks) {
    axis += fmt::format("<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">{}</text>", frame.px(tick), height - 4,
                        plots::tick_text(tick, ticks.size() > 1 ? ticks[1] - ticks[0] : tick));
  }
  return opened(width, height, parameter.name + " of all machines") + axis +
         fmt::format("<path class=\"dots\" d=\"{}\"/>{}</svg>", usual, marked);
}

}  // namespace hysteron::fleet
