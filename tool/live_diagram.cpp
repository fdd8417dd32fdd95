#include "tool/live_diagram.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "codegen/language/syntax.hpp"
#include "diagnosis/report/drawn_graph.hpp"
#include "diagnosis/report/html.hpp"
#include "diagnosis/report/layered_layout.hpp"
#include "support/utf8.hpp"

namespace hysteron::tool {
namespace {

using diagnosis::report::DrawnBox;
using diagnosis::report::DrawnGraph;
using diagnosis::report::DrawnWire;
using diagnosis::report::escaped;
using diagnosis::report::Layout;
using diagnosis::report::LayoutBox;
using diagnosis::report::LayoutEdge;
using diagnosis::report::Side;
using language::upper;

constexpr std::size_t most_boxes = 120;
constexpr std::size_t longest_name = 20;
constexpr std::size_t value_length = 10;  ///< characters of a number on the page
constexpr double character = 7.8;         ///< width of one in a box's name
constexpr double small_character = 7.3;   ///< in types, pins and values
constexpr double row = 17.0;              ///< height of a row of pins
constexpr double first_row = 54.0;

/// What a place for a value shows.
struct Shown {
  std::string attribute{};  ///< data-point="Y" or data-inner="3"; empty: nothing that can be shown
  std::string unit{};
};

double width_of(const std::string& text, double each) {
  return each * static_cast<double>(character_count(text));
}

class Picture {
 public:
  Picture(const Graph& graph, const std::vector<InnerSignal>& inner, DrawnGraph drawn)
      : inner_(inner), drawn_(std::move(drawn)) {
    for (const Node& node : graph.nodes) {
      for (std::size_t pin = 0; node.block != nullptr && pin < node.wire_count; ++pin) {
        sources_.emplace(upper(node.path + "." + std::string(node.block->pin(pin).name)), graph.wire(node, pin));
      }
    }
    for (const Port& port : graph.outputs) {
      sources_.emplace(upper(port.name), port.wire);
    }
    for (const DrawnBox& box : drawn_.boxes) {
      shown_.emplace_back(std::max<std::size_t>(box.outputs.size(), 1));
      if (box.kind == DrawnBox::Kind::Input || box.kind == DrawnBox::Kind::Output) {
        shown_.back().front() = {fmt::format("data-point=\"{}\"", escaped(box.name)), box.type};
      }
    }
    for (const DrawnWire& wire : drawn_.wires) {
      if (drawn_.boxes[wire.from].kind != DrawnBox::Kind::Input) {
        find_inner(wire);
      }
    }
  }

  [[nodiscard]] std::string text() const {
    std::vector<LayoutBox> boxes;
    for (std::size_t i = 0; i < drawn_.boxes.size(); ++i) {
      boxes.push_back(size_of(i));
    }
    std::vector<LayoutEdge> edges;
    for (const DrawnWire& wire : drawn_.wires) {
      const DrawnBox& from = drawn_.boxes[wire.from];
      const DrawnBox& to = drawn_.boxes[wire.to];
      edges.push_back({wire.from, height_of_port(from, boxes[wire.from].height, wire.output), wire.to,
                       height_of_port(to, boxes[wire.to].height, wire.pin)});
    }
    const Layout layout = diagnosis::report::layered_layout(boxes, edges);
    std::string svg = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" "
        "height=\"{1:.0f}\" role=\"img\" aria-label=\"The diagram with the values of its signals\">\n",
        layout.width, layout.height);
    for (std::size_t i = 0; i < drawn_.wires.size(); ++i) {
      svg += wire_text(layout.curves[i]);
    }
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      svg += fmt::format("<g class=\"box\" transform=\"translate({:.1f} {:.1f})\">", layout.boxes[i].x,
                         layout.boxes[i].y) +
             box_text(i, boxes[i]) + "</g>\n";
    }
    return svg + "</svg>\n";
  }

 private:
  void find_inner(const DrawnWire& wire) {
    // A block's output by its own name; an expression has that of what it feeds.
    const bool is_block = drawn_.boxes[wire.from].kind == DrawnBox::Kind::Block;
    const auto source = sources_.find(wire.sink_name);
    const auto signal = std::ranges::find_if(inner_, [&](const InnerSignal& one) {
      return is_block ? upper(one.name) == wire.source_names.front()
                      : source != sources_.end() && one.wire == source->second;
    });
    if (signal != inner_.end()) {
      shown_[wire.from][wire.output] = {fmt::format("data-inner=\"{}\"", signal - inner_.begin()), signal->unit};
    }
  }

  static bool has_rows(const DrawnBox& box) {
    return box.kind == DrawnBox::Kind::Block && (box.pins.size() > 1 || box.outputs.size() > 1);
  }

  static double height_of_port(const DrawnBox& box, double height, std::size_t port) {
    return has_rows(box) ? first_row - 4.0 + row * static_cast<double>(port) : 0.5 * height;
  }

  static double value_width(const Shown& shown) {
    return small_character * static_cast<double>(value_length + 1 + (shown.unit == "1" ? 0 : shown.unit.size()));
  }

  static std::string name_of(const DrawnBox& box) { return clipped(box.name, longest_name); }

  [[nodiscard]] LayoutBox size_of(std::size_t index) const {
    const DrawnBox& box = drawn_.boxes[index];
    double width = std::max(width_of(name_of(box), character), width_of(box.type, small_character));
    double height = 46.0;
    if (has_rows(box)) {
      double pins = 0.0;
      for (const std::string& pin : box.pins) {
        pins = std::max(pins, width_of(pin, small_character));
      }
      for (std::size_t i = 0; i < box.outputs.size(); ++i) {
        width =
            std::max(width, pins + 16.0 + width_of(box.outputs[i], small_character) + value_width(shown_[index][i]));
      }
      height = first_row + row * static_cast<double>(std::max(box.pins.size(), box.outputs.size()) - 1) + 10.0;
    } else {
      width = std::max(width, value_width(shown_[index].front()));
      height += box.kind == DrawnBox::Kind::Block ? 16.0 : 0.0;
    }
    const Side side = box.kind == DrawnBox::Kind::Input    ? Side::Left
                      : box.kind == DrawnBox::Kind::Output ? Side::Right
                                                           : Side::Any;
    return {width + 20.0, height, side};
  }

  static std::string wire_text(const std::vector<diagnosis::report::Point>& curve) {
    std::string path = fmt::format("M{:.1f} {:.1f}", curve[0].x, curve[0].y);
    for (std::size_t i = 1; i + 2 < curve.size(); i += 3) {
      path += fmt::format("C{:.1f} {:.1f} {:.1f} {:.1f} {:.1f} {:.1f}", curve[i].x, curve[i].y, curve[i + 1].x,
                          curve[i + 1].y, curve[i + 2].x, curve[i + 2].y);
    }
    return fmt::format("<path class=\"wire\" d=\"{}\"/><path class=\"tip\" d=\"M{:.1f} {:.1f}l-8 -4v8z\"/>\n", path,
                       curve.back().x, curve.back().y);
  }

  static std::string value_text(const Shown& shown, const char* anchor, double x, double y) {
    return shown.attribute.empty() ? std::string()
                                   : fmt::format("<text class=\"value {}\" x=\"{:.1f}\" y=\"{:.1f}\" {}>–</text>",
                                                 anchor, x, y, shown.attribute);
  }

  [[nodiscard]] std::string box_text(std::size_t index, const LayoutBox& size) const {
    const DrawnBox& box = drawn_.boxes[index];
    static constexpr const char* kinds[] = {"port", "block", "expression", "port"};
    const char* const kind = kinds[static_cast<std::size_t>(box.kind)];
    const double middle = 0.5 * size.width;
    std::string svg = fmt::format("<title>{}</title><rect class=\"{}\" width=\"{:.1f}\" height=\"{:.1f}\" rx=\"{}\"/>",
                                  escaped(box.meaning.empty() ? box.name : box.name + ": " + box.meaning), kind,
                                  size.width, size.height, kind == kinds[0] ? 15 : 4);
    svg += fmt::format("<text class=\"name {}\" x=\"{:.1f}\" y=\"19\">{}</text>", kind, middle, escaped(name_of(box)));
    if (box.kind == DrawnBox::Kind::Block) {
      svg += fmt::format("<text class=\"type\" x=\"{:.1f}\" y=\"35\">{}</text>", middle, escaped(box.type));
    }
    if (!has_rows(box)) {
      return svg + value_text(shown_[index].front(), "middle", middle, box.kind == DrawnBox::Kind::Block ? 53.0 : 37.0);
    }
    for (std::size_t i = 0; i < box.pins.size(); ++i) {
      svg += fmt::format("<text class=\"pin\" x=\"6\" y=\"{:.1f}\">{}</text>", first_row + row * static_cast<double>(i),
                         escaped(box.pins[i]));
    }
    for (std::size_t i = 0; i < box.outputs.size(); ++i) {
      const double y = first_row + row * static_cast<double>(i);
      const double name = width_of(box.outputs[i], small_character);
      svg += fmt::format("<text class=\"pin out\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>", size.width - 6.0, y,
                         escaped(box.outputs[i]));
      svg += value_text(shown_[index][i], "end", size.width - name - 14.0, y);
    }
    return svg;
  }

  const std::vector<InnerSignal>& inner_;
  DrawnGraph drawn_;
  std::map<std::string, Wire> sources_{};    ///< by the name of a pin or output, in capitals
  std::vector<std::vector<Shown>> shown_{};  ///< by box and output; a port has one
};

}  // namespace

std::string live_diagram(const Graph& graph, const std::vector<InnerSignal>& inner) {
  DrawnGraph drawn = diagnosis::report::drawn_graph(graph);
  if (drawn.wires.empty() || drawn.boxes.size() > most_boxes) {
    return {};
  }
  return Picture(graph, inner, std::move(drawn)).text();
}

}  // namespace hysteron::tool
