#include "codegen/backends/reference/block_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <vector>

#include "codegen/backends/reference/block_response.hpp"
#include "plots/svg_plot.hpp"
#include "plots/thinned.hpp"

namespace hysteron {
namespace {

using plots::LineStyle;
using plots::Panel;
using plots::Polyline;
using plots::SvgPlot;

constexpr std::array<std::string_view, 4> input_colours{"#666666", "#009e73", "#cc79a7", "#8c6d31"};
constexpr std::array<std::string_view, 4> output_colours{"#0072b2", "#d55e00", "#e69f00", "#56b4e9"};

/// A trace over time: straight between samples, or in steps.
Polyline over_time(const ResponseTrace& trace, double sample_time, bool steps) {
  Polyline line;
  for (std::size_t k = 0; k < trace.values.size(); ++k) {
    const double t = static_cast<double>(k) * sample_time;
    if (steps && k > 0 && trace.values[k] != trace.values[k - 1]) {
      line.add(t, trace.values[k - 1]);
    }
    line.add(t, trace.values[k]);
  }
  if (steps) {
    line.add(static_cast<double>(trace.values.size()) * sample_time, trace.values.back());
  }
  return line;
}

Polyline over(const ResponseTrace& abscissa, const ResponseTrace& trace) {
  Polyline line;
  for (std::size_t k = 0; k < trace.values.size(); ++k) {
    line.add(abscissa.values[k], trace.values[k]);
  }
  return line;
}

/// Whether a number is drawn as held between samples: where it changes in a few of them only, or where they are few.
bool is_held(const ResponseTrace& trace) {
  constexpr std::size_t few = 50;
  return trace.type != Type::Real || trace.values.size() < few || plots::changes_seldom(trace.values);
}

class Picture {
 public:
  explicit Picture(const BlockResponse& response) : response_(response) {
    for (const ResponseTrace& trace : response_.traces) {
      (trace.type == Type::Bool ? lanes_ : curves_).push_back(&trace);
    }
  }

  std::string svg() { return response_.abscissa.empty() ? timing() : curve(); }

 private:
  LineStyle style(const ResponseTrace& trace) {
    return {.colour = trace.is_input ? input_colours[inputs_++ % input_colours.size()]
                                     : output_colours[outputs_++ % output_colours.size()],
            .width = trace.is_input ? 1.2 : 1.8,
            .dashed = trace.is_input};
  }

  /// Outputs over one of the inputs.
  std::string curve() {
    const auto abscissa = std::ranges::find_if(
        response_.traces, [&](const ResponseTrace& trace) { return trace.name == response_.abscissa; });
    SvgPlot plot(400, 290);
    Panel panel{.left = 58, .top = 12, .right = 312, .bottom = 246};
    for (const ResponseTrace* const trace : curves_) {
      if (!trace->is_input) {
        panel.lines.push_back({.name = trace->name, .line = over(*abscissa, *trace), .style = style(*trace)});
      }
    }
    panel.x_label = abscissa->name;
    plot.draw(panel);
    return plot.text();
  }

  /// Numbers above over time, truth values below as a timing diagram.
  std::string timing() {
    constexpr double lane_height = 26;
    const double lower = static_cast<double>(lanes_.size()) * lane_height;
    const double middle = curves_.empty() ? 10 : 205;
    SvgPlot plot(520, static_cast<int>(middle + lower + 44));
    const double end = static_cast<double>(response_.traces.front().values.size()) * response_.sample_time;
    const std::string label = "t [s]";
    if (!curves_.empty()) {
      Panel panel{.left = 78, .top = 12, .right = 430, .bottom = middle - (lanes_.empty() ? 0 : 10)};
      panel.x_label = lanes_.empty() ? label : std::string();
      panel.x_numbers = lanes_.empty();
      panel.fixed_x = {.low = 0.0, .high = end};
      for (const ResponseTrace* const trace : curves_) {
        panel.lines.push_back({.name = trace->name,
                               .line = over_time(*trace, response_.sample_time, is_held(*trace)),
                               .style = style(*trace)});
      }
      plot.draw(panel);
    }
    if (!lanes_.empty()) {
      plot.draw(lanes(middle, middle + lower, end, label));
    }
    return plot.text();
  }

  Panel lanes(double top, double bottom, double end, const std::string& label) {
    constexpr double distance = 1.5;
    Panel panel{
        .left = 78, .top = top, .right = 430, .bottom = bottom, .x_label = label, .legend = plots::Legend::None};
    panel.fixed_x = {.low = 0.0, .high = end};
    panel.fixed_y = {.low = -0.25, .high = static_cast<double>(lanes_.size()) * distance - 0.25};
    for (std::size_t i = 0; i < lanes_.size(); ++i) {
      const double base = static_cast<double>(lanes_.size() - 1 - i) * distance;
      Polyline line = over_time(*lanes_[i], response_.sample_time, true);
      for (double& y : line.y) {
        y += base;
      }
      panel.lines.push_back({.name = lanes_[i]->name, .line = std::move(line), .style = style(*lanes_[i])});
      panel.y_names.emplace_back(lanes_[i]->name, base + 0.5);
    }
    return panel;
  }

  const BlockResponse& response_;
  std::vector<const ResponseTrace*> curves_;
  std::vector<const ResponseTrace*> lanes_;
  std::size_t inputs_ = 0;
  std::size_t outputs_ = 0;
};

}  // namespace

std::string block_picture(const BlockType& block) {
  const BlockResponse response = block_response(block);
  return Picture(response).svg();
}

}  // namespace hysteron
