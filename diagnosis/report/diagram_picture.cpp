#include "diagnosis/report/diagram_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "codegen/language/syntax.hpp"
#include "diagnosis/report/drawn_graph.hpp"
#include "diagnosis/report/html.hpp"
#include "diagnosis/report/layered_layout.hpp"

namespace hysteron::diagnosis::report {
namespace {

using language::upper;

constexpr std::size_t most_boxes = 120;
constexpr double character = 8.2;  ///< width of one in a box's name
constexpr double small_character = 6.6;
constexpr double row = 14.0;  ///< height of a pin's row, and of a line of text
constexpr std::size_t longest_line = 18;
constexpr std::size_t most_lines = 2;

/// What is known of a wire.
struct WireState {
  double share = std::nan("");  ///< of the gap; NaN where no finding names the wire
  std::string edge{};           ///< the name by which the finding names it
  std::string effect{};         ///< that the verdict puts there
};

bool names_wire(const DrawnWire& wire, const std::string& edge) {
  const std::string name = upper(edge);
  return wire.sink_name == name ||
         std::find(wire.source_names.begin(), wire.source_names.end(), name) != wire.source_names.end();
}

/// A name on as many lines as it needs, broken at a space, else behind _ or a dot; the last line is cut where there are
/// too many.
std::vector<std::string> lines_of(std::string_view name) {
  std::vector<std::string> lines;
  while (lines.size() + 1 < most_lines && character_count(name) > longest_line) {
    const std::size_t fits = clipped(name, longest_line).size() - std::string_view("…").size();
    const std::size_t space = name.substr(0, fits).rfind(' ');
    const std::size_t place = space != std::string_view::npos ? space : name.substr(0, fits).find_last_of("_.");
    const std::size_t end = place == std::string_view::npos || place == 0 ? fits : place + 1;
    lines.emplace_back(name.substr(0, end));
    name.remove_prefix(end);
  }
  lines.push_back(clipped(name, longest_line));
  return lines;
}

double widest_of(const std::vector<std::string>& lines) {
  std::size_t most = 0;
  for (const std::string& line : lines) {
    most = std::max(most, character_count(line));
  }
  return character * static_cast<double>(most);
}

class Picture {
 public:
  Picture(const Diagnosis& diagnosis, DrawnGraph drawn) : diagnosis_(diagnosis), drawn_(std::move(drawn)) {}

  std::string text() {
    find_carriers();
    draw_effects_on_wires();
    wires_.resize(drawn_.wires.size());
    find_states();
    std::vector<LayoutBox> boxes;
    for (const DrawnBox& box : drawn_.boxes) {
      boxes.push_back(size_of(box, carriers_.contains(boxes.size())));
    }
    std::vector<LayoutEdge> edges;
    for (const DrawnWire& wire : drawn_.wires) {
      const DrawnBox& from = drawn_.boxes[wire.from];
      const DrawnBox& to = drawn_.boxes[wire.to];
      edges.push_back({wire.from, port_height(wire.from, boxes[wire.from].height, wire.output, from.outputs.size()),
                       wire.to, port_height(wire.to, boxes[wire.to].height, wire.pin, to.pins.size())});
    }
    const Layout layout = layered_layout(boxes, edges);
    std::string svg = fmt::format(
        "<svg class=\"diagram\" viewBox=\"0 -16 {0:.0f} {1:.0f}\" style=\"max-width:{0:.0f}px;min-width:{2:.0f}px\" "
        "role=\"img\" aria-label=\"The diagram with the gap on its wires\">\n",
        layout.width, layout.height + 16.0, 0.55 * layout.width);
    for (std::size_t i = 0; i < wires_.size(); ++i) {
      svg += wire_text(wires_[i], layout.curves[i]);
    }
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      svg += box_text(i, layout.boxes[i], boxes[i]);
    }
    for (std::size_t i = 0; i < wires_.size(); ++i) {
      svg += label_text(i, layout.curves[i]);
    }
    return svg + "</svg>\n";
  }

 private:
  static bool has_rows(const DrawnBox& box) {
    return box.kind == DrawnBox::Kind::Block && (box.pins.size() > 1 || box.outputs.size() > 1);
  }

  static std::string effect_text(const DrawnBox& box) { return "effect: " + words_of(box.effect); }

  /// The height of what stands above the pins: the name, the type, the effect that the block stands for.
  static double head_of(const DrawnBox& box, bool added) {
    return 26.0 + row * static_cast<double>(lines_of(box.name).size()) + (added ? row : 0.0);
  }

  static LayoutBox size_of(const DrawnBox& box, bool added) {
    const std::vector<std::string> lines = lines_of(box.name);
    const double name = widest_of(lines);
    if (box.kind == DrawnBox::Kind::Expression) {
      return {name * 0.9 + 20.0, 14.0 + row * static_cast<double>(lines.size()), Side::Any};
    }
    const double type = small_character * static_cast<double>(character_count(box.type));
    const double rows = row * static_cast<double>(std::max(box.pins.size(), box.outputs.size()));
    const double effect = added ? small_character * static_cast<double>(character_count(effect_text(box))) : 0.0;
    LayoutBox size{std::max({name, type, effect}) + 24.0, head_of(box, added) + (has_rows(box) ? rows : 2.0),
                   Side::Any};
    if (box.kind == DrawnBox::Kind::Effect) {
      return {name + 26.0, 30.0, Side::Any};
    }
    if (box.kind != DrawnBox::Kind::Block) {
      size.width = name + (box.type.empty() || box.type == "1" ? 0.0 : type + 16.0) + 26.0;
      size.height = 30.0;
      size.side = box.kind == DrawnBox::Kind::Input ? Side::Left : Side::Right;
    }
    return size;
  }

  [[nodiscard]] double port_height(std::size_t index, double height, std::size_t port, std::size_t count) const {
    const DrawnBox& box = drawn_.boxes[index];
    return has_rows(box) && count > 0 ? head_of(box, carriers_.contains(index)) + 4.0 + row * static_cast<double>(port)
                                      : 0.5 * height;
  }

  /// The box that carries an effect: of its kind, and on its edge where there are several.
  [[nodiscard]] bool carries(std::size_t box, const EffectFinding& effect) const {
    if (drawn_.boxes[box].effect != effect.id) {
      return false;
    }
    const auto same = std::count_if(drawn_.boxes.begin(), drawn_.boxes.end(),
                                    [&](const DrawnBox& other) { return other.effect == effect.id; });
    return same == 1 || std::any_of(drawn_.wires.begin(), drawn_.wires.end(), [&](const DrawnWire& wire) {
             return (wire.to == box || wire.from == box) && names_wire(wire, effect.edge);
           });
  }

  void find_carriers() {
    for (const EffectFinding& effect : diagnosis_.effects) {
      for (std::size_t box = 0; box < drawn_.boxes.size(); ++box) {
        if (carries(box, effect)) {
          carriers_.insert(box);
        }
      }
    }
  }

  /// An effect that no box carries, as glitches or a richer block, gets one on its wire: a label beside the wire would
  /// lie under other wires and boxes.
  void draw_effects_on_wires() {
    for (const EffectFinding& effect : diagnosis_.effects) {
      const std::size_t box = drawn_.boxes.size();
      std::optional<DrawnWire> before;
      for (std::size_t i = 0; i < drawn_.wires.size() && !has_carrier(effect.id); ++i) {
        DrawnWire& wire = drawn_.wires[i];
        if (names_wire(wire, effect.edge) && (!before || before->from == wire.from)) {
          before = before.value_or(wire);
          wire.from = box;
          wire.output = 0;
        }
      }
      if (before) {
        before->to = box;
        before->pin = 0;
        drawn_.wires.push_back(std::move(*before));
        drawn_.boxes.push_back(
            {DrawnBox::Kind::Effect, words_of(effect.id), {}, effect.id, "on " + effect.edge, {}, {}});
        carriers_.insert(box);
      }
    }
  }

  void find_states() {
    for (std::size_t i = 0; i < wires_.size(); ++i) {
      const DrawnWire& wire = drawn_.wires[i];
      for (const EdgeFinding& finding : diagnosis_.edges) {
        if (names_wire(wire, finding.edge) && !(finding.share <= wires_[i].share)) {
          wires_[i].share = finding.share;
          wires_[i].edge = finding.edge;
        }
      }
      for (const EffectFinding& effect : diagnosis_.effects) {
        if (carries(wire.from, effect) || carries(wire.to, effect)) {
          wires_[i].effect = effect.id;
        }
      }
    }
    // An effect has cut its edge in two: the finding holds for both halves.
    for (const std::size_t box : carriers_) {
      WireState found;
      for (std::size_t i = 0; i < wires_.size(); ++i) {
        if ((drawn_.wires[i].to == box || drawn_.wires[i].from == box) && !std::isnan(wires_[i].share)) {
          found = wires_[i];
        }
      }
      for (std::size_t i = 0; i < wires_.size(); ++i) {
        if ((drawn_.wires[i].to == box || drawn_.wires[i].from == box) && std::isnan(wires_[i].share)) {
          wires_[i].share = found.share;
          wires_[i].edge = found.edge;
        }
      }
    }
  }

  /// Five steps of colour and width; a wire that was not looked at is thin and grey.
  static int step_of(double share) {
    return std::isnan(share) ? 0 : 1 + std::clamp(static_cast<int>(share * 5.0), 0, 4);
  }

  static std::string path_of(const std::vector<Point>& curve) {
    std::string path = fmt::format("M{:.1f} {:.1f}", curve[0].x, curve[0].y);
    for (std::size_t i = 1; i + 2 < curve.size(); i += 3) {
      path += fmt::format("C{:.1f} {:.1f} {:.1f} {:.1f} {:.1f} {:.1f}", curve[i].x, curve[i].y, curve[i + 1].x,
                          curve[i + 1].y, curve[i + 2].x, curve[i + 2].y);
    }
    return path;
  }

  [[nodiscard]] static std::string wire_text(const WireState& state, const std::vector<Point>& curve) {
    const int step = step_of(state.share);
    const std::string path = path_of(curve);
    std::string title;
    if (step > 0) {
      title = fmt::format("<title>{}: test signals or an effect here explain {} of the gap</title>",
                          escaped(state.edge), percent(state.share));
    }
    std::string svg;
    if (!state.effect.empty()) {
      svg += fmt::format("<path class=\"marked\" d=\"{}\"/>\n", path);
    }
    const Point tip = curve.back();
    return svg + fmt::format(
                     "<path class=\"wire s{0}\" d=\"{1}\">{2}</path>\n"
                     "<path class=\"tip t{0}\" d=\"M{3:.1f} {4:.1f}l-8 -4v8z\"/>\n",
                     step, path, title, tip.x, tip.y);
  }

  /// Whether a wire before this one says the same.
  [[nodiscard]] bool said_before(std::size_t index, std::string WireState::*what) const {
    return std::any_of(wires_.begin(), wires_.begin() + static_cast<std::ptrdiff_t>(index),
                       [&](const WireState& other) { return other.*what == wires_[index].*what; });
  }

  [[nodiscard]] bool has_carrier(const std::string& effect) const {
    return std::any_of(carriers_.begin(), carriers_.end(),
                       [&](std::size_t box) { return drawn_.boxes[box].effect == effect; });
  }

  /// Whether a wire before this one has its share written where both leave their box.
  [[nodiscard]] bool label_is_taken(std::size_t index) const {
    for (std::size_t i = 0; i < index; ++i) {
      if (drawn_.wires[i].from == drawn_.wires[index].from && drawn_.wires[i].output == drawn_.wires[index].output &&
          has_label(i)) {
        return true;
      }
    }
    return false;
  }
  [[nodiscard]] bool has_label(std::size_t index) const {
    return wires_[index].share >= 0.05 && !said_before(index, &WireState::edge);
  }

  /// The share beside the first wire of an edge: where it begins, or of a branch where it ends.
  [[nodiscard]] std::string label_text(std::size_t index, const std::vector<Point>& curve) const {
    if (!has_label(index)) {
      return {};
    }
    const bool at_end = label_is_taken(index);
    const Point at = at_end ? curve.back() : curve[0];
    return fmt::format("<text class=\"share\" x=\"{:.1f}\" y=\"{:.1f}\"{}>{}</text>\n", at.x + (at_end ? -10.0 : 6.0),
                       at.y + (at_end ? 16.0 : -6.0), at_end ? " text-anchor=\"end\"" : "",
                       percent(wires_[index].share));
  }

  [[nodiscard]] std::string box_text(std::size_t index, Point corner, const LayoutBox& size) const {
    const DrawnBox& box = drawn_.boxes[index];
    const bool added = carriers_.contains(index);
    static constexpr const char* classes[] = {"port", "block", "expression", "port", "block on-wire"};
    std::string svg =
        fmt::format("<g class=\"{}{}\" transform=\"translate({:.1f} {:.1f})\">",
                    classes[static_cast<std::size_t>(box.kind)], added ? " added" : "", corner.x, corner.y);
    const bool round = box.kind == DrawnBox::Kind::Input || box.kind == DrawnBox::Kind::Output;
    svg += fmt::format(R"(<title>{}</title><rect width="{:.1f}" height="{:.1f}" rx="{}"/>)",
                       escaped(box.meaning.empty() ? box.name : box.name + ": " + box.meaning), size.width, size.height,
                       round ? 15 : 4);
    const std::vector<std::string> lines = lines_of(box.name);
    const double middle = 0.5 * size.width;
    const bool block = box.kind == DrawnBox::Kind::Block;
    const bool unit = round && !box.type.empty() && box.type != "1";
    double y = block ? 18.0 : 0.5 * (size.height - row * static_cast<double>(lines.size() - 1)) + 4.5;
    for (std::size_t i = 0; i < lines.size(); ++i, y += row) {
      const bool last = i + 1 == lines.size();
      svg += fmt::format(
          R"(<text class="name" x="{:.1f}" y="{:.1f}">{}{}</text>)", middle, y, escaped(lines[i]),
          unit && last ? fmt::format(" <tspan class=\"type\">[{}]</tspan>", escaped(box.type)) : std::string());
    }
    if (block) {
      svg += fmt::format(R"(<text class="type" x="{:.1f}" y="{:.1f}">{}</text>)", middle, y, escaped(box.type));
      if (added) {
        svg += fmt::format(R"(<text class="effect" x="{:.1f}" y="{:.1f}">{}</text>)", middle, y + row,
                           escaped(effect_text(box)));
      }
      svg += has_rows(box) ? pins_text(box, size.width, head_of(box, added) + 7.0) : std::string();
    }
    return svg + "</g>\n";
  }

  static std::string pins_text(const DrawnBox& box, double width, double first) {
    std::string svg;
    for (std::size_t i = 0; i < box.pins.size(); ++i) {
      svg += fmt::format(R"(<text class="pin" x="5" y="{:.1f}">{}</text>)", first + row * static_cast<double>(i),
                         escaped(box.pins[i]));
    }
    for (std::size_t i = 0; i < box.outputs.size(); ++i) {
      svg += fmt::format(R"(<text class="pin out" x="{:.1f}" y="{:.1f}">{}</text>)", width - 5.0,
                         first + row * static_cast<double>(i), escaped(box.outputs[i]));
    }
    return svg;
  }

  const Diagnosis& diagnosis_;
  DrawnGraph drawn_;
  std::vector<WireState> wires_{};
  std::set<std::size_t> carriers_{};
};

}  // namespace

std::string diagram_picture(const Diagnosis& diagnosis, const Graph& graph) {
  DrawnGraph drawn = drawn_graph(graph);
  if (drawn.wires.empty() || drawn.boxes.size() > most_boxes) {
    return {};
  }
  return Picture(diagnosis, std::move(drawn)).text();
}

}  // namespace hysteron::diagnosis::report
