#include "codegen/graph/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <optional>
#include <unordered_map>
#include <vector>

#include "support/errors.hpp"

namespace hysteron::units {
namespace {

/// An exponent: a fraction in lowest terms.
struct Fraction {
  std::int32_t over = 0;
  std::int32_t under = 1;

  static Fraction of(std::int64_t numerator, std::int64_t denominator) {
    const std::int64_t divisor = std::gcd(numerator, denominator) * (denominator < 0 ? -1 : 1);
    return {static_cast<std::int32_t>(numerator / divisor), static_cast<std::int32_t>(denominator / divisor)};
  }
  friend Fraction operator+(Fraction a, Fraction b) {
    return of(std::int64_t{a.over} * b.under + std::int64_t{b.over} * a.under, std::int64_t{a.under} * b.under);
  }
  friend Fraction operator*(Fraction a, Fraction b) {
    return of(std::int64_t{a.over} * b.over, std::int64_t{a.under} * b.under);
  }
  [[nodiscard]] bool zero() const { return over == 0; }
  [[nodiscard]] Fraction inverse() const { return of(under, over); }
  [[nodiscard]] double number() const { return static_cast<double>(over) / under; }
};

// The base dimensions: those of the SI without the mole and the candela's kin, and a temperature scale of its own for
// °C, whose zero is elsewhere.
constexpr std::size_t dimensions = 8;  // m kg s A K degC mol cd
using Powers = std::array<Fraction, dimensions>;

/// A unit: a factor to the SI, powers of the base dimensions and, in a block, of its unit variables.
struct Unit {
  double factor = 1.0;
  Powers powers{};
  std::vector<std::pair<std::uint32_t, Fraction>> variables{};   ///< sorted by variable
  std::vector<std::pair<std::string_view, Fraction>> symbols{};  ///< as it was written, for messages

  void multiply(const Unit& other, Fraction exponent) {
    factor *= std::pow(other.factor, exponent.number());
    for (std::size_t i = 0; i < dimensions; ++i) {
      powers[i] = powers[i] + other.powers[i] * exponent;
    }
    for (const auto& [variable, power] : other.variables) {
      add_variable(variable, power * exponent);
    }
    for (const auto& [symbol, power] : other.symbols) {
      add_symbol(symbol, power * exponent);
    }
  }
  void add_symbol(std::string_view symbol, Fraction power) {
    const auto place = std::ranges::find(symbols, symbol, [](const auto& one) { return one.first; });
    if (place == symbols.end()) {
      symbols.emplace_back(symbol, power);
    } else {
      place->second = place->second + power;
      if (place->second.zero()) {
        symbols.erase(place);
      }
    }
  }
  void add_variable(std::uint32_t variable, Fraction power) {
    const auto place = std::ranges::lower_bound(variables, variable, {}, [](const auto& one) { return one.first; });
    if (place == variables.end() || place->first != variable) {
      variables.insert(place, {variable, power});
    } else {
      place->second = place->second + power;
      if (place->second.zero()) {
        variables.erase(place);
      }
    }
  }
  [[nodiscard]] bool same_dimension(const Unit& other) const {
    for (std::size_t i = 0; i < dimensions; ++i) {
      if (!(powers[i] + other.powers[i] * Fraction{-1, 1}).zero()) {
        return false;
      }
    }
    return true;
  }
};

struct Symbol {
  std::string_view name;
  double factor;
  std::array<int, dimensions> powers;  // m kg s A K degC mol cd
  bool prefixes;
};
constexpr std::array symbols{
    Symbol{"m", 1, {1}, true},
    Symbol{"g", 1e-3, {0, 1}, true},
    Symbol{"s", 1, {0, 0, 1}, true},
    Symbol{"A", 1, {0, 0, 0, 1}, true},
    Symbol{"K", 1, {0, 0, 0, 0, 1}, true},
    Symbol{"degC", 1, {0, 0, 0, 0, 0, 1}, false},
    Symbol{"°C", 1, {0, 0, 0, 0, 0, 1}, false},
    Symbol{"mol", 1, {0, 0, 0, 0, 0, 0, 1}, true},
    Symbol{"cd", 1, {0, 0, 0, 0, 0, 0, 0, 1}, true},
    Symbol{"N", 1, {1, 1, -2}, true},
    Symbol{"Pa", 1, {-1, 1, -2}, true},
    Symbol{"bar", 1e5, {-1, 1, -2}, true},
    Symbol{"J", 1, {2, 1, -2}, true},
    Symbol{"W", 1, {2, 1, -3}, true},
    Symbol{"C", 1, {0, 0, 1, 1}, true},
    Symbol{"V", 1, {2, 1, -3, -1}, true},
    Symbol{"F", 1, {-2, -1, 4, 2}, true},
    Symbol{"Ohm", 1, {2, 1, -3, -2}, true},
    Symbol{"Ω", 1, {2, 1, -3, -2}, true},
    Symbol{"S", 1, {-2, -1, 3, 2}, true},
    Symbol{"Wb", 1, {2, 1, -2, -1}, true},
    Symbol{"T", 1, {0, 1, -2, -1}, true},
    Symbol{"H", 1, {2, 1, -2, -2}, true},
    Symbol{"Hz", 1, {0, 0, -1}, true},
    Symbol{"L", 1e-3, {3}, true},
    Symbol{"l", 1e-3, {3}, true},
    Symbol{"min", 60, {0, 0, 1}, false},
    Symbol{"h", 3600, {0, 0, 1}, false},
    Symbol{"d", 86400, {0, 0, 1}, false},
    Symbol{"rpm", 2 * 3.14159265358979323846 / 60, {0, 0, -1}, false},
    Symbol{"rad", 1, {}, true},
    Symbol{"deg", 3.14159265358979323846 / 180, {}, false},
    Symbol{"rev", 2 * 3.14159265358979323846, {}, false},
    Symbol{"%", 1e-2, {}, false},
    Symbol{"ppm", 1e-6, {}, false},
    Symbol{"count", 1, {}, false},
    Symbol{"LSB", 1, {}, false},
};

struct Prefix {
  std::string_view name;
  double factor;
};
constexpr std::array prefixes{Prefix{"f", 1e-15}, Prefix{"p", 1e-12}, Prefix{"n", 1e-9}, Prefix{"u", 1e-6},
                              Prefix{"µ", 1e-6},  Prefix{"μ", 1e-6},  Prefix{"m", 1e-3}, Prefix{"c", 1e-2},
                              Prefix{"d", 1e-1},  Prefix{"h", 1e2},   Prefix{"k", 1e3},  Prefix{"M", 1e6},
                              Prefix{"G", 1e9},   Prefix{"T", 1e12}};

Unit unit_of(const Symbol& symbol, double factor, std::string_view written) {
  Unit unit;
  unit.symbols.emplace_back(written, Fraction{1, 1});
  unit.factor = symbol.factor * factor;
  for (std::size_t i = 0; i < dimensions; ++i) {
    unit.powers[i] = {symbol.powers[i], 1};
  }
  return unit;
}

std::optional<Unit> find_symbol(std::string_view name) {
  for (const Symbol& symbol : symbols) {
    if (symbol.name == name) {
      return unit_of(symbol, 1.0, name);
    }
  }
  for (const Prefix& prefix : prefixes) {
    if (name.starts_with(prefix.name)) {
      for (const Symbol& symbol : symbols) {
        if (symbol.prefixes && symbol.name == name.substr(prefix.name.size())) {
          return unit_of(symbol, prefix.factor, name);
        }
      }
    }
  }
  return std::nullopt;
}

/// Reads `um/V`, `'y/'x`, `kg*m^2/s^2`, `'x^(1/2)`, `1/(m*K)`.
class Parser {
 public:
  using Variable = std::function<std::uint32_t(std::string_view)>;
  Parser(std::string_view text, const Variable& variable) : text_(text), variable_(variable) {}

  std::optional<Unit> parse(std::string& reason) {
    std::optional<Unit> unit = product(0);
    if (unit && at_ != text_.size()) {
      fail(fmt::format("'{}' is left over", text_.substr(at_)));
    }
    reason = reason_;
    return reason_.empty() ? unit : std::nullopt;
  }

 private:
  void fail(std::string reason) {
    if (reason_.empty()) {
      reason_ = std::move(reason);
    }
  }
  void skip() {
    while (at_ < text_.size() && text_[at_] == ' ') {
      ++at_;
    }
  }
  bool take(std::string_view token) {
    skip();
    if (!text_.substr(at_).starts_with(token)) {
      return false;
    }
    at_ += token.size();
    skip();
    return true;
  }

  std::optional<Unit> product(int depth) {
    std::optional<Unit> result = power(depth);
    while (result) {
      const bool times = take("*") || take("·");
      if (!times && !take("/")) {
        break;
      }
      const auto next = power(depth);
      if (!next) {
        return std::nullopt;
      }
      result->multiply(*next, {times ? 1 : -1, 1});
    }
    return result;
  }

  std::optional<Unit> power(int depth) {
    std::optional<Unit> base = factor(depth);
    if (!base) {
      return base;
    }
    std::optional<Fraction> exponent;
    if (take("^")) {
      exponent = exponent_of();
    } else if (take("²")) {
      exponent = Fraction{2, 1};
    } else if (take("³")) {
      exponent = Fraction{3, 1};
    } else {
      return base;
    }
    if (!exponent) {
      fail("an exponent is a whole number or a fraction in brackets: m^2, m^(1/2)");
      return std::nullopt;
    }
    Unit result;
    result.multiply(*base, *exponent);
    return result;
  }

  // Byte by byte would not do: °, µ, · and the superscripts begin with the same one.
  [[nodiscard]] bool at_separator() const {
    const std::string_view rest = text_.substr(at_);
    for (const std::string_view separator : {"*", "/", "^", "(", ")", " ", "·", "²", "³"}) {
      if (rest.starts_with(separator)) {
        return true;
      }
    }
    return false;
  }

  std::optional<Fraction> exponent_of() {
    const bool bracket = take("(");
    const auto over = whole();
    if (!over) {
      return std::nullopt;
    }
    Fraction result{*over, 1};
    if (bracket) {
      if (take("/")) {
        const auto under = whole();
        if (!under || *under == 0) {
          return std::nullopt;
        }
        result = Fraction::of(*over, *under);
      }
      if (!take(")")) {
        return std::nullopt;
      }
    }
    return result;
  }

  std::optional<std::int32_t> whole() {
    std::int32_t value = 0;
    const auto [end, problem] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
    if (problem != std::errc{} || std::abs(value) > 24) {
      return std::nullopt;
    }
    at_ = static_cast<std::size_t>(end - text_.data());
    return value;
  }

  std::optional<Unit> factor(int depth) {
    if (take("(")) {
      auto inner = depth < 16 ? product(depth + 1) : std::nullopt;
      if (!inner || !take(")")) {
        fail("a bracket is not closed");
        return std::nullopt;
      }
      return inner;
    }
    if (take("1")) {
      return Unit{};
    }
    const std::size_t begin = at_;
    while (at_ < text_.size() && !at_separator()) {
      ++at_;
    }
    const std::string_view name = text_.substr(begin, at_ - begin);
    if (name.empty()) {
      fail("a symbol is missing");
      return std::nullopt;
    }
    if (name.front() == '\'' && variable_) {
      Unit unit;
      unit.add_variable(variable_(name.substr(1)), {1, 1});
      return unit;
    }
    const auto found = find_symbol(name);
    if (!found) {
      fail(fmt::format("the symbol '{}' is not known", name));
    }
    return found;
  }

  std::string_view text_;
  const Variable& variable_;
  std::size_t at_ = 0;
  std::string reason_{};
};

std::optional<Unit> parse(std::string_view text, std::string& reason, const Parser::Variable& variable = {}) {
  return Parser(text, variable).parse(reason);
}

/// A unit in the symbols in which it was written: um/V, N*m/s^2, m^(1/2).
std::string text_of(const Unit& unit) {
  std::string over;
  std::string under;
  for (const auto& [symbol, power] : unit.symbols) {
    std::string& side = power.over < 0 ? under : over;
    const auto size = std::abs(power.over);
    side += side.empty() ? "" : "*";
    side += symbol;
    if (power.under != 1) {
      side += fmt::format("^({}/{})", size, power.under);
    } else if (size != 1) {
      side += fmt::format("^{}", size);
    }
  }
  std::string text = over.empty() ? "1" : over;
  if (!under.empty()) {
    text += under.find('*') == std::string::npos ? "/" + under : "/(" + under + ")";
  }
  return text;
}

/// The units of all wires, found by unification: unit variables are solved as wires are met.
class Checker {
 public:
  Checker(const Graph& graph, Diagnostics& diagnostics) : graph_(graph), diagnostics_(diagnostics) {}

  void run(const Schedule& schedule) {
    for (const Port& input : graph_.inputs) {
      inputs_.push_back(known(input.unit));
    }
    for (const Parameter& parameter : graph_.parameters) {
      parameters_.push_back(known(parameter.path.find('.') == std::string::npos ||
                                          parameter.field.unit.find('\'') == std::string_view::npos
                                      ? parameter.field.unit
                                      : std::string_view{}));
    }
    outputs_.resize(graph_.nodes.size());
    prepared_.assign(graph_.nodes.size(), false);
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
    for (const Port& output : graph_.outputs) {
      agree(of_wire(output.wire), known(output.unit), output.span, output.name);
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
        const MaybeUnit unit = wire.from == Wire::From::Parameter && texts[wire.index].empty()
                                   ? of_field(index, node.block->pin(pin))
                                   : std::nullopt;
        if (unit && solved(*unit).variables.empty()) {
          texts[wire.index] = text_of(solved(*unit));
        }
      }
    }
    return texts;
  }

 private:
  using MaybeUnit = std::optional<Unit>;

  MaybeUnit known(std::string_view text) {
    if (text.empty()) {
      return std::nullopt;
    }
    const auto found = cache_.find(text);
    if (found != cache_.end()) {
      return found->second;
    }
    std::string reason;
    return cache_.emplace(text, parse(text, reason)).first->second;
  }

  /// Gives a node's outputs their units; a block's pins are connected in a second pass, when all variables exist.
  void prepare(std::uint32_t index) {
    prepared_[index] = true;
    const Node& node = graph_.nodes[index];
    if (node.block == nullptr) {
      outputs_[index] = {operation(node)};
      return;
    }
    std::vector<MaybeUnit>& units = outputs_[index];
    for (const Field& field : node.block->outputs) {
      units.push_back(of_field(index, field));
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
      if (field.unit.empty() || field.type != Type::Real || wire.from == Wire::From::Literal ||
          (wire.from == Wire::From::Node && !prepared_[wire.index])) {
        continue;
      }
      const MaybeUnit expected = of_field(index, field);
      const MaybeUnit given = of_wire(wire);
      if (quietly && given && expected && !can_agree(*given, *expected)) {
        continue;  // reported in the second pass
      }
      agree(given, expected, graph_.wire_spans[node.first_wire + pin], fmt::format("{}.{}", node.path, field.name));
    }
  }

  MaybeUnit of_field(std::uint32_t index, const Field& field) {
    if (field.unit.empty() || field.type != Type::Real) {
      return std::nullopt;
    }
    if (field.unit.find('\'') == std::string_view::npos) {
      return known(field.unit);
    }
    std::string reason;
    return parse(field.unit, reason, [&](std::string_view name) { return variable_of(index, name); });
  }

  std::uint32_t variable_of(std::uint32_t index, std::string_view name) {
    auto& names = variables_[index];
    for (const auto& [known_name, variable] : names) {
      if (known_name == name) {
        return variable;
      }
    }
    names.emplace_back(name, static_cast<std::uint32_t>(solutions_.size()));
    solutions_.emplace_back();
    return names.back().second;
  }

  MaybeUnit of_wire(const Wire& wire) {
    switch (wire.from) {
      case Wire::From::Input:
        return inputs_[wire.index];
      case Wire::From::Parameter:
        return parameters_[wire.index];
      case Wire::From::Node:
        return wire.port < outputs_[wire.index].size() ? outputs_[wire.index][wire.port] : std::nullopt;
      default:
        return std::nullopt;
    }
  }

  /// The unit of an expression. A literal takes the unit of what it is added to, and counts as a number in products.
  MaybeUnit operation(const Node& node) {
    const auto arg = [&](std::uint32_t pin) {
      const Wire& wire = graph_.wire(node, pin);
      const bool product = node.op == Op::Multiply || node.op == Op::Divide;
      return product && wire.from == Wire::From::Literal ? MaybeUnit(Unit{}) : of_wire(wire);
    };
    const auto span = node.span;
    const auto same = [&](std::uint32_t a, std::uint32_t b) {
      const MaybeUnit left = arg(a);
      const MaybeUnit right = arg(b);
      agree(right, left, span, "the two sides");
      return left ? left : right;
    };
    const auto number = [&](std::uint32_t pin) -> MaybeUnit {
      agree(arg(pin), Unit{}, span, fmt::format("the argument of {}", info(node.op).name));
      return Unit{};
    };
    switch (node.op) {
      case Op::Add:
      case Op::Subtract:
      case Op::Min:
      case Op::Max:
        return same(0, 1);
      case Op::Less:
      case Op::LessEqual:
      case Op::Equal:
      case Op::NotEqual:
        same(0, 1);
        return std::nullopt;
      case Op::Select:
        return same(1, 2);
      case Op::Negate:
      case Op::Abs:
        return arg(0);
      case Op::Multiply:
      case Op::Divide: {
        MaybeUnit left = arg(0);
        const MaybeUnit right = arg(1);
        if (!left || !right) {
          return std::nullopt;
        }
        left->multiply(*right, {node.op == Op::Multiply ? 1 : -1, 1});
        return left;
      }
      case Op::Sqrt: {
        const MaybeUnit inside = arg(0);
        if (!inside) {
          return std::nullopt;
        }
        Unit root;
        root.multiply(*inside, {1, 2});
        return root;
      }
      case Op::Power: {
        const MaybeUnit base = arg(0);
        const Wire& exponent = graph_.wire(node, 1);
        if (!base || exponent.from != Wire::From::Literal) {
          return std::nullopt;
        }
        const double twice = graph_.literals[exponent.index] * 2.0;
        if (twice != std::floor(twice) || std::abs(twice) > 48.0) {
          return std::nullopt;
        }
        Unit result;
        result.multiply(*base, Fraction::of(static_cast<std::int64_t>(twice), 2));
        return result;
      }
      case Op::Exp:
      case Op::Log:
      case Op::Sin:
      case Op::Cos:
      case Op::Tan:
      case Op::Asin:
      case Op::Acos:
      case Op::Atan:
        return number(0);
      default:
        return std::nullopt;
    }
  }

  /// A unit with all solved variables replaced.
  Unit solved(const Unit& unit) {
    if (unit.variables.empty()) {
      return unit;
    }
    Unit result;
    result.factor = unit.factor;
    result.powers = unit.powers;
    result.symbols = unit.symbols;
    for (const auto& [variable, power] : unit.variables) {
      if (solutions_[variable]) {
        solutions_[variable] = solved(*solutions_[variable]);
        result.multiply(*solutions_[variable], power);
      } else {
        result.add_variable(variable, power);
      }
    }
    return result;
  }

  Unit ratio(const Unit& given, const Unit& expected) {
    Unit quotient = solved(given);
    quotient.multiply(solved(expected), {-1, 1});
    return quotient;
  }

  static bool is_one(const Unit& unit) { return unit.same_dimension(Unit{}) && std::abs(unit.factor - 1.0) < 1e-9; }

  bool can_agree(const Unit& given, const Unit& expected) {
    const Unit quotient = ratio(given, expected);
    return !quotient.variables.empty() || is_one(quotient);
  }

  void agree(const MaybeUnit& given, const MaybeUnit& expected, language::Span span, std::string_view where) {
    if (!given || !expected) {
      return;
    }
    const Unit quotient = ratio(*given, *expected);
    if (!quotient.variables.empty()) {
      const auto [variable, power] = quotient.variables.front();
      Unit rest = quotient;
      rest.variables.erase(rest.variables.begin());
      Unit solution;
      solution.multiply(rest, (power * Fraction{-1, 1}).inverse());
      solutions_[variable] = solution;
      return;
    }
    if (is_one(quotient)) {
      return;
    }
    const Unit left = solved(*given);
    const Unit right = solved(*expected);
    const bool scale = left.same_dimension(right);
    diagnostics_.error(error::unit_mismatch, graph_.place(span),
                       fmt::format("{}: the unit is {}, {} is expected", where, text_of(left), text_of(right)),
                       scale ? fmt::format("The two differ by the factor {:.6g}: put a HY_GAIN with K = {:.6g} between "
                                           "them, whose output carries the other unit.",
                                           quotient.factor, quotient.factor)
                             : std::string("Correct an @unit, or connect a signal of the expected unit."));
  }

  const Graph& graph_;
  Diagnostics& diagnostics_;
  std::map<std::string_view, MaybeUnit> cache_;
  std::vector<MaybeUnit> inputs_;
  std::vector<MaybeUnit> parameters_;
  std::vector<std::vector<MaybeUnit>> outputs_;
  std::vector<bool> prepared_;
  std::vector<MaybeUnit> solutions_;  ///< by unit variable
  std::unordered_map<std::uint32_t, std::vector<std::pair<std::string_view, std::uint32_t>>> variables_;
};

}  // namespace

bool is_unit(std::string_view text, std::string& reason) {
  return parse(text, reason).has_value();
}

bool conversion(std::string_view from, std::string_view to, double& factor) {
  std::string reason;
  const auto left = parse(from, reason);
  const auto right = parse(to, reason);
  if (!left || !right || !left->same_dimension(*right)) {
    return false;
  }
  factor = left->factor / right->factor;
  return true;
}

void check(const Graph& graph, const Schedule& schedule, Diagnostics& diagnostics) {
  Checker(graph, diagnostics).run(schedule);
}

std::vector<std::string> of_parameters(const Graph& graph, const Schedule& schedule) {
  Diagnostics ignored;  // whether units agree is for check to say
  Checker checker(graph, ignored);
  checker.run(schedule);
  return checker.parameter_units();
}

}  // namespace hysteron::units
