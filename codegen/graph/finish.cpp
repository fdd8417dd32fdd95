#include "codegen/graph/finish.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>
#include <unordered_map>
#include <utility>

#include "support/errors.hpp"
#include "support/names.hpp"

namespace hysteron {
namespace {

/// The places of characters in the order of paths: a part before what is inside it, without regard to case.
constexpr std::array<std::uint16_t, 256> ranks = [] {
  std::array<std::uint16_t, 256> table{};
  for (unsigned c = 0; c < table.size(); ++c) {
    table[c] = static_cast<std::uint16_t>((c >= 'a' && c <= 'z' ? c - 'a' + 'A' : c) + 1);
  }
  table['.'] = 0;
  table['#'] = 1;
  return table;
}();

constexpr std::uint16_t rank(char letter) {
  return ranks[static_cast<unsigned char>(letter)];
}

/// Paths in the order of their names, numbers at the end by their value.
bool path_before(const std::string& a, const std::string& b) {
  for (std::size_t i = 0; i < a.size() && i < b.size(); ++i) {
    const int left = rank(a[i]);
    const int right = rank(b[i]);
    if (left != right) {
      return left < right;
    }
    if (a[i] == '#') {
      return a.size() != b.size() ? a.size() < b.size() : a < b;
    }
  }
  return a.size() < b.size();
}

/// The first eight ranks of a path as one number: where two differ, they are in the order of the paths. Behind a number
/// sign nothing is told.
std::uint64_t beginning(const std::string& path) {
  constexpr std::size_t places = 8;
  std::uint64_t key = 0;
  std::size_t i = 0;
  for (; i < places && i < path.size(); ++i) {
    const std::uint64_t here = std::min<std::uint64_t>(rank(path[i]), 0xFF);
    key = key << 8U | here;
    if (path[i] == '#' || here == 0xFF) {
      ++i;
      break;
    }
  }
  return i == 0 ? 0 : key << 8U * (places - i);
}

template <class Range, class Path>
std::vector<std::uint32_t> order_by_path(const Range& range, Path path) {
  struct Key {
    std::uint64_t beginning = 0;
    std::uint32_t index = 0;
  };
  std::vector<Key> keys;
  keys.reserve(range.size());
  for (const auto& one : range) {
    keys.push_back({beginning(path(one)), static_cast<std::uint32_t>(keys.size())});
  }
  std::stable_sort(keys.begin(), keys.end(), [&](const Key& a, const Key& b) {
    return a.beginning != b.beginning ? a.beginning < b.beginning
                                      : path_before(path(range[a.index]), path(range[b.index]));
  });
  std::vector<std::uint32_t> order(keys.size());
  std::ranges::transform(keys, order.begin(), &Key::index);
  return order;
}

class Finisher {
 public:
  Finisher(Graph& graph, std::vector<Slot>& slots, std::vector<Parameter>& parameters, OuterPlaces& places,
           Diagnostics& diagnostics)
      : graph_(graph), slots_(slots), parameters_(parameters), places_(places), diagnostics_(diagnostics) {}

  void run(const std::vector<std::uint32_t>& levels) {
    find_places(levels);
    for (Port& inner : graph_.inner) {
      if (inner.wire.from == Wire::From::Alias && slots_[inner.wire.index].span.length > 0) {
        inner.span = slots_[inner.wire.index].span;
      }
    }
    for_each_wire([&](Wire& wire) { wire = follow(wire); });
    sort_nodes();
    sort_parameters();
    settle_rates();
  }

 private:
  template <class Function>
  void for_each_wire(Function function) {
    std::ranges::for_each(graph_.wires, function);
    for (Port& output : graph_.outputs) {
      function(output.wire);
    }
    for (Port& inner : graph_.inner) {
      function(inner.wire);
    }
    for (NamedWire& named : graph_.named) {
      function(named.wire);
    }
  }

  /// What drives a wire. Every variable on the way remembers it: chains of variables are followed once.
  Wire follow(const Wire& wire) {
    Wire source = wire;
    for (std::size_t steps = 0; source.from == Wire::From::Alias; ++steps) {
      const Slot& slot = slots_[source.index];
      if (steps > slots_.size()) {
        diagnostics_.error(error::algebraic_loop, graph_.place(slot.span),
                           "variables are assigned to each other in a circle",
                           "Assign one of them from an input or from the output of an instance.");
        source = {};
        break;
      }
      source = slot.wire;
    }
    for (Wire passed = wire; passed.from == Wire::From::Alias;) {
      passed = std::exchange(slots_[passed.index].wire, source);
    }
    return source;
  }

  /// The outermost place of each wire: its own, or that of a variable on its way. While variables still name each
  /// other.
  void find_places(const std::vector<std::uint32_t>& levels) {
    outermost_.resize(slots_.size());
    places_.resize(graph_.wires.size());
    for (std::size_t i = 0; i < graph_.nodes.size(); ++i) {
      const Node& node = graph_.nodes[i];
      for (std::uint32_t pin = 0; pin < node.wire_count; ++pin) {
        const std::uint32_t wire = node.first_wire + pin;
        places_[wire] = outermost_of(graph_.wires[wire], {levels[i], graph_.wire_spans[wire]});
      }
    }
  }

  OuterPlace outermost_of(const Wire& wire, OuterPlace own) {
    way_.clear();
    OuterPlace rest{none, {}};
    for (Wire at = wire; at.from == Wire::From::Alias; at = slots_[at.index].wire) {
      if (outermost_[at.index] || way_.size() > slots_.size()) {
        rest = outermost_[at.index].value_or(rest);
        break;
      }
      way_.push_back(at.index);
    }
    for (; !way_.empty(); way_.pop_back()) {
      const Slot& slot = slots_[way_.back()];
      rest = slot.span.length > 0 && slot.level <= rest.level ? OuterPlace{slot.level, slot.span} : rest;
      outermost_[way_.back()] = rest;
    }
    return own.level <= rest.level ? own : rest;
  }

  void sort_nodes() {
    const auto order = order_by_path(graph_.nodes, [](const Node& node) -> const std::string& { return node.path; });
    std::vector<std::uint32_t> moved_to(order.size());
    std::vector<Node> nodes;
    std::vector<Wire> wires;
    std::vector<language::Span> spans;
    OuterPlaces places;
    nodes.reserve(order.size());
    wires.reserve(graph_.wires.size());
    spans.reserve(graph_.wires.size());
    places.reserve(graph_.wires.size());
    for (const std::uint32_t old : order) {
      moved_to[old] = static_cast<std::uint32_t>(nodes.size());
      Node& node = graph_.nodes[old];
      const auto first = static_cast<std::uint32_t>(wires.size());
      for (std::uint32_t pin = 0; pin < node.wire_count; ++pin) {
        wires.push_back(graph_.wires[node.first_wire + pin]);
        spans.push_back(graph_.wire_spans[node.first_wire + pin]);
        places.push_back(places_[node.first_wire + pin]);
      }
      node.first_wire = first;
      nodes.push_back(std::move(node));
    }
    graph_.nodes = std::move(nodes);
    graph_.wires = std::move(wires);
    for_each_wire([&](Wire& wire) {
      if (wire.from == Wire::From::Node) {
        wire.index = moved_to[wire.index];
      }
    });
    graph_.wire_spans = std::move(spans);
    places_ = std::move(places);
    canonical_literals();
  }

  // Literals in the order of the wires that use them, so that nothing remembers the order of the text. Constants keep
  // their units; a variable that stands for a plain number has nothing to be checked.
  void canonical_literals() {
    std::unordered_map<std::uint32_t, std::string> units;
    for (const Port& inner : graph_.inner) {
      if (inner.name.empty()) {
        units.emplace(inner.wire.index, inner.unit);
      }
    }
    std::erase_if(graph_.inner, [&](const Port& inner) {
      return inner.name.empty() ||
             (inner.wire.from == Wire::From::Literal && units.find(inner.wire.index) == units.end());
    });
    std::vector<double> literals;
    std::vector<Port> constants;
    for_each_wire([&](Wire& wire) {
      if (wire.from == Wire::From::Literal) {
        const std::uint32_t old = std::exchange(wire.index, static_cast<std::uint32_t>(literals.size()));
        literals.push_back(graph_.literals[old]);
        if (const auto unit = units.find(old); unit != units.end()) {
          constants.push_back({.unit = unit->second, .type = wire.type, .wire = wire});
        }
      }
    });
    graph_.literals = std::move(literals);
    std::ranges::move(constants, std::back_inserter(graph_.inner));
  }

  void sort_parameters() {
    // Parameters of one block keep the order of its description: they are met in the order of the pins.
    std::vector<std::uint32_t> order;
    std::vector<bool> taken(parameters_.size(), false);
    const auto take = [&](const Wire& wire) {
      if (wire.from == Wire::From::Parameter && !taken[wire.index]) {
        taken[wire.index] = true;
        order.push_back(wire.index);
      }
    };
    for (std::size_t i = 0; i < parameters_.size(); ++i) {
      if (parameters_[i].path.find('.') == std::string::npos) {
        take({Wire::From::Parameter, Type::Real, 0, static_cast<std::uint32_t>(i)});
      }
    }
    for_each_wire(take);
    std::vector<std::uint32_t> moved_to(parameters_.size());
    for (const std::uint32_t old : order) {
      moved_to[old] = static_cast<std::uint32_t>(graph_.parameters.size());
      graph_.parameters.push_back(std::move(parameters_[old]));
    }
    for_each_wire([&](Wire& wire) {
      if (wire.from == Wire::From::Parameter) {
        wire.index = moved_to[wire.index];
      }
    });
  }

  // --- rates ---

  /// The rate at which a wire changes; none for literals and parameters.
  std::optional<Rate> rate_of(const Wire& wire) {
    switch (wire.from) {
      case Wire::From::Input:
        return Rate{};
      case Wire::From::Node:
        settle_operation(wire.index);
        return constant_[wire.index] ? std::nullopt : std::optional(graph_.nodes[wire.index].rate);
      default:
        return std::nullopt;
    }
  }

  /// Gives an operation the rate of its operands, and before it those that are operations themselves. A chain of them
  /// may be as long as the diagram: hence a stack of our own.
  void settle_operation(std::uint32_t index) {
    std::vector<std::uint32_t> open{index};
    while (!open.empty()) {
      const std::uint32_t top = open.back();
      if (graph_.nodes[top].block != nullptr || settled_[top] == Settled::Yes) {
        open.pop_back();
        continue;
      }
      if (settled_[top] == Settled::Open) {
        settle_by_operands(top);
        settled_[top] = Settled::Yes;
        open.pop_back();
        continue;
      }
      settled_[top] = Settled::Open;  // set first: a loop of operations is reported by the scheduler
      for (std::uint32_t pin = 0; pin < graph_.nodes[top].wire_count; ++pin) {
        const Wire& wire = graph_.wires[graph_.nodes[top].first_wire + pin];
        if (wire.from == Wire::From::Node && settled_[wire.index] == Settled::No) {
          open.push_back(wire.index);
        }
      }
    }
  }

  void settle_by_operands(std::uint32_t index) {
    Node& node = graph_.nodes[index];
    std::optional<Rate> rate;
    for (std::uint32_t pin = 0; pin < node.wire_count; ++pin) {
      const Wire& wire = graph_.wires[node.first_wire + pin];
      std::optional<Rate> one;
      if (wire.from == Wire::From::Input) {
        one = Rate{};
      } else if (wire.from == Wire::From::Node && !constant_[wire.index]) {
        one = graph_.nodes[wire.index].rate;
      }
      if (one && rate && *one != *rate) {
        report(node.span, fmt::format("an expression mixes signals of two rates ({} and {})", steps_of(*rate, *one),
                                      steps_of(*one, *rate)));
      }
      rate = rate ? rate : one;
    }
    constant_[index] = !rate;
    node.rate = rate.value_or(Rate{});
  }

  /// `every step`, `every 4 steps`; beside a rate that differs by its phase alone, `every 4 steps from step 1`.
  static std::string steps_of(const Rate& rate, const Rate& other) {
    if (rate.every == other.every) {
      return fmt::format("every {} steps from step {}", rate.every, rate.phase);
    }
    return rate.every == 1 ? std::string("every step") : fmt::format("every {} steps", rate.every);
  }

  /// All rates repeat together after their least common multiple.
  bool check_common_period() {
    std::uint64_t period = 1;
    for (const Node& node : graph_.nodes) {
      period = std::lcm(period, std::uint64_t{node.rate.every});
      if (period > longest_common_period) {
        diagnostics_.error(error::rates_too_far_apart, graph_.place(node.span),
                           fmt::format("with {}, which runs every {} steps, the rates repeat together only every {} "
                                       "steps; a counter of steps holds {} at most",
                                       node.path, node.rate.every, period, longest_common_period),
                           "Choose rates that divide each other, such as 10, 100 and 1000.");
        return false;
      }
      if (graph_.sample_time_ns > std::numeric_limits<std::int64_t>::max() / std::int64_t{node.rate.every}) {
        diagnostics_.error(error::rates_too_far_apart, graph_.place(node.span),
                           fmt::format("{} would run every {} steps of {} s, which are more than 292 years", node.path,
                                       node.rate.every, graph_.sample_time()),
                           "Run it more often, or correct @ts.");
        return false;
      }
    }
    return true;
  }

  void settle_rates() {
    const bool one_rate = std::ranges::all_of(graph_.nodes, [](const Node& node) { return node.rate == Rate{}; });
    if (one_rate || !check_common_period()) {
      return;
    }
    settled_.assign(graph_.nodes.size(), Settled::No);
    constant_.assign(graph_.nodes.size(), false);
    for (std::uint32_t i = 0; i < graph_.nodes.size(); ++i) {
      const Node& node = graph_.nodes[i];
      if (node.block == nullptr) {
        settle_operation(i);
        continue;
      }
      if (node.block->about.rate_transition) {
        continue;
      }
      for (std::uint32_t pin = 0; pin < node.wire_count; ++pin) {
        const auto rate = rate_of(graph_.wires[node.first_wire + pin]);
        if (rate && *rate != node.rate) {
          report(graph_.wire_spans[node.first_wire + pin],
                 fmt::format("{} runs {}, its input {} changes {}", node.path, steps_of(node.rate, *rate),
                             node.block->pin(pin).name, steps_of(*rate, node.rate)));
        }
      }
    }
    for (const Port& output : graph_.outputs) {
      const auto rate = rate_of(output.wire);
      if (rate && *rate != Rate{}) {
        report(output.span, fmt::format("the output {} changes only every {} steps", output.name, rate->every));
      }
    }
  }

  void report(language::Span span, std::string cause) {
    diagnostics_.error(error::rate_mismatch, graph_.place(span), std::move(cause),
                       "Put a HY_SAMPLE (towards the slower part, with its @every) or a HY_HOLD (towards the faster "
                       "part) between them.");
  }

  Graph& graph_;
  std::vector<Slot>& slots_;
  std::vector<Parameter>& parameters_;
  OuterPlaces& places_;
  Diagnostics& diagnostics_;
  static constexpr auto none = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::optional<OuterPlace>> outermost_;  ///< by slot: of the way from it to what drives it
  std::vector<std::uint32_t> way_;
  enum class Settled : std::uint8_t { No, Open, Yes };
  std::vector<Settled> settled_;
  std::vector<bool> constant_;
};

}  // namespace

void finish(Graph& graph, std::vector<Slot>& slots, std::vector<Parameter>& parameters,
            const std::vector<std::uint32_t>& levels, OuterPlaces& places, Diagnostics& diagnostics) {
  Finisher(graph, slots, parameters, places, diagnostics).run(levels);
}

const Port* find_port(const std::vector<Port>& ports, std::string_view name) {
  const auto found =
      std::ranges::find_if(ports, [&](const Port& port) { return equal_ignoring_case(port.name, name); });
  return found == ports.end() ? nullptr : &*found;
}

std::int64_t find_parameter(const Graph& graph, std::string_view path) {
  const std::string wanted = language::upper(path);
  for (std::size_t i = 0; i < graph.parameters.size(); ++i) {
    if (graph.parameters[i].path == wanted) {
      return static_cast<std::int64_t>(i);
    }
  }
  return -1;
}

}  // namespace hysteron
