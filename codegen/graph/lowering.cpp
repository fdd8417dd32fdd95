#include "codegen/graph/lowering.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <vector>

#include "codegen/graph/definition.hpp"
#include "codegen/graph/names.hpp"
#include "codegen/graph/unit_of_operation.hpp"
#include "codegen/trace/evaluate.hpp"
#include "support/errors.hpp"

namespace hysteron {
namespace {

using language::Operator;

/// The value of an operation on literals, by the same words as the interpreter.
double fold(Op op, std::span<const double> args) {
  const auto as_int = [&](std::size_t i) { return i < args.size() ? static_cast<std::int32_t>(args[i]) : 0; };
  const auto as_real = [&](std::size_t i) { return i < args.size() ? args[i] : 0.0; };
  if (is_select(op)) {
    return args[0] != 0.0 ? args[1] : args[2];
  }
  if (op == Op::ToInt) {
    return to_int(args[0]);
  }
  if (op == Op::ToReal || op == Op::WordToInt) {
    return args[0];
  }
  if (op == Op::IntToWord) {
    return int_to_word(as_int(0));
  }
  switch (info(op).operand) {
    case Type::Int:
      return info(op).result == Type::Bool ? (comparison(op, as_int(0), as_int(1)) ? 1.0 : 0.0)
                                           : int_operation(op, as_int(0), as_int(1));
    case Type::Bool:
      return bool_operation(op, as_real(0) != 0.0, as_real(1) != 0.0) ? 1.0 : 0.0;
    default:
      return info(op).result == Type::Bool ? (comparison(op, as_real(0), as_real(1)) ? 1.0 : 0.0)
                                           : real_operation(op, as_real(0), as_real(1));
  }
}

}  // namespace

Wire GraphBuilder::literal(Type type, double value, std::string_view unit) {
  graph_.literals.push_back(value);
  const Wire wire{Wire::From::Literal, type, 0, static_cast<std::uint32_t>(graph_.literals.size() - 1)};
  if (!unit.empty()) {
    units_.emplace(wire.index, unit);
    graph_.inner.push_back({.unit = std::string(unit), .type = type, .wire = wire});
  }
  return wire;
}

Wire GraphBuilder::operation(Op op, std::initializer_list<Wire> operands, const std::string& path,
                             language::Span span) {
  bool all_literal = true;
  std::vector<double> values;
  std::vector<std::string_view> units;
  for (const Wire& wire : operands) {
    all_literal = all_literal && is_literal(wire);
    if (all_literal) {
      values.push_back(value(wire));
      units.push_back(unit(wire));
    }
  }
  if (all_literal) {
    if (const auto unit = units::unit_of_constants(op, units, values.back())) {
      return literal(info(op).result, fold(op, values), *unit);
    }
  }
  if (path != numbered_path_) {
    numbered_path_ = path;
    next_number_ = 0;
  }
  Node node;
  node.op = op;
  node.path = fmt::format("{}#{}", path, next_number_++);
  node.span = span;
  node.first_wire = static_cast<std::uint32_t>(graph_.wires.size());
  node.wire_count = static_cast<std::uint32_t>(operands.size());
  for (const Wire& wire : operands) {
    graph_.wires.push_back(wire);
    graph_.wire_spans.push_back(span);
  }
  graph_.nodes.push_back(std::move(node));
  return {Wire::From::Node, info(op).result, 0, static_cast<std::uint32_t>(graph_.nodes.size() - 1)};
}

std::uint32_t GraphBuilder::block(const BlockType& type, std::string path, Rate rate, language::Span span) {
  Node node;
  node.block = &type;
  node.rate = rate;
  node.path = std::move(path);
  node.span = span;
  node.first_wire = static_cast<std::uint32_t>(graph_.wires.size());
  node.wire_count = static_cast<std::uint32_t>(type.pin_count());
  graph_.wires.resize(graph_.wires.size() + type.pin_count());
  graph_.wire_spans.resize(graph_.wires.size(), span);
  graph_.nodes.push_back(std::move(node));
  return static_cast<std::uint32_t>(graph_.nodes.size() - 1);
}

Wire Lowering::lower(language::ExpressionId id, const std::string& path) {
  path_ = path;
  return expression(id);
}

Wire Lowering::expression(language::ExpressionId id) {
  const language::Expression& written = source_.expressions[id];
  const auto span = written.span;
  if (const auto* real = std::get_if<language::RealLiteral>(&written.node)) {
    return builder_.literal(Type::Real, real->value);
  }
  if (const auto* integer = std::get_if<language::IntLiteral>(&written.node)) {
    if (integer->is_word) {
      return builder_.literal(Type::Word, static_cast<double>(integer->value));
    }
    return builder_.literal(Type::Int, static_cast<double>(integer->value));
  }
  if (const auto* truth = std::get_if<language::BoolLiteral>(&written.node)) {
    return builder_.literal(Type::Bool, truth->value ? 1.0 : 0.0);
  }
  if (const auto* reference = std::get_if<language::Reference>(&written.node)) {
    return resolve_(*reference, span);
  }
  if (const auto* unary = std::get_if<language::Unary>(&written.node)) {
    return lower_unary(*unary, span);
  }
  if (const auto* binary = std::get_if<language::Binary>(&written.node)) {
    return lower_binary(*binary, span);
  }
  if (const auto* call = std::get_if<language::FunctionCall>(&written.node)) {
    return lower_call(*call, span);
  }
  report_(error::type_mismatch, span, "an array cannot be a part of an expression",
          "Give arrays as initial values of an instance: T : HY_TABLE := (X := [0.0, 1.0]).");
  return {};
}

std::string conversion_in_words(Type wanted, Type given) {
  if (wanted == Type::Bool) {
    return given == Type::Word ? "A bit of a WORD is a BOOL, as W.3; so is a comparison, as W <> 16#0."
                               : "A comparison turns a number into a BOOL.";
  }
  if (given == Type::Bool) {
    return fmt::format("SEL turns a BOOL into a {}: SEL(B, {}).", type_name(wanted),
                       wanted == Type::Real  ? "0.0, 1.0"
                       : wanted == Type::Int ? "0, 1"
                                             : "WORD#0, WORD#1");
  }
  if (wanted == Type::Word) {
    return given == Type::Int ? "DINT_TO_WORD converts." : "DINT_TO_WORD(LREAL_TO_DINT(X)) converts.";
  }
  if (given == Type::Word) {
    return wanted == Type::Int ? "WORD_TO_DINT converts." : "DINT_TO_LREAL(WORD_TO_DINT(W)) converts.";
  }
  return wanted == Type::Real ? "Write literals with a decimal point (1.0), or convert by DINT_TO_LREAL."
                              : "Write literals without a decimal point (1), or convert by LREAL_TO_DINT or TRUNC.";
}

Wire Lowering::mismatch(language::Span span, std::string_view what, std::initializer_list<Type> given,
                        const std::vector<Type>& taken, const std::string& hint) {
  const auto is_taken = [&](Type type) { return std::ranges::find(taken, type) != taken.end(); };
  const auto is_given = [&](Type type) { return std::ranges::find(given, type) != given.end(); };
  const auto names = [](const auto& types, std::string_view between) {
    std::string text;
    for (const Type type : types) {
      text += text.empty() ? "" : between;
      text += type_name(type);
    }
    return text;
  };
  std::string mend =
      fmt::format("It takes {}{}.", names(taken, " or "), taken.size() > 1 ? ", the same on both sides" : "");
  // What is not taken becomes what is beside it, else the first that is taken.
  const auto* const stays = std::ranges::find_if(given, is_taken);
  const bool bits = is_given(Type::Int) && is_taken(Type::Word);
  const Type wanted = stays != given.end() ? *stays : bits ? Type::Word : taken.front();
  const auto* const odd = std::ranges::find_if(given, [&](Type type) { return type != wanted; });
  if (!hint.empty()) {
    mend = hint;
  } else if (is_given(Type::Real) && is_given(Type::Int)) {
    mend += " Nothing is converted silently: write literals as 1.0, or convert by DINT_TO_LREAL or LREAL_TO_DINT.";
  } else if (odd != given.end()) {
    mend += " " + conversion_in_words(wanted, *odd);
  }
  report_(error::type_mismatch, span, fmt::format("{} does not take {}", what, names(given, " and ")), std::move(mend));
  return {};
}

std::string Lowering::meant_brackets(const language::Binary& binary, Type left, Type right) const {
  const bool is_logic = binary.op == Operator::And || binary.op == Operator::Or || binary.op == Operator::Xor;
  if (!is_logic || (left == Type::Word) == (right == Type::Word)) {
    return {};
  }
  const auto text = [&](language::ExpressionId first, language::ExpressionId last) {
    const auto from = span_of(first).offset;
    return source_.text_of({from, span_of(last).offset + span_of(last).length - from});
  };
  const language::ExpressionId other = left == Type::Word ? binary.right : binary.left;
  const auto* const comparison = std::get_if<language::Binary>(&source_.expressions[other].node);
  if (comparison == nullptr || (comparison->op != Operator::Equal && comparison->op != Operator::NotEqual) ||
      text(other, other).starts_with('(')) {
    return {};
  }
  const std::string_view sign = comparison->op == Operator::Equal ? "=" : "<>";
  const std::string meant = left == Type::Word ? fmt::format("({}) {} {}", text(binary.left, comparison->left), sign,
                                                             text(comparison->right, comparison->right))
                                               : fmt::format("{} {} ({})", text(comparison->left, comparison->left),
                                                             sign, text(comparison->right, binary.right));
  return fmt::format("{} is done before the operation on bits. Write {}.", sign, meant);
}

bool Lowering::literals_alone(language::ExpressionId id, std::vector<language::Span>& literals, bool& divides) const {
  const auto& node = source_.expressions[id].node;
  if (const auto* const literal = std::get_if<language::IntLiteral>(&node)) {
    const auto text = source_.text_of(span_of(id));
    literals.push_back(span_of(id));
    return literal->value >= 0 && text.find('#') == std::string_view::npos;
  }
  if (const auto* const unary = std::get_if<language::Unary>(&node)) {
    return unary->op == Operator::Negate && literals_alone(unary->operand, literals, divides);
  }
  const auto* const binary = std::get_if<language::Binary>(&node);
  divides = divides || (binary != nullptr && binary->op == Operator::Divide);
  return binary != nullptr && binary->op != Operator::Modulo && literals_alone(binary->left, literals, divides) &&
         literals_alone(binary->right, literals, divides);
}

std::string Lowering::meant_real(const language::Binary& binary, Type left, Type right) const {
  const bool is_left = left == Type::Int && right == Type::Real;
  if (!is_left && (left != Type::Real || right != Type::Int)) {
    return {};
  }
  const language::ExpressionId whole = is_left ? binary.left : binary.right;
  std::vector<language::Span> literals;
  bool divides = false;
  if (!literals_alone(whole, literals, divides)) {
    return {};
  }
  const language::Span span = span_of(whole);
  const std::string before(source_.text_of(span));
  std::string text = before;
  for (auto one = literals.rbegin(); one != literals.rend(); ++one) {
    text.insert(one->offset + one->length - span.offset, ".0");
  }
  return divides ? fmt::format("Write {}: of whole numbers, {} is cut to a whole one.", text, before)
                 : fmt::format("Write {}: no number is converted silently.", text);
}

Wire Lowering::lower_unary(const language::Unary& unary, language::Span span) {
  const Wire operand = expression(unary.operand);
  if (operand.from == Wire::From::Nothing) {
    return {};
  }
  if (unary.op == Operator::Not) {
    return operand.type == Type::Bool   ? apply(Op::Not, {operand}, span)
           : operand.type == Type::Word ? lower_words(Operator::Xor, operand, builder_.literal(Type::Word, 65535), span)
                                        : mismatch(span, "NOT", {operand.type}, {Type::Bool, Type::Word});
  }
  if (operand.type == Type::Real) {
    return apply(Op::Negate, {operand}, span);
  }
  return operand.type == Type::Int ? apply(Op::IntNegate, {operand}, span)
                                   : mismatch(span, "unary −", {operand.type}, {Type::Real, Type::Int});
}

Wire Lowering::lower_bit(const language::Binary& binary, language::Span span) {
  const auto& masked = std::get<language::Binary>(source_.expressions[binary.left].node);
  const Wire word = expression(masked.left);
  if (word.from == Wire::From::Nothing) {
    return {};
  }
  if (word.type != Type::Word) {
    const auto name = source_.text_of(span_of(masked.left));
    const std::string whole = word.type == Type::Int ? std::string(name) : fmt::format("LREAL_TO_DINT({})", name);
    report_(error::type_mismatch, span,
            fmt::format("'{}' is {} and has no bit {}", name, type_name(word.type), binary.bit),
            word.type == Type::Bool ? fmt::format("A BOOL is a single bit: write {}.", name)
                                    : fmt::format("Write (DINT_TO_WORD({}) AND 16#{:X}) <> 16#0.", whole,
                                                  1U << static_cast<unsigned>(binary.bit)));
    return {};
  }
  const Wire bit = builder_.literal(Type::Word, static_cast<double>(1U << static_cast<unsigned>(binary.bit)));
  return lower_words(Operator::NotEqual, lower_words(Operator::And, word, bit, span), builder_.literal(Type::Word, 0),
                     span);
}

Wire Lowering::lower_binary(const language::Binary& binary, language::Span span) {
  if (binary.bit >= 0) {
    return lower_bit(binary, span);
  }
  Wire left = expression(binary.left);
  Wire right = expression(binary.right);
  if (left.from == Wire::From::Nothing || right.from == Wire::From::Nothing) {
    return {};
  }
  // X ** 2: a whole exponent is the same number as an LREAL.
  if (binary.op == Operator::Power && left.type == Type::Real && right.type == Type::Int &&
      GraphBuilder::is_literal(right)) {
    right = builder_.literal(Type::Real, builder_.value(right));
  }
  // STATUS AND 16#6F: beside a WORD, a whole number that is one is a pattern of bits.
  const auto pattern = [&](Wire& wire, Wire beside) {
    if (beside.type == Type::Word && wire.type == Type::Int && GraphBuilder::is_literal(wire) &&
        builder_.unit(wire).empty() && builder_.value(wire) >= 0.0 && builder_.value(wire) <= 65535.0) {
      wire = builder_.literal(Type::Word, builder_.value(wire));
    }
  };
  pattern(left, right);
  pattern(right, left);
  if (left.type == Type::Word && right.type == Type::Word) {
    if (const Wire result = lower_words(binary.op, left, right, span); result.from != Wire::From::Nothing) {
      return result;
    }
  }
  struct Row {
    Operator op;
    std::string_view text;
    std::optional<Op> real;
    std::optional<Op> integer;
    std::optional<Op> truth;
    bool swapped = false;
  };
  static const std::array rows{
      Row{Operator::Add, "+", Op::Add, Op::IntAdd, {}},
      Row{Operator::Subtract, "-", Op::Subtract, Op::IntSubtract, {}},
      Row{Operator::Multiply, "*", Op::Multiply, Op::IntMultiply, {}},
      Row{Operator::Divide, "/", Op::Divide, Op::IntDivide, {}},
      Row{Operator::Modulo, "MOD", {}, Op::IntModulo, {}},
      Row{Operator::Power, "**", Op::Power, {}, {}},
      Row{Operator::Less, "<", Op::Less, Op::IntLess, {}},
      Row{Operator::LessEqual, "<=", Op::LessEqual, Op::IntLessEqual, {}},
      Row{Operator::Greater, ">", Op::Less, Op::IntLess, {}, true},
      Row{Operator::GreaterEqual, ">=", Op::LessEqual, Op::IntLessEqual, {}, true},
      Row{Operator::Equal, "=", Op::Equal, Op::IntEqual, Op::Xor},
      Row{Operator::NotEqual, "<>", Op::NotEqual, Op::IntNotEqual, Op::Xor},
      Row{Operator::And, "AND", {}, {}, Op::And},
      Row{Operator::Or, "OR", {}, {}, Op::Or},
      Row{Operator::Xor, "XOR", {}, {}, Op::Xor},
  };
  for (const Row& row : rows) {
    if (row.op != binary.op) {
      continue;
    }
    std::optional<Op> op;
    if (left.type == right.type) {
      op = left.type == Type::Real   ? row.real
           : left.type == Type::Int  ? row.integer
           : left.type == Type::Bool ? row.truth
                                     : std::nullopt;
    }
    if (!op) {
      std::vector<Type> taken;
      for (const auto& [type, one] :
           {std::pair{Type::Real, row.real}, {Type::Int, row.integer}, {Type::Bool, row.truth}}) {
        if (one) {
          taken.push_back(type);
        }
      }
      if (row.truth) {
        taken.push_back(Type::Word);
      }
      const std::string brackets = meant_brackets(binary, left.type, right.type);
      return mismatch(span, row.text, {left.type, right.type}, taken,
                      brackets.empty() && row.real ? meant_real(binary, left.type, right.type) : brackets);
    }
    const Wire result = row.swapped ? apply(*op, {right, left}, span) : apply(*op, {left, right}, span);
    return row.op == Operator::Equal && left.type == Type::Bool ? apply(Op::Not, {result}, span) : result;
  }
  return {};
}

bool constant_value(const language::SourceFile& source, language::ExpressionId id, double& value, Type& type) {
  Graph scratch;
  GraphBuilder builder(scratch);
  Lowering lowering(
      builder, source, [](const auto&, auto) { return Wire{}; }, [](int, auto, auto, auto) {});
  const Wire wire = lowering.lower(id, "");
  if (wire.from != Wire::From::Literal) {
    return false;
  }
  value = scratch.literals[wire.index];
  type = wire.type;
  return true;
}

}  // namespace hysteron
