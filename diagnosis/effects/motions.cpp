#include "diagnosis/effects/motions.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "codegen/graph/unit.hpp"

namespace hysteron::diagnosis {
namespace {

/// Whether a block is a linear one that gives the rate of its output beside it, of which of its outputs that is, and of
/// how many states it is: 1 for a lag, 2 for a mass on a spring. The input one sample ago is no state of its own.
struct Smoothing {
  int order = 0;
  std::size_t rate = 0;
};
Smoothing smoothing_of(const Node& node) {
  if (node.block == nullptr || node.block->about.group != Group::Dynamics) {
    return {};
  }
  const auto& outputs = node.block->outputs;
  const auto rate = std::ranges::find(outputs, FieldRole::Rate, &Field::role);
  if (rate == outputs.end()) {
    return {};
  }
  const auto order = std::ranges::count_if(node.block->states, [](const Field& state) {
    return state.type == Type::Real && state.role != FieldRole::PastInput;
  });
  return {.order = static_cast<int>(order), .rate = static_cast<std::size_t>(rate - outputs.begin())};
}

/// How often a block integrates its input on the way to one of its outputs: +1 for an integrator and for a lag, whose
/// output follows its input as a speed follows a force, 2 for a mass on a spring, one less for the rates of these; −1
/// for a block that gives the rate of change of its input, by the units of its description.
int integrals_of(const Node& node, std::size_t output = 0) {
  if (const Smoothing smoothing = smoothing_of(node); smoothing.order > 0) {
    return output == smoothing.rate ? smoothing.order - 1 : smoothing.order;
  }
  if (node.block == nullptr || node.block->inputs.empty() || node.block->inputs.front().unit != "'x") {
    return 0;
  }
  const std::string_view unit = node.block->outputs.front().unit;
  return unit == "'x*s" ? 1 : unit == "'x/s" ? -1 : 0;
}

/// The fewest integrals on a way from a node's output to a signal that depends on it, rates taken off.
int integrals_between(const Graph& graph, std::uint32_t node, const Wire& signal) {
  constexpr int far = 1000;
  std::vector<int> before(graph.nodes.size(), far);  // what drives a node: the fewest on a way to it
  const auto behind = [&](const Wire& wire) {
    if (wire.from != Wire::From::Node) {
      return far;
    }
    if (wire.index == node) {
      return 0;
    }
    return before[wire.index] == far
               ? far
               : std::max(0, before[wire.index] + integrals_of(graph.nodes[wire.index], wire.port));
  };
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t i = 0; i < graph.nodes.size(); ++i) {
      for (std::size_t pin = 0; i != node && pin < graph.nodes[i].wire_count; ++pin) {
        const int here = behind(graph.wire(graph.nodes[i], pin));
        if (here < before[i]) {
          before[i] = here;
          changed = true;
        }
      }
    }
  }
  return behind(signal);
}

/// The powers of metre and second of a unit that is known.
struct Motion {
  bool is_other = false;  ///< there is another base unit
  units::Fraction length{};
  units::Fraction time{};
};
std::optional<Motion> motion_of(std::string_view text) {
  constexpr std::size_t metres = 0;
  constexpr std::size_t seconds = 2;
  std::string reason;
  const auto unit = text.empty() ? std::nullopt : units::parse_unit(text, reason);
  if (!unit) {
    return std::nullopt;
  }
  Motion result{.length = unit->powers[metres], .time = unit->powers[seconds]};
  for (std::size_t i = 0; i < units::dimensions; ++i) {
    result.is_other = result.is_other || (i != metres && i != seconds && !unit->powers[i].zero());
  }
  return result;
}

/// Integrates once, and smooths nothing.
bool is_integrator(const Node& node) {
  return smoothing_of(node).order == 0 && integrals_of(node) == 1;
}

/// A length or an angle, by its power of metres.
bool is_travel(const units::Fraction& length) {
  return length.zero() || length.number() == 1.0;
}

}  // namespace

bool is_no_velocity(std::string_view unit) {
  const std::optional<Motion> motion = motion_of(unit);
  const bool is_number = motion && !motion->is_other && motion->length.zero() && motion->time.zero();
  return motion && !is_number && (motion->is_other || motion->time.number() != -1.0 || !is_travel(motion->length));
}

bool is_no_position(std::string_view unit) {
  const std::optional<Motion> motion = motion_of(unit);
  return motion && (motion->is_other || !motion->time.zero() || !is_travel(motion->length));
}

bool may_be_velocity(const Node* node, std::size_t output) {
  if (node == nullptr || output == 0) {
    return true;
  }
  const Smoothing smoothing = smoothing_of(*node);
  return smoothing.order > 1 && output == smoothing.rate;
}

bool is_velocity(const Graph& graph, const Wire& driver, const Wire& changed, const Wire& input) {
  if (integrals_between(graph, changed.index, driver) > 1 || input == driver) {
    return false;
  }
  return input.from != Wire::From::Node || integrals_of(graph.nodes[input.index]) != 1 ||
         graph.wire(graph.nodes[input.index], 0) != driver;
}

bool is_integral(const Graph& graph, const Wire& signal) {
  if (signal.from != Wire::From::Node || signal.port != 0) {
    return false;
  }
  return is_integrator(graph.nodes[signal.index]);
}

Wire without_gains(const Graph& graph, Wire signal) {
  const auto is_constant = [](const Wire& wire) {
    return wire.from == Wire::From::Literal || wire.from == Wire::From::Parameter;
  };
  while (signal.from == Wire::From::Node) {
    const Node& node = graph.nodes[signal.index];
    const Wire& first = graph.wire(node, 0);
    const bool is_operation = node.block == nullptr;
    const bool is_product = is_operation && node.op == Op::Multiply;
    const bool is_scaled = (is_product || (is_operation && node.op == Op::Divide)) && is_constant(graph.wire(node, 1));
    if (is_product && is_constant(first)) {
      signal = graph.wire(node, 1);
    } else if (is_scaled || (is_operation && node.op == Op::Negate) ||
               (!is_operation && node.block->about.name == "HY_GAIN")) {
      signal = first;
    } else {
      break;
    }
  }
  return signal;
}

const Port* followed_input(const Graph& graph, const Wire& signal) {
  Wire wire = without_gains(graph, signal);
  for (std::size_t passed = 0; wire.from == Wire::From::Node && passed < graph.nodes.size(); ++passed) {
    const Node& node = graph.nodes[wire.index];
    bool is_alone = integrals_of(node, wire.port) < 0 || smoothing_of(node).order > 0;
    for (std::size_t pin = 1; pin < node.wire_count; ++pin) {
      const Wire& other = graph.wire(node, pin);  // that it runs, as a rule
      is_alone = is_alone && other.from != Wire::From::Node && other.from != Wire::From::Input;
    }
    if (!is_alone) {
      return nullptr;
    }
    wire = without_gains(graph, graph.wire(node, 0));
  }
  return wire.from == Wire::From::Input ? &graph.inputs[wire.index] : nullptr;
}

bool leads_to_rates(const Graph& graph, std::string_view path) {
  bool is_read = false;
  for (const Node& reader : graph.nodes) {
    for (std::size_t pin = 0; pin < reader.wire_count; ++pin) {
      const Wire& wire = graph.wire(reader, pin);
      if (wire.from == Wire::From::Node && graph.nodes[wire.index].path == path) {
        is_read = true;
        if (integrals_of(reader) >= 0) {
          return false;
        }
      }
    }
  }
  return is_read;
}

bool is_balance(const Graph& graph, const Wire& signal, const std::string& passed_on_by) {
  if (signal.from != Wire::From::Node) {
    return false;
  }
  const Node& source = graph.nodes[signal.index];
  const bool is_sum = source.block == nullptr ? source.op == Op::Add || source.op == Op::Subtract
                                              : source.block->about.name == "HY_SUM";
  return is_sum && std::ranges::any_of(graph.nodes, [&](const Node& node) {
           if (node.block == nullptr || !is_integrator(node)) {
             return false;
           }
           const Wire& wire = graph.wire(node, 0);
           return wire.from == Wire::From::Node && graph.nodes[wire.index].path == passed_on_by;
         });
}

std::vector<std::size_t> steps_behind(const Graph& graph, const std::vector<std::uint32_t>& nodes) {
  std::vector<std::size_t> result(graph.nodes.size(), unconnected);
  std::vector<std::uint32_t> front = nodes;
  for (const std::uint32_t node : nodes) {
    result[node] = 0;
  }
  for (std::size_t step = 1; !front.empty(); ++step) {
    std::vector<std::uint32_t> next;
    for (std::uint32_t i = 0; i < graph.nodes.size(); ++i) {
      for (std::size_t pin = 0; result[i] == unconnected && pin < graph.nodes[i].wire_count; ++pin) {
        const Wire& wire = graph.wire(graph.nodes[i], pin);
        if (wire.from == Wire::From::Node && std::ranges::find(front, wire.index) != front.end()) {
          result[i] = step;
          next.push_back(i);
        }
      }
    }
    front = std::move(next);
  }
  return result;
}

}  // namespace hysteron::diagnosis
