// The graph of an axis, asked for numbers, pins and units. Internal to joint.cpp.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "codegen/compile.hpp"
#include "codegen/graph/units.hpp"
#include "support/errors.hpp"

namespace hysteron::robots {

[[noreturn]] inline void refuse(std::string cause, std::string mend, const Place& place = {}) {
  throw InputError(error::bad_usage, place, std::move(cause), std::move(mend));
}

inline std::string short_text(double number) {
  return fmt::format("{:.4g}", number);
}
inline std::string unit_behind(const std::string& unit) {
  return unit.empty() ? "" : " " + unit;
}

class AxisGraph {
 public:
  /// The program outlives it.
  explicit AxisGraph(const Program& program)
      : graph_(program.graph), outputs_(units::Solution(program.graph, program.schedule).outputs()) {}

  [[nodiscard]] static std::string_view name_of(const Node& node) {
    return node.block == nullptr ? std::string_view() : node.block->about.name;
  }

  [[nodiscard]] Wire input_wire(const Node& node, std::string_view pin) const {
    for (std::size_t i = 0; i < node.block->inputs.size(); ++i) {
      if (node.block->inputs[i].name == pin) {
        return graph_.wire(node, i);
      }
    }
    return {};
  }

  /// A number that stands in the run: literals, parameters, and what is made of these.
  [[nodiscard]] std::optional<double> constant_of(const Wire& wire) const {
    if (wire.from == Wire::From::Literal) {
      return graph_.literals[wire.index];
    }
    if (wire.from == Wire::From::Parameter) {
      return graph_.parameters[wire.index].value.front();
    }
    if (wire.from != Wire::From::Node || graph_.nodes[wire.index].block != nullptr) {
      return std::nullopt;
    }
    const Node& node = graph_.nodes[wire.index];
    const auto a = constant_of(graph_.wire(node, 0));
    const auto b = node.wire_count > 1 ? constant_of(graph_.wire(node, 1)) : std::optional(0.0);
    if (!a || !b) {
      return std::nullopt;
    }
    switch (node.op) {
      case Op::Add:
        return *a + *b;
      case Op::Subtract:
        return *a - *b;
      case Op::Multiply:
        return *a * *b;
      case Op::Divide:
        return *a / *b;
      case Op::Negate:
        return -*a;
      default:
        return std::nullopt;
    }
  }

  [[nodiscard]] double parameter(const Node& node, std::string_view name) const {
    for (std::size_t i = 0; i < node.block->params.size(); ++i) {
      if (node.block->params[i].name == name) {
        const Wire& wire = graph_.wire(node, node.block->inputs.size() + i);
        const auto value =
            wire.from == Wire::From::Nothing ? std::optional(node.block->params[i].preset) : constant_of(wire);
        if (value) {
          return *value;
        }
        refuse(fmt::format("{}.{} is a signal, and a joint has constant numbers.", node.path, name),
               "give it a number.", graph_.place(node.span));
      }
    }
    return 0.0;
  }

  [[nodiscard]] std::string unit_of(const Wire& wire) const {
    if (wire.from == Wire::From::Input) {
      return graph_.inputs[wire.index].unit;
    }
    if (wire.from == Wire::From::Node && !outputs_[wire.index].empty() && !outputs_[wire.index][wire.port].empty()) {
      return outputs_[wire.index][wire.port];
    }
    for (const auto* const ports : {&graph_.inner, &graph_.outputs}) {
      const auto found =
          std::ranges::find_if(*ports, [&](const Port& port) { return port.wire == wire && !port.unit.empty(); });
      if (found != ports->end()) {
        return found->unit;
      }
    }
    return {};
  }

  [[nodiscard]] static std::optional<double> factor(const std::string& unit, const char* to) {
    double found = 0.0;
    return !unit.empty() && units::conversion(unit, to, found) ? std::optional(found) : std::nullopt;
  }

  [[nodiscard]] std::string numbers_of(const Node& node) const {
    std::vector<std::string> numbers;
    for (const Field& field : node.block->params) {
      if (field.length == 1) {
        numbers.push_back(fmt::format("{} = {}", field.name, short_text(parameter(node, field.name))));
      }
    }
    return numbers.empty() ? "none" : fmt::format("{}", fmt::join(numbers, ", "));
  }

 protected:
  const Graph& graph_;

 private:
  std::vector<std::vector<std::string>> outputs_;
};

}  // namespace hysteron::robots
