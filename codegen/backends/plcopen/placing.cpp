#include "codegen/backends/plcopen/placing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "support/errors.hpp"

namespace hysteron::plcopen {
namespace {

// In pixels, on a grid of 10 as editors have it.
constexpr int letter = 8;
constexpr int line = 20;
constexpr int head = 40;  ///< of a block: its type, and its name above
constexpr int variable_height = 30;
constexpr int margin = 40;
constexpr int grid = 10;

constexpr double pixels_an_inch = 72.0;

int on_grid(double pixels) {
  return static_cast<int>(std::lround(pixels / grid)) * grid;
}

std::size_t longest(const Element& element) {
  std::size_t inputs = 0;
  std::size_t outputs = 0;
  for (const Input& one : element.inputs) {
    inputs = std::max(inputs, one.pin.size());
  }
  for (const std::string& one : element.outputs) {
    outputs = std::max(outputs, one.size());
  }
  return std::max({element.text.size(), element.instance.size(), inputs + outputs + 2});
}

}  // namespace

Size size_of(const Element& element) {
  const auto letters = static_cast<int>(longest(element));
  if (element.kind != Element::Kind::Block) {
    return {.width = on_grid(letter * letters + line), .height = variable_height};
  }
  const auto pins = static_cast<int>(std::max(element.inputs.size(), element.outputs.size()));
  return {.width = on_grid(letter * letters + line), .height = head + line * std::max(pins, 1)};
}

int pin_height(const Element& element, std::size_t place) {
  return element.kind == Element::Kind::Block ? head + line * static_cast<int>(place) : variable_height / 2;
}

std::string placing_dot(const std::vector<Network>& networks) {
  std::string text;
  for (const Network& network : networks) {
    text += fmt::format(
        "digraph \"{}\" {{\n  graph [rankdir=LR, nodesep=0.3, ranksep=0.8];\n  node [shape=box, "
        "fixedsize=true, label=\"\"];\n",
        network.name);
    for (std::size_t i = 0; i < network.elements.size(); ++i) {
      const Size size = size_of(network.elements[i]);
      text += fmt::format("  n{} [width={:.4f}, height={:.4f}];\n", i, size.width / pixels_an_inch,
                          size.height / pixels_an_inch);
    }
    for (std::size_t i = 0; i < network.elements.size(); ++i) {
      for (const Input& input : network.elements[i].inputs) {
        const Element& from = network.elements[input.from.element];
        const bool feedback = from.order > network.elements[i].order;
        text += fmt::format("  n{} -> n{}{};\n", feedback ? i : input.from.element, feedback ? input.from.element : i,
                            feedback ? " [dir=back]" : "");
      }
    }
    text += "}\n";
  }
  return text;
}

void take_places(const std::string& plain, std::vector<Network>& networks) {
  std::istringstream lines(plain);
  std::size_t network = 0;
  double height = 0.0;
  std::size_t placed = 0;
  for (std::string one; std::getline(lines, one);) {
    std::istringstream words(one);
    std::string kind;
    words >> kind;
    if (kind == "graph") {
      double scale = 0.0;
      double width = 0.0;
      words >> scale >> width >> height;
    } else if (kind == "stop") {
      ++network;
    } else if (kind == "node" && network < networks.size()) {
      char letter_n = ' ';
      std::size_t index = 0;
      double x = 0.0;
      double y = 0.0;
      words >> letter_n >> index >> x >> y;
      if (words && index < networks[network].elements.size()) {
        Element& element = networks[network].elements[index];
        const Size size = size_of(element);
        element.x = margin + on_grid(pixels_an_inch * x - size.width / 2.0);
        element.y = margin + on_grid(pixels_an_inch * (height - y) - size.height / 2.0);
        ++placed;
      }
    }
  }
  std::size_t wanted = 0;
  for (const Network& one : networks) {
    wanted += one.elements.size();
  }
  if (placed != wanted) {
    throw InputError(error::graphviz_failed, {}, fmt::format("Graphviz placed {} of {} boxes.", placed, wanted),
                     "see whether this dot draws anything: echo 'digraph {a}' | dot -Tplain; --body st needs none.");
  }
}

}  // namespace hysteron::plcopen
