#include "diagnosis/report/drawn_graph.hpp"

#include <algorithm>
#include <map>

#include "codegen/language/syntax.hpp"

namespace hysteron::diagnosis::report {
namespace {

using language::upper;

constexpr std::size_t no_box = static_cast<std::size_t>(-1);

/// What the operations of an expression feed: INV.R1 of INV.R1#0.
std::string fed_by(const std::string& path) {
  return path.substr(0, path.rfind('#'));
}

/// The text of an expression on one line, as the diagram has it.
std::string text_of(const Graph& graph, const Node& node) {
  if (graph.source == nullptr || graph.source->text == nullptr ||
      std::size_t{node.span.offset} + node.span.length > graph.source->text->size() || node.span.length == 0) {
    return std::string(info(node.op).name);
  }
  std::string text;
  for (const char c : graph.source->text_of(node.span)) {
    const bool space = c == ' ' || c == '\n' || c == '\t' || c == '\r';
    if (!space || (!text.empty() && text.back() != ' ')) {
      text += space ? ' ' : c;
    }
  }
  return text;
}

std::size_t place_in(std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) {
    return static_cast<std::size_t>(found - names.begin());
  }
  names.push_back(name);
  return names.size() - 1;
}

class Drawing {
 public:
  explicit Drawing(const Graph& graph) : graph_(graph), box_of_node_(graph.nodes.size(), no_box) {}

  DrawnGraph run() {
    for (const Port& port : graph_.inputs) {
      drawn_.boxes.push_back({DrawnBox::Kind::Input, port.name, port.unit, {}, port.meaning, {}, {}});
    }
    add_nodes();
    for (const NamedWire& named : graph_.named) {
      names_[key(named.wire)].push_back(upper(named.path));
    }
    for (std::size_t i = 0; i < graph_.nodes.size(); ++i) {
      connect_node(i);
    }
    for (const Port& port : graph_.outputs) {
      drawn_.boxes.push_back({DrawnBox::Kind::Output, port.name, port.unit, {}, port.meaning, {}, {}});
      connect(port.wire, drawn_.boxes.size() - 1, port.name, upper(port.name));
    }
    drop_unconnected();
    return std::move(drawn_);
  }

 private:
  using Key = std::pair<std::uint32_t, std::uint32_t>;
  static Key key(const Wire& wire) { return {(static_cast<std::uint32_t>(wire.from) << 16U) | wire.port, wire.index}; }

  /// Operations that feed one other operation of the same expression are drawn within it.
  void add_nodes() {
    std::vector<std::size_t> reader(graph_.nodes.size(), no_box);
    std::vector<int> readers(graph_.nodes.size(), 0);
    const auto read = [&](const Wire& wire, std::size_t by) {
      if (wire.from == Wire::From::Node) {
        reader[wire.index] = by;
        ++readers[wire.index];
      }
    };
    for (std::size_t i = 0; i < graph_.nodes.size(); ++i) {
      for (std::size_t pin = 0; pin < graph_.nodes[i].wire_count; ++pin) {
        read(graph_.wire(graph_.nodes[i], pin), i);
      }
    }
    for (const Port& port : graph_.outputs) {
      read(port.wire, no_box);
    }
    whole_.resize(graph_.nodes.size());
    for (std::size_t i = 0; i < graph_.nodes.size(); ++i) {
      std::size_t root = i;
      while (graph_.nodes[root].block == nullptr && readers[root] == 1 && reader[root] != no_box &&
             graph_.nodes[reader[root]].block == nullptr &&
             fed_by(graph_.nodes[reader[root]].path) == fed_by(graph_.nodes[root].path)) {
        root = reader[root];
      }
      whole_[i] = root;
    }
    for (std::size_t i = 0; i < graph_.nodes.size(); ++i) {
      if (whole_[i] == i) {
        box_of_node_[i] = drawn_.boxes.size();
        drawn_.boxes.push_back(box_of(graph_.nodes[i]));
      }
    }
  }

  [[nodiscard]] DrawnBox box_of(const Node& node) const {
    if (node.block == nullptr) {
      return {DrawnBox::Kind::Expression, text_of(graph_, node), {}, {}, fed_by(node.path), {}, {}};
    }
    const About& about = node.block->about;
    return {DrawnBox::Kind::Block,
            node.path,
            std::string(about.name.substr(about.name.starts_with("HY_") ? 3 : 0)),
            std::string(about.effect),
            std::string(about.title),
            {},
            {}};
  }

  void connect_node(std::size_t index) {
    const Node& node = graph_.nodes[index];
    for (std::size_t pin = 0; pin < node.wire_count; ++pin) {
      const Wire& wire = graph_.wire(node, pin);
      if (node.block != nullptr) {
        const std::string name(node.block->pin(pin).name);
        connect(wire, box_of_node_[index], name, upper(node.path + "." + name));
      } else if (wire.from != Wire::From::Node || whole_[wire.index] != whole_[index]) {
        connect(wire, box_of_node_[whole_[index]], {}, {});
      }
    }
  }

  /// A wire to a pin; nothing for literals and parameters.
  void connect(const Wire& wire, std::size_t to, const std::string& pin, std::string sink_name) {
    DrawnWire drawn;
    std::string output;
    if (wire.from == Wire::From::Input) {
      drawn.from = wire.index;
      drawn.source_names = {upper(graph_.inputs[wire.index].name)};
    } else if (wire.from == Wire::From::Node) {
      const Node& node = graph_.nodes[wire.index];
      drawn.from = box_of_node_[whole_[wire.index]];
      if (node.block != nullptr) {
        output = std::string(node.block->outputs[wire.port].name);
        drawn.source_names = {upper(node.path + "." + output)};
      } else {
        drawn.source_names = {upper(fed_by(node.path))};
      }
    } else {
      return;
    }
    if (const auto found = names_.find(key(wire)); found != names_.end()) {
      drawn.source_names.insert(drawn.source_names.end(), found->second.begin(), found->second.end());
    }
    drawn.output = place_in(drawn_.boxes[drawn.from].outputs, output);
    drawn.to = to;
    drawn.pin = place_in(drawn_.boxes[to].pins, pin);
    drawn.sink_name = std::move(sink_name);
    const bool known = std::any_of(drawn_.wires.begin(), drawn_.wires.end(), [&](const DrawnWire& other) {
      return other.from == drawn.from && other.output == drawn.output && other.to == drawn.to && other.pin == drawn.pin;
    });
    if (!known) {  // U * U reads U twice
      drawn_.wires.push_back(std::move(drawn));
    }
  }

  /// A box without wires, as an input that nothing reads, tells nothing about the gap.
  void drop_unconnected() {
    std::vector<std::size_t> place(drawn_.boxes.size(), no_box);
    std::vector<DrawnBox> kept;
    for (std::size_t i = 0; i < drawn_.boxes.size(); ++i) {
      if (!drawn_.boxes[i].pins.empty() || !drawn_.boxes[i].outputs.empty()) {
        place[i] = kept.size();
        kept.push_back(std::move(drawn_.boxes[i]));
      }
    }
    drawn_.boxes = std::move(kept);
    for (DrawnWire& wire : drawn_.wires) {
      wire.from = place[wire.from];
      wire.to = place[wire.to];
    }
  }

  const Graph& graph_;
  std::vector<std::size_t> box_of_node_;
  std::vector<std::size_t> whole_{};  ///< by node: the last operation of its expression, or itself
  std::map<Key, std::vector<std::string>> names_{};
  DrawnGraph drawn_{};
};

}  // namespace

DrawnGraph drawn_graph(const Graph& graph) {
  return Drawing(graph).run();
}

}  // namespace hysteron::diagnosis::report
