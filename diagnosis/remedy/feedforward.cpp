#include "diagnosis/remedy/feedforward.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "codegen/graph/names.hpp"
#include "diagnosis/remedy/inverse_blocks.hpp"
#include "support/numbers.hpp"
#include "tuning/simulation.hpp"

namespace hysteron::diagnosis {
namespace {

using Key = std::pair<std::uint32_t, std::uint16_t>;  ///< a node and its port

class Inverter {
 public:
  Inverter(const Program& program, std::uint32_t input, double sample_time)
      : graph_(program.graph), input_(input), text_(sample_time, program.graph) {}

  /// Walks from a wire to the input. Throws NoInverse.
  void walk(Wire wire) {
    std::string wanted = text_.reference();
    while (!is_input(wire)) {
      if (wire.from != Wire::From::Node) {
        throw NoInverse(fmt::format("the output does not depend on {} alone", graph_.inputs[input_].name));
      }
      const Node& node = graph_.nodes[wire.index];
      const std::size_t pin = open_pin(node);
      if (wire.port != 0 || !(node.rate == Rate{})) {
        throw NoInverse(fmt::format("{} is not a plain step of a chain", node.owner()));
      }
      const std::string wish = node.block != nullptr ? node.path : std::string("V");
      wanted = text_.signal(fmt::format("{}_OUT", wish), wanted);
      known_[{wire.index, wire.port}] = wanted;
      wanted = node.block != nullptr ? before_block(node, pin, wanted) : before_operation(node, pin, wanted);
      wire = graph_.wire(node, pin);
    }
    result_ = wanted;
  }

  [[nodiscard]] const InverseText& text() const { return text_; }
  [[nodiscard]] const std::string& result() const { return result_; }

 private:
  [[nodiscard]] bool is_input(const Wire& wire) const { return wire.from == Wire::From::Input && wire.index == input_; }

  /// Whether a signal is known when the chain has been walked down to here.
  [[nodiscard]] bool is_known(const Wire& wire) {
    if (wire.from != Wire::From::Node) {
      return !is_input(wire);
    }
    if (known_.contains({wire.index, wire.port})) {
      return true;
    }
    if (std::ranges::find(asked_, wire.index) != asked_.end()) {
      return false;  // a loop that does not pass through the chain
    }
    asked_.push_back(wire.index);
    const Node& node = graph_.nodes[wire.index];
    bool all = true;
    for (std::uint32_t pin = 0; pin < node.wire_count; ++pin) {
      all = all && is_known(graph_.wire(node, pin));
    }
    asked_.pop_back();
    return all;
  }

  /// The one pin whose signal is not known yet.
  [[nodiscard]] std::size_t open_pin(const Node& node) {
    std::vector<std::size_t> open;
    for (std::uint32_t pin = 0; pin < node.wire_count; ++pin) {
      if (!is_known(graph_.wire(node, pin))) {
        open.push_back(pin);
      }
    }
    if (open.size() != 1) {
      throw NoInverse(open.empty() ? fmt::format("{} does not depend on {}", node.owner(), graph_.inputs[input_].name)
                                   : fmt::format("{} takes {} signals that depend on {}: no series chain", node.owner(),
                                                 open.size(), graph_.inputs[input_].name));
    }
    return open.front();
  }

  /// The text of a known signal; empty for a pin that is not connected.
  std::string operand(const Wire& wire) {
    switch (wire.from) {
      case Wire::From::Literal: {
        const double value = graph_.literals[wire.index];
        const std::string literal = literal_text(wire.type, value);
        return value < 0.0 ? "(" + literal + ")" : literal;
      }
      case Wire::From::Parameter:
        return parameter(graph_.parameters[wire.index]);
      case Wire::From::Input:
        return other_input(graph_.inputs[wire.index]);
      case Wire::From::Node:
        return copied(wire);
      default:
        return {};
    }
  }

  std::string parameter(const Parameter& parameter) {
    const auto [place, is_new] = names_.try_emplace(parameter.path);
    if (is_new) {
      place->second = text_.name(parameter.path);
      const bool has_unit = !parameter.field.unit.empty() && parameter.field.unit.find('\'') == std::string_view::npos;
      text_.input(fmt::format("{} : {} := {}; (* @param{} *)", place->second, type_name(parameter.field.type),
                              literal_text(parameter.field.type, parameter.value.front()),
                              has_unit ? fmt::format(" @unit {}", parameter.field.unit) : ""));
    }
    return place->second;
  }

  std::string other_input(const Port& port) {
    text_.input(fmt::format("{} : {};{}", language::upper(port.name), type_name(port.type),
                            port.unit.empty() ? "" : fmt::format(" (* @unit {} *)", port.unit)));
    return language::upper(port.name);
  }

  /// A known signal of the plant: one of the chain, or a copy of what computes it.
  std::string copied(const Wire& wire) {
    const auto found = known_.find({wire.index, wire.port});
    if (found != known_.end()) {
      return found->second;
    }
    const Node& node = graph_.nodes[wire.index];
    if (node.block == nullptr) {
      return copied_operation(node, wire);
    }
    const auto [place, is_new] = copies_.try_emplace(wire.index);
    if (is_new) {
      const BlockStage stage = stage_of(node, node.block->inputs.size(), {});
      const std::string arguments = stage.arguments({});
      place->second = text_.instance(node.path, node.block->about.name, stage.settings());
      text_.call(place->second, arguments);
    }
    return fmt::format("{}.{}", place->second, node.block->outputs[wire.port].name);
  }

  std::string copied_operation(const Node& node, const Wire& wire) {
    const OperationInfo operation = info(node.op);
    const bool infix =
        node.op == Op::Add || node.op == Op::Subtract || node.op == Op::Multiply || node.op == Op::Divide;
    if (!infix && node.op != Op::Negate) {
      throw NoInverse(fmt::format("{} is computed by {}, which is not copied", node.owner(), operation.name));
    }
    const std::string left = operand(graph_.wire(node, 0));
    const std::string text =
        infix ? fmt::format("{} {} {}", left, operation.name, operand(graph_.wire(node, 1))) : "-" + left;
    std::string name = text_.signal("K", text);
    known_[{wire.index, wire.port}] = name;
    return name;
  }

  BlockStage stage_of(const Node& node, std::size_t pin, const std::string& wanted) {
    return {.graph = graph_,
            .node = node,
            .name = node.path,
            .pin = pin,
            .wanted = wanted,
            .operand = [this, &node](std::size_t index) { return operand(graph_.wire(node, index)); }};
  }

  std::string before_block(const Node& node, std::size_t pin, const std::string& wanted) {
    const std::string_view name = node.block->about.name;
    const std::string_view pin_name =
        pin < node.block->inputs.size() ? node.block->inputs[pin].name : std::string_view();
    if (name == "HY_SUM") {
      std::string rest = wanted;
      for (std::size_t other = 0; other < node.block->inputs.size(); ++other) {
        const std::string text = other == pin ? std::string() : operand(graph_.wire(node, other));
        rest += text.empty() ? "" : " - " + text;
      }
      return rest;
    }
    if (pin_name != "XIN") {
      throw NoInverse(fmt::format("{} depends on {} by more than its XIN", node.path, graph_.inputs[input_].name));
    }
    return inverse_of_block(text_, stage_of(node, pin, wanted));
  }

  std::string before_operation(const Node& node, std::size_t pin, const std::string& wanted) {
    const std::string other = node.wire_count == 2 ? operand(graph_.wire(node, 1 - pin)) : std::string();
    switch (node.op) {
      case Op::Add:
        return fmt::format("{} - {}", wanted, other);
      case Op::Subtract:
        return pin == 0 ? fmt::format("{} + {}", wanted, other) : fmt::format("{} - {}", other, wanted);
      case Op::Multiply:
        return fmt::format("{} / {}", wanted, other);
      case Op::Divide:
        return pin == 0 ? fmt::format("{} * {}", wanted, other) : fmt::format("{} / {}", other, wanted);
      case Op::Negate:
        return fmt::format("-{}", wanted);
      default:
        throw NoInverse(
            fmt::format("{} is computed by {}, which has no inverse here", node.owner(), info(node.op).name));
    }
  }

  const Graph& graph_;
  std::uint32_t input_;
  InverseText text_;
  std::map<Key, std::string> known_{};             ///< signals of the chain behind, and copies
  std::map<std::string, std::string> names_{};     ///< of parameters
  std::map<std::uint32_t, std::string> copies_{};  ///< instances of blocks beside the chain
  std::vector<std::uint32_t> asked_{};
  std::string result_{};
};

std::string unit_comment(const Port& port) {
  return port.unit.empty() ? std::string() : fmt::format("  (* @unit {} *)", port.unit);
}

/// The sample time in the largest unit that takes no fraction.
std::string duration_text(std::int64_t ns) {
  if (ns % 1'000'000 == 0) {
    return fmt::format("{}ms", ns / 1'000'000);
  }
  return ns % 1000 == 0 ? fmt::format("{}us", ns / 1000) : fmt::format("{}ns", ns);
}

std::string written(const Program& program, const Port& input, const Port& output, const Inverter& inverter) {
  const InverseText& text = inverter.text();
  std::string comment = fmt::format("The input {} of {} that makes its output {} follow {}.", input.name,
                                    program.graph.name, output.name, text.reference());
  for (const std::string& note : text.notes()) {
    comment += fmt::format("\n   - {}", note);
  }
  const std::int64_t ns = program.graph.sample_time_ns;
  std::string result = fmt::format("(* {} *)\nFUNCTION_BLOCK FEEDFORWARD{}\n  VAR_INPUT\n    {} : LREAL;{}\n", comment,
                                   ns > 0 ? fmt::format("  (* @ts {} *)", duration_text(ns)) : "", text.reference(),
                                   unit_comment(output));
  for (const std::string& one : text.inputs()) {
    result += "    " + one + "\n";
  }
  result += fmt::format("  END_VAR\n  VAR_OUTPUT\n    {} : LREAL;{}\n  END_VAR\n", input.name, unit_comment(input));
  if (!text.locals().empty()) {
    result += fmt::format("  VAR\n    {}\n  END_VAR\n", fmt::join(text.locals(), "\n    "));
  }
  for (const std::string& one : text.statements()) {
    result += "  " + one + "\n";
  }
  return result + fmt::format("  {} := {};\nEND_FUNCTION_BLOCK\n", input.name, inverter.result());
}

/// Three moving averages of about a four-hundredth of the record: a smooth curve that the machine has gone.
std::vector<double> smoothed(std::vector<double> values) {
  const auto half = static_cast<std::ptrdiff_t>(std::max<std::size_t>(1, values.size() / 800));
  const auto count = std::ssize(values);
  for (int pass = 0; pass < 3; ++pass) {
    std::vector<double> sums(values.size() + 1, 0.0);
    for (std::size_t k = 0; k < values.size(); ++k) {
      sums[k + 1] = sums[k] + values[k];
    }
    for (std::ptrdiff_t k = 0; k < count; ++k) {
      const std::ptrdiff_t reach = std::min({half, k, count - 1 - k});
      const double sum = sums[static_cast<std::size_t>(k + reach + 1)] - sums[static_cast<std::size_t>(k - reach)];
      values[static_cast<std::size_t>(k)] = sum / static_cast<double>(2 * reach + 1);
    }
  }
  return values;
}

/// RMS of the plant's output less the reference; nothing where it is not finite.
std::optional<double> tracking_error(const Feedforward& feedforward, const Program& plant, std::string_view input,
                                     std::string_view output, const records::Record& record,
                                     const std::vector<double>& reference) {
  const double ts = record.sample_time();
  const auto ahead = static_cast<std::size_t>(std::lround(feedforward.preview / ts));
  records::Record given = records::Record::even(record.time().front(), ts, record.size());
  records::Record driven = given;
  std::vector<double> early(reference.size());
  for (std::size_t k = 0; k < early.size(); ++k) {
    early[k] = reference[std::min(k + ahead, reference.size() - 1)];
  }
  given.add({.name = feedforward.reference, .unit = {}, .values = std::move(early)});
  for (const records::Column& column : record.columns()) {
    if (!language::same_name(column.name, feedforward.reference)) {
      given.add(column);
    }
    if (!language::same_name(column.name, input)) {
      driven.add(column);
    }
  }
  driven.add(
      {.name = std::string(input), .unit = {}, .values = simulate(compile_text(feedforward.text), given).front()});
  const std::vector<Signal> outputs = simulate(plant, driven);
  const auto which = static_cast<std::size_t>(find_port(plant.graph.outputs, output) - plant.graph.outputs.data());
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t k = reference.size() / 10; k + ahead < reference.size(); ++k, ++count) {
    sum += std::pow(outputs[which][k] - reference[k], 2);
  }
  const double rms = std::sqrt(sum / static_cast<double>(std::max<std::size_t>(1, count)));
  return std::isfinite(rms) ? std::optional(rms) : std::nullopt;
}

}  // namespace

Feedforward feedforward_of(const Program& program, std::string_view input, std::string_view output,
                           double sample_time) {
  Feedforward result;
  const Port* const from = find_port(program.graph.inputs, input);
  const Port* const to = find_port(program.graph.outputs, output);
  if (from == nullptr || to == nullptr || from->type != Type::Real || to->wire.type != Type::Real) {
    result.reason = fmt::format("the diagram has no real input {} and real output {}", input, output);
    return result;
  }
  const double ts = program.graph.sample_time_ns > 0 ? program.graph.sample_time() : sample_time;
  try {
    Inverter inverter(program, static_cast<std::uint32_t>(from - program.graph.inputs.data()), ts);
    inverter.walk(to->wire);
    Diagnostics diagnostics;
    std::string text =
        format_text("feedforward.st", written(program, *from, *to, inverter), diagnostics, {.any_order = true});
    (void)compile_text(text);
    result.text = std::move(text);
    result.notes = inverter.text().notes();
    result.reference = inverter.text().reference();
    result.preview = inverter.text().preview();
  } catch (const NoInverse& none) {
    result.reason = none.what();
  } catch (const InputError& error) {
    result.reason = fmt::format("the inverse does not compile: {}", error.what());
  }
  return result;
}

std::optional<Tracking> predicted_tracking(const Program& nominal, const Program& improved, std::string_view input,
                                           std::string_view output, const records::Record& record) {
  const records::Column* const measured = record.find(output);
  if (measured == nullptr || record.size() < 100) {
    return std::nullopt;
  }
  const std::vector<double> reference = smoothed(measured->values);
  const auto error_of = [&](const Program& inverted) -> std::optional<double> {
    const Feedforward feedforward = feedforward_of(inverted, input, output, record.sample_time());
    if (feedforward.text.empty()) {
      return std::nullopt;
    }
    return tracking_error(feedforward, improved, input, output, record, reference);
  };
  const std::optional<double> before = error_of(nominal);
  const std::optional<double> after = error_of(improved);
  return before && after ? std::optional(Tracking{.nominal = *before, .improved = *after}) : std::nullopt;
}

}  // namespace hysteron::diagnosis
