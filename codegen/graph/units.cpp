#include "codegen/graph/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <unordered_map>
#include <vector>

#include "codegen/graph/names.hpp"
#include "codegen/graph/unit.hpp"
#include "codegen/graph/unit_of_operation.hpp"
#include "codegen/graph/unit_solver.hpp"
#include "support/errors.hpp"
#include "support/numbers.hpp"

namespace hysteron::units {
namespace {

/// Nothing is concluded from an equation with more unknowns than this.
constexpr std::size_t most_unknowns = 32;

/// A factor as it is to be written: all digits, but those of rounding alone (1000.0000000000001 is 1000).
std::string factor_text(double factor) {
  const double round = parse_number(fmt::format("{:.12g}", factor)).value;
  return number_text(std::abs(round / factor - 1.0) < 1e-15 ? round : factor);
}

/// The units of all wires, found by unification: unit variables are solved as wires are met.
class Checker {
 public:
  Checker(const Graph& graph, Diagnostics& diagnostics) : graph_(graph), diagnostics_(diagnostics) {}

  void run(const Schedule& schedule) {
    for (const Port& inner : graph_.inner) {
      if (inner.name.empty()) {
        constants_.emplace(inner.wire.index, inner.unit);
      }
    }
    first_output_.reserve(graph_.nodes.size());
    std::size_t outputs = 0;
    for (const Node& node : graph_.nodes) {
      first_output_.push_back(static_cast<std::uint32_t>(outputs));
      outputs += node.block == nullptr ? 1 : node.block->outputs.size();
    }
    outputs_.resize(outputs);
    prepared_.assign(graph_.nodes.size(), false);
    first_variable_.assign(graph_.nodes.size(), none);
    for (const Action& action : schedule.actions) {
      if (action.kind != Action::Kind::Update && !prepared_[action.node]) {
        prepare(action.node);
      }
    }
    for (std::uint32_t index = 0; index < graph_.nodes.size(); ++index) {
      if (graph_.nodes[index].block != nullptr) {
        connect(index);
      }
    }
    for (const Port& inner : graph_.inner) {  // of a constant, with itself
      agree(of_wire(inner.wire), declared(inner.unit), inner.span, {inner.wire}, [&] { return inner.name; });
    }
    for (const Port& output : graph_.outputs) {
      agree(of_wire(output.wire), declared(output.unit), output.span, {output.wire}, [&] { return output.name; });
    }
    for (const Mismatch& one : mismatches_) {
      report(one);
    }
  }

  /// The unit of each parameter, after run(): empty where it is not known.
  std::vector<std::string> parameter_units() {
    std::vector<std::string> texts;
    for (const Parameter& parameter : graph_.parameters) {
      texts.emplace_back(parameter.field.unit.find('\'') == std::string_view::npos ? parameter.field.unit
                                                                                   : std::string_view{});
    }
    for (std::uint32_t index = 0; index < graph_.nodes.size(); ++index) {
      const Node& node = graph_.nodes[index];
      for (std::uint32_t pin = 0; node.block != nullptr && pin < node.wire_count; ++pin) {
        const Wire& wire = graph_.wire(node, pin);
        if (wire.from == Wire::From::Parameter && texts[wire.index].empty()) {
          texts[wire.index] = text_of_field(index, node.block->pin(pin));
        }
      }
    }
    return texts;
  }

  /// The units of some fields of each node, such as its outputs, after run().
  template <class Fields>
  std::vector<std::vector<std::string>> field_units(Fields BlockType::*fields) {
    std::vector<std::vector<std::string>> texts(graph_.nodes.size());
    for (std::uint32_t index = 0; index < graph_.nodes.size(); ++index) {
      if (const BlockType* const block = graph_.nodes[index].block) {
        for (const Field& field : block->*fields) {
          texts[index].push_back(field.type == Type::Real ? text_of_field(index, field) : std::string());
        }
      }
    }
    return texts;
  }

 private:
  static constexpr auto none = std::numeric_limits<std::uint32_t>::max();

  const MaybeUnit& known(std::string_view text) {
    if (text.empty()) {
      return nothing_;
    }
    const auto [place, is_new] = known_.try_emplace(text);
    if (is_new) {
      std::string reason;
      place->second = parse_unit(text, reason);
    }
    return place->second;
  }

  /// A unit that the text states.
  const MaybeUnit& declared(std::string_view text) {
    if (text.empty()) {
      return nothing_;
    }
    const auto [place, is_new] = declared_.try_emplace(text);
    if (is_new) {
      place->second = known(text);
      if (place->second) {
        place->second->declared = true;
      }
    }
    return place->second;
  }

  /// Gives a node's outputs their units; a block's pins are connected in a second pass, when all variables exist.
  void prepare(std::uint32_t index) {
    prepared_[index] = true;
    const Node& node = graph_.nodes[index];
    if (node.block == nullptr) {
      outputs_[first_output_[index]] = operation(node);
      return;
    }
    for (std::size_t port = 0; port < node.block->outputs.size(); ++port) {
      outputs_[first_output_[index] + port] = of_field(index, node.block->outputs[port]);
    }
    // Inputs known by now give the variables their units, so that what follows is checked against them.
    connect_pins(index, true);
  }

  void connect(std::uint32_t index) {
    if (!prepared_[index]) {
      prepare(index);
    }
    connect_pins(index, false);
  }

  void connect_pins(std::uint32_t index, bool quietly) {
    const Node& node = graph_.nodes[index];
    for (std::uint32_t pin = 0; pin < node.wire_count; ++pin) {
      const Field& field = node.block->pin(pin);
      const Wire& wire = graph_.wire(node, pin);
      if (field.unit.empty() || field.type != Type::Real || (wire.from == Wire::From::Node && !prepared_[wire.index])) {
        continue;
      }
      const MaybeUnit expected = of_field(index, field);
      const MaybeUnit& given = of_wire(wire);
      if (!given || !expected) {
        continue;
      }
      const Unit quotient = solver_.ratio(*given, *expected);
      if (quietly && quotient.variables.empty() && !is_one(quotient)) {
        continue;  // reported in the second pass
      }
      settle(quotient, *given, *expected, graph_.wire_spans[node.first_wire + pin], {wire},
             [&] { return fmt::format("{}.{}", node.path, field.name); });
    }
  }

  MaybeUnit of_field(std::uint32_t index, const Field& field) {
    if (field.unit.empty() || field.type != Type::Real) {
      return std::nullopt;
    }
    if (field.unit.find('\'') == std::string_view::npos) {
      return known(field.unit);
    }
    const BlockUnits& units = units_of(index);
    MaybeUnit unit = units.by_text.find(field.unit)->second;
    if (unit) {
      for (auto& [variable, power] : unit->variables) {
        variable += first_variable(index);
      }
    }
    return unit;
  }

  /// The units of a block that name its unit variables: read once, the variables numbered from 0.
  struct BlockUnits {
    std::vector<std::string_view> variables{};
    std::map<std::string_view, MaybeUnit> by_text{};
  };

  const BlockUnits& units_of(std::uint32_t index) {
    const BlockType& block = *graph_.nodes[index].block;
    const auto [place, is_new] = blocks_.try_emplace(&block);
    if (is_new) {
      for (const auto& fields : {block.outputs, block.inputs, block.params, block.states}) {
        for (const Field& field : fields) {
          read_unit(field.unit, place->second);
        }
      }
    }
    return place->second;
  }

  static void read_unit(std::string_view text, BlockUnits& units) {
    const auto number = [&](std::string_view name) {
      const auto known_name = std::ranges::find(units.variables, name);
      const auto result = static_cast<std::uint32_t>(known_name - units.variables.begin());
      if (known_name == units.variables.end()) {
        units.variables.push_back(name);
      }
      return result;
    };
    for (auto quote = text.find('\''); quote != std::string_view::npos; quote = text.find('\'', quote + 1)) {
      const std::string_view rest = text.substr(quote + 1);
      number(rest.substr(0, rest.find_first_of("*/^() ")));  // also where the text is beyond parse_unit
    }
    std::string reason;
    units.by_text.emplace(text, parse_unit(text, reason, number));
  }

  std::uint32_t first_variable(std::uint32_t index) {
    if (first_variable_[index] == none) {
      first_variable_[index] = solver_.add(units_of(index).variables.size());
    }
    return first_variable_[index];
  }

  /// The unit of a field as text; empty where the wires do not give it. An exponent that is a parameter, as in
  /// 'y/'x^(1+C3), is beyond the check, but not beyond this text: um/V^(1+C3).
  std::string text_of_field(std::uint32_t index, const Field& field) {
    if (const MaybeUnit unit = of_field(index, field)) {
      const Unit all = solver_.solved(*unit);
      return all.variables.empty() ? unit_text(all) : std::string();
    }
    std::string text;
    for (std::size_t at = 0; at < field.unit.size();) {
      if (field.unit[at] != '\'') {
        text += field.unit[at++];
        continue;
      }
      const std::size_t end = std::min(field.unit.find_first_of("*/^() ", at), field.unit.size());
      const Unit unit = solver_.solved(unit_of_variable(variable_of(index, field.unit.substr(at + 1, end - at - 1))));
      if (!unit.variables.empty()) {
        return {};
      }
      const std::string one = unit_text(unit);
      text += one.find_first_of("*/^") == std::string::npos ? one : "(" + one + ")";
      at = end;
    }
    return text;
  }

  static Unit unit_of_variable(std::uint32_t variable) {
    Unit unit;
    unit.add_variable(variable, {1, 1});
    return unit;
  }

  std::uint32_t variable_of(std::uint32_t index, std::string_view name) {
    const auto& names = units_of(index).variables;
    return first_variable(index) + static_cast<std::uint32_t>(std::ranges::find(names, name) - names.begin());
  }

  const MaybeUnit& of_wire(const Wire& wire) {
    switch (wire.from) {
      case Wire::From::Input:
        return declared(graph_.inputs[wire.index].unit);
      case Wire::From::Parameter:
        return of_parameter(graph_.parameters[wire.index]);
      case Wire::From::Node:
        return outputs_[first_output_[wire.index] + wire.port];
      case Wire::From::Literal:
        return declared(literal_unit(wire));
      default:
        return nothing_;
    }
  }

  /// What a block says of its own parameter by a unit variable, the text cannot state.
  const MaybeUnit& of_parameter(const Parameter& parameter) {
    const bool is_of_block = parameter.path.find('.') != std::string::npos;
    const bool is_variable = parameter.field.unit.find('\'') != std::string_view::npos;
    return is_of_block && is_variable ? nothing_ : declared(parameter.field.unit);
  }

  /// The unit of an expression. A literal takes the unit of what it is added to, and counts as a number in products.
  MaybeUnit operation(const Node& node) {
    std::array<MaybeUnit, 3> operands;
    std::optional<double> exponent;
    for (std::uint32_t pin = 0; pin < node.wire_count; ++pin) {
      const Wire& wire = graph_.wire(node, pin);
      operands.at(pin) = is_number(wire) && is_product(node) ? MaybeUnit(Unit{}) : of_wire(wire);
      if (node.op == Op::Power && pin == 1 && wire.from == Wire::From::Literal) {
        exponent = graph_.literals[wire.index];
      }
    }
    MaybeUnit result = unit_of_operation(
        node.op, {operands.data(), node.wire_count}, exponent, [&](const MaybeUnit& given, const MaybeUnit& expected) {
          const std::uint32_t first = node.op == Op::Select ? 1 : 0;
          const Wire& left = graph_.wire(node, first);
          const Wire& right = graph_.wire(node, std::min(first + 1, node.wire_count - 1));
          agree(given, expected, node.span, {right, left}, [&] {
            return node.wire_count == 1 ? fmt::format("the argument of {}", info(node.op).name)
                                        : std::string("the two sides");
          });
        });
    return result && result->variables.size() > most_unknowns ? std::nullopt : result;
  }

  static bool is_product(const Node& node) { return node.op == Op::Multiply || node.op == Op::Divide; }

  /// Of a constant; empty for a plain number.
  [[nodiscard]] std::string_view literal_unit(const Wire& wire) const {
    const auto found = constants_.find(wire.index);
    return found == constants_.end() ? std::string_view() : found->second;
  }

  /// A literal without a unit.
  [[nodiscard]] bool is_number(const Wire& wire) const {
    return wire.from == Wire::From::Literal && wire.type == Type::Real && literal_unit(wire).empty();
  }

  static bool is_one(const Unit& unit) { return same_size(units::conversion(unit, Unit{}).value_or(0.0), 1.0); }

  /// The wires of two units: that of the given one, and that of the expected one, where there is one.
  struct Sides {
    Wire given{};
    Wire expected{};
  };

  /// Two units that differ, and where.
  struct Mismatch {
    Unit given;
    Unit expected;
    language::Span span;
    Sides sides;
    std::string where;
  };

  /// Takes it that two units are the same, or notes that they differ. `where` names the place; it is asked only then.
  template <class Where>
  void agree(const MaybeUnit& given, const MaybeUnit& expected, language::Span span, Sides sides, Where where) {
    if (!given || !expected) {
      return;
    }
    settle(solver_.ratio(*given, *expected), *given, *expected, span, sides, where);
  }

  /// The same of their ratio.
  template <class Where>
  void settle(const Unit& quotient, const Unit& given, const Unit& expected, language::Span span, Sides sides,
              Where where) {
    if (quotient.variables.empty()) {
      if (!is_one(quotient)) {
        mismatches_.push_back({given, expected, span, sides, where()});
      }
    } else if (quotient.variables.size() <= most_unknowns) {
      solver_.solve(quotient);
    }
  }

  void report(const Mismatch& found) {
    const Unit given = solver_.solved(found.given);
    const Unit expected = solver_.solved(found.expected);
    // The descriptions of blocks alone, as in the loop U - I.XOUT over an integral, refuse nothing: a gain of 1/s that
    // the text does not write is no fault where no unit is written either.
    if (!given.declared && !expected.declared) {
      return;
    }
    diagnostics_.error(
        error::unit_mismatch, graph_.place(found.span),
        fmt::format("{}: the unit is {}, {} is expected", found.where, unit_text(given), unit_text(expected)),
        mend(found.sides, given, expected));
  }

  std::string mend(const Sides& sides, const Unit& given, const Unit& expected) {
    Unit quotient = given;
    quotient.multiply(expected, {-1, 1});
    std::string text = "Correct an @unit, or connect a signal of the expected unit.";
    if (const auto factor = units::conversion(given, expected)) {
      text = fmt::format(
          "The two differ by the factor {0}: put a HY_GAIN with K = {0} between them, whose output carries the other "
          "unit.",
          factor_text(*factor));
    }
    for (const bool is_given : {true, false}) {
      double number = 0.0;
      bool divides = false;
      if (find_number(is_given ? sides.given : sides.expected, number, divides)) {
        Unit unit;
        unit.multiply(quotient, {is_given == divides ? 1 : -1, 1});
        return text + fmt::format(
                          " If {} is a quantity and no mere number, say so, and write the name for it: "
                          "VAR CONSTANT K : LREAL := {}; (* @unit {} *) END_VAR.",
                          number_text(number), literal_text(Type::Real, number), unit_text(unit));
      }
    }
    return text;
  }

  /// The number by which an expression is multiplied or divided.
  bool find_number(const Wire& wire, double& number, bool& divides) const {
    if (wire.from != Wire::From::Node || graph_.nodes[wire.index].block != nullptr) {
      return false;
    }
    const Node& node = graph_.nodes[wire.index];
    for (std::uint32_t pin = 0; is_product(node) && pin < node.wire_count; ++pin) {
      if (is_number(graph_.wire(node, pin))) {
        number = graph_.literals[graph_.wire(node, pin).index];
        divides = node.op == Op::Divide && pin == 1;
        return true;
      }
    }
    return node.op == Op::Negate && find_number(graph_.wire(node, 0), number, divides);
  }

  const Graph& graph_;
  Diagnostics& diagnostics_;
  const MaybeUnit nothing_;
  std::map<std::string_view, MaybeUnit> known_;     ///< by text
  std::map<std::string_view, MaybeUnit> declared_;  ///< the same, as the text states them
  std::vector<MaybeUnit> outputs_;                  ///< of all nodes, one behind the other
  std::vector<std::uint32_t> first_output_;         ///< by node
  std::vector<bool> prepared_;
  std::unordered_map<std::uint32_t, std::string_view> constants_;  ///< by literal: the units of those that have one
  UnitSolver solver_;
  std::vector<Mismatch> mismatches_;
  std::vector<std::uint32_t> first_variable_;  ///< by node: of its unit variables; none where none was met yet
  std::unordered_map<const BlockType*, BlockUnits> blocks_;
};

}  // namespace

bool is_unit(std::string_view text, std::string& reason) {
  return parse_unit(text, reason).has_value();
}

bool conversion(std::string_view from, std::string_view to, double& factor) {
  std::string reason;
  const auto left = parse_unit(from, reason);
  const auto right = parse_unit(to, reason);
  const auto found = left && right ? conversion(*left, *right) : std::nullopt;
  factor = found.value_or(factor);
  return found.has_value();
}

void check(const Graph& graph, const Schedule& schedule, Diagnostics& diagnostics) {
  Checker(graph, diagnostics).run(schedule);
}

struct Solution::Solved {
  Diagnostics ignored{};  // whether units agree is for check to say
  Checker checker;

  Solved(const Graph& graph, const Schedule& schedule) : checker(graph, ignored) { checker.run(schedule); }
};

Solution::Solution(const Graph& graph, const Schedule& schedule) : solved_(std::make_unique<Solved>(graph, schedule)) {}
Solution::~Solution() = default;

std::vector<std::string> Solution::parameters() const {
  return solved_->checker.parameter_units();
}

std::vector<std::vector<std::string>> Solution::outputs() const {
  return solved_->checker.field_units(&BlockType::outputs);
}

std::vector<std::vector<std::string>> Solution::states() const {
  return solved_->checker.field_units(&BlockType::states);
}

}  // namespace hysteron::units
