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
  if (op == Op::ToReal) {
    return args[0];
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

struct Function {
  std::string_view name;
  Op op;
};
constexpr std::array unary_functions{
    Function{"ABS", Op::Abs},   Function{"SQRT", Op::Sqrt}, Function{"LN", Op::Log},     Function{"EXP", Op::Exp},
    Function{"SIN", Op::Sin},   Function{"COS", Op::Cos},   Function{"TAN", Op::Tan},    Function{"ASIN", Op::Asin},
    Function{"ACOS", Op::Acos}, Function{"ATAN", Op::Atan}, Function{"TRUNC", Op::ToInt}};

struct Formal {
  std::string_view function;
  std::array<std::string_view, 9> names;
};
constexpr std::array formal_names{Formal{"EXPT", {"IN1", "IN2"}},
                                  Formal{"MIN", {"IN1", "IN2", "IN3", "IN4", "IN5", "IN6", "IN7", "IN8"}},
                                  Formal{"MAX", {"IN1", "IN2", "IN3", "IN4", "IN5", "IN6", "IN7", "IN8"}},
                                  Formal{"LIMIT", {"MN", "IN", "MX"}},
                                  Formal{"SEL", {"G", "IN0", "IN1"}},
                                  Formal{"MUX", {"K", "IN0", "IN1", "IN2", "IN3", "IN4", "IN5", "IN6", "IN7"}}};
constexpr std::array<std::string_view, 1> only_operand{"IN"};

Op select_for(Type type) {
  switch (type) {
    case Type::Int:
      return Op::SelectInt;
    case Type::Bool:
      return Op::SelectBool;
    case Type::Word:
      return Op::SelectWord;
    default:
      return Op::Select;
  }
}

}  // namespace

std::span<const std::string_view> formal_arguments(std::string_view function) {
  for (const Formal& one : formal_names) {
    if (one.function == function) {
      return {one.names.begin(), std::ranges::find(one.names, std::string_view())};
    }
  }
  return only_operand;
}

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

Wire Lowering::mismatch(language::Span span, std::string_view what, std::initializer_list<Type> given,
                        const std::vector<Type>& taken) {
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
  if (is_given(Type::Word)) {
    mend += " Nothing is computed of a WORD: it is wired as it is.";
  } else if (is_given(Type::Real) && is_given(Type::Int)) {
    mend += " Nothing is converted silently: write literals as 1.0, or convert by DINT_TO_LREAL or LREAL_TO_DINT.";
  } else if (is_given(Type::Bool) && !is_taken(Type::Bool)) {
    mend += " SEL turns a BOOL into a number.";
  } else if (!is_given(Type::Bool) && !is_taken(Type::Real) && !is_taken(Type::Int)) {
    mend += " A comparison turns a number into a BOOL.";
  } else if (!is_taken(Type::Int)) {
    mend += " DINT_TO_LREAL converts.";
  } else if (!is_taken(Type::Real)) {
    mend += " LREAL_TO_DINT and TRUNC convert.";
  } else {
    mend += " A comparison turns a number into a BOOL, SEL a BOOL into a number.";
  }
  report_(error::type_mismatch, span, fmt::format("{} does not take {}", what, names(given, " and ")), std::move(mend));
  return {};
}

Wire Lowering::lower_unary(const language::Unary& unary, language::Span span) {
  const Wire operand = expression(unary.operand);
  if (operand.from == Wire::From::Nothing) {
    return {};
  }
  if (unary.op == Operator::Not) {
    return operand.type == Type::Bool ? apply(Op::Not, {operand}, span)
                                      : mismatch(span, "NOT", {operand.type}, {Type::Bool});
  }
  if (operand.type == Type::Real) {
    return apply(Op::Negate, {operand}, span);
  }
  return operand.type == Type::Int ? apply(Op::IntNegate, {operand}, span)
                                   : mismatch(span, "unary −", {operand.type}, {Type::Real, Type::Int});
}

Wire Lowering::lower_binary(const language::Binary& binary, language::Span span) {
  const Wire left = expression(binary.left);
  Wire right = expression(binary.right);
  if (left.from == Wire::From::Nothing || right.from == Wire::From::Nothing) {
    return {};
  }
  // X ** 2: a whole exponent is the same number as an LREAL.
  if (binary.op == Operator::Power && left.type == Type::Real && right.type == Type::Int &&
      GraphBuilder::is_literal(right)) {
    right = builder_.literal(Type::Real, builder_.value(right));
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
      return mismatch(span, row.text, {left.type, right.type}, taken);
    }
    const Wire result = row.swapped ? apply(*op, {right, left}, span) : apply(*op, {left, right}, span);
    return row.op == Operator::Equal && left.type == Type::Bool ? apply(Op::Not, {result}, span) : result;
  }
  return {};
}

// LREAL_TO_DINT rounds to the nearest, ties to even, as IEC 60559 and the standard say.
Wire Lowering::round_to_int(Wire x, language::Span span) {
  const Wire whole = apply(Op::ToInt, {x}, span);
  const Wire rest = apply(Op::Subtract, {x, apply(Op::ToReal, {whole}, span)}, span);
  const Wire odd = apply(
      Op::IntNotEqual,
      {apply(Op::IntModulo, {whole, builder_.literal(Type::Int, 2)}, span), builder_.literal(Type::Int, 0)}, span);
  const auto beyond = [&](double half) {
    const Wire limit = builder_.literal(Type::Real, half);
    const Wire end = builder_.literal(
        Type::Int, half > 0 ? std::numeric_limits<std::int32_t>::max() : std::numeric_limits<std::int32_t>::min());
    const Wire past = half > 0 ? apply(Op::Less, {limit, rest}, span) : apply(Op::Less, {rest, limit}, span);
    const Wire inside = apply(Op::IntNotEqual, {whole, end}, span);  // at its ends DINT saturates
    const Wire tie = apply(Op::And, {apply(Op::Equal, {rest, limit}, span), odd}, span);
    return apply(Op::And, {apply(Op::Or, {past, tie}, span), inside}, span);
  };
  const Wire one = builder_.literal(Type::Int, 1);
  const Wire up = apply(Op::IntAdd, {whole, one}, span);
  const Wire down = apply(Op::IntSubtract, {whole, one}, span);
  return apply(Op::SelectInt, {beyond(0.5), up, apply(Op::SelectInt, {beyond(-0.5), down, whole}, span)}, span);
}

Wire Lowering::lower_call(const language::FunctionCall& call, language::Span span) {
  const std::string name = language::upper(call.function.text);
  std::vector<Wire> args;
  for (const auto& argument : call.arguments) {
    args.push_back(expression(argument.value));
    if (args.back().from == Wire::From::Nothing) {
      return {};
    }
  }
  const auto wrong = [&](std::string_view form) {
    report_(error::unknown_function, span, fmt::format("{} does not take these arguments", name),
            fmt::format("Write {}.", form));
    return Wire{};
  };
  const auto all = [&](Type type, std::size_t count) {
    bool good = args.size() == count;
    for (const Wire& arg : args) {
      good = good && arg.type == type;
    }
    return good;
  };
  // Formal arguments are put in the order of the standard.
  const auto formal = [&] {
    const auto order = formal_arguments(name);
    std::vector<Wire> sorted(args.size());
    bool named = !call.arguments.empty() && !call.arguments.front().formal.text.empty();
    if (!named) {
      return true;
    }
    std::vector<bool> taken(args.size(), false);
    for (std::size_t i = 0; i < args.size(); ++i) {
      std::size_t place = 0;
      bool found = false;
      for (const auto wanted : order) {
        if (language::same_name(call.arguments[i].formal.text, wanted) && place < sorted.size() && !taken[place]) {
          sorted[place] = args[i];
          taken[place] = found = true;
        }
        ++place;
      }
      if (!found) {
        return false;
      }
    }
    args = sorted;
    return true;
  };

  for (const Function& function : unary_functions) {
    if (name == function.name) {
      if (!formal() || args.size() != 1) {
        return wrong(fmt::format("{}(X) with an LREAL", name));
      }
      if (name == "ABS" && all(Type::Int, 1)) {
        return apply(Op::IntMax, {args[0], apply(Op::IntNegate, {args[0]}, span)}, span);
      }
      return all(Type::Real, 1) ? apply(function.op, {args[0]}, span) : wrong(fmt::format("{}(X) with an LREAL", name));
    }
  }
  if (name == "LOG") {
    return formal() && all(Type::Real, 1)
               ? apply(Op::Divide, {apply(Op::Log, {args[0]}, span), builder_.literal(Type::Real, 2.302585092994046)},
                       span)
               : wrong("LOG(X) with an LREAL");
  }
  if (name == "EXPT") {
    if (!formal()) {
      return wrong("EXPT(BASE, EXPONENT) with LREALs");
    }
    if (args.size() == 2 && args[1].type == Type::Int) {
      args[1] = GraphBuilder::is_literal(args[1]) ? builder_.literal(Type::Real, builder_.value(args[1]))
                                                  : apply(Op::ToReal, {args[1]}, span);
    }
    return all(Type::Real, 2) ? apply(Op::Power, {args[0], args[1]}, span) : wrong("EXPT(BASE, EXPONENT) with LREALs");
  }
  if (name == "MIN" || name == "MAX") {
    if (!formal() || args.size() < 2 || !(all(Type::Real, args.size()) || all(Type::Int, args.size()))) {
      return wrong(fmt::format("{}(A, B, …) with two or more LREALs or DINTs", name));
    }
    const bool real = args[0].type == Type::Real;
    const Op op = name == "MIN" ? (real ? Op::Min : Op::IntMin) : (real ? Op::Max : Op::IntMax);
    Wire result = args[0];
    for (std::size_t i = 1; i < args.size(); ++i) {
      result = apply(op, {result, args[i]}, span);
    }
    return result;
  }
  if (name == "LIMIT") {
    if (!formal() || !(all(Type::Real, 3) || all(Type::Int, 3))) {
      return wrong("LIMIT(MN, IN, MX) with three LREALs or three DINTs");
    }
    const bool real = args[0].type == Type::Real;
    return apply(real ? Op::Min : Op::IntMin, {apply(real ? Op::Max : Op::IntMax, {args[1], args[0]}, span), args[2]},
                 span);
  }
  if (name == "SEL") {
    if (!formal() || args.size() != 3 || args[0].type != Type::Bool || args[1].type != args[2].type) {
      return wrong("SEL(G, IN0, IN1) with a BOOL and two values of one type: IN1 where G is TRUE");
    }
    return apply(select_for(args[1].type), {args[0], args[2], args[1]}, span);
  }
  if (name == "MUX") {
    bool good = args.size() >= 3 && args[0].type == Type::Int && formal();
    for (std::size_t i = 2; good && i < args.size(); ++i) {
      good = args[i].type == args[1].type;
    }
    if (!good) {
      return wrong("MUX(K, IN0, IN1, …) with a DINT and values of one type");
    }
    Wire result = args.back();  // a K outside selects the nearest end
    for (std::size_t i = args.size() - 1; i-- > 1;) {
      const Wire past =
          apply(Op::IntLessEqual, {args[0], builder_.literal(Type::Int, static_cast<double>(i - 1))}, span);
      result = apply(select_for(args[1].type), {past, args[i], result}, span);
    }
    return result;
  }
  if (name == "DINT_TO_LREAL") {
    return all(Type::Int, 1) ? apply(Op::ToReal, {args[0]}, span) : wrong("DINT_TO_LREAL(N) with a DINT");
  }
  if (name == "LREAL_TO_DINT") {
    return all(Type::Real, 1) ? round_to_int(args[0], span) : wrong("LREAL_TO_DINT(X) with an LREAL");
  }
  if (name == "BOOL_TO_DINT") {
    return all(Type::Bool, 1)
               ? apply(Op::SelectInt, {args[0], builder_.literal(Type::Int, 1), builder_.literal(Type::Int, 0)}, span)
               : wrong("BOOL_TO_DINT(B) with a BOOL");
  }
  report_(error::unknown_function, call.function.span, fmt::format("there is no function '{}'", call.function.text),
          "Known: ABS SQRT LN LOG EXP EXPT SIN COS TAN ASIN ACOS ATAN TRUNC MIN MAX LIMIT SEL MUX DINT_TO_LREAL "
          "LREAL_TO_DINT BOOL_TO_DINT.");
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
