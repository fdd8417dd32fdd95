#include "codegen/backends/st/printer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "codegen/backends/shared/generated_file.hpp"
#include "codegen/graph/names.hpp"
#include "support/numbers.hpp"

namespace hysteron {
namespace {

constexpr SpellingTable st_operations({
    {Op::Add, infix("+", Strength::Additive)},
    {Op::Subtract, infix("-", Strength::Additive)},
    {Op::Multiply, infix("*", Strength::Multiplicative)},
    {Op::Divide, infix("/", Strength::Multiplicative)},
    {Op::Negate, sign("-")},
    {Op::Abs, call("ABS")},
    {Op::Exp, call("EXP")},
    {Op::Sin, call("SIN")},
    {Op::Cos, call("COS")},
    {Op::Tan, call("TAN")},
    {Op::Atan, call("ATAN")},
    {Op::IntAdd, infix("+", Strength::Additive)},
    {Op::IntSubtract, infix("-", Strength::Additive)},
    {Op::IntMultiply, infix("*", Strength::Multiplicative)},
    {Op::IntDivide, infix("/", Strength::Multiplicative)},
    {Op::IntModulo, infix("MOD", Strength::Multiplicative)},
    {Op::IntNegate, sign("-")},
    {Op::Less, infix("<", Strength::Relation)},
    {Op::LessEqual, infix("<=", Strength::Relation)},
    {Op::Equal, infix("=", Strength::Equality)},
    {Op::NotEqual, infix("<>", Strength::Equality)},
    {Op::IntLess, infix("<", Strength::Relation)},
    {Op::IntLessEqual, infix("<=", Strength::Relation)},
    {Op::And, infix("AND", Strength::LogicalAnd)},
    {Op::Or, infix("OR", Strength::LogicalOr)},
    {Op::Xor, infix("XOR", Strength::LogicalXor)},
});

}  // namespace

StPrinter::StPrinter(const Graph& graph, const Routine& routine, const Layout& layout, const StNames& names,
                     const StDialect& dialect, bool float32)
    : ExpressionPrinter(routine.tape, st_operations),
      graph_(graph),
      routine_(routine),
      layout_(layout),
      names_(names),
      dialect_(dialect),
      float32_(float32),
      guards_(graph, routine) {}

std::string StPrinter::text(ValueId id, int outer) const {
  std::string out;
  print(id, outer, out);
  return out;
}

/// An argument of a function: a compiler finds the type of an integer by its literal, which is then too narrow.
std::string StPrinter::argument(ValueId id) const {
  if (!is_integer(id)) {
    return text(id);
  }
  const double value = tape()[id].literal;
  return value == std::numeric_limits<std::int32_t>::min() ? "(-DINT#2147483647 - DINT#1)"
                                                           : st_typed_literal("DINT", literal(Type::Int, value));
}

void StPrinter::print_largest(bool negative, int outer, std::string& out) const {
  uses_largest = true;
  const bool brackets = negative && outer > Strength::Loosest;
  out += brackets ? "(" : "";
  out += negative ? "-" : "";
  print_variable(names_.largest, out);
  out += brackets ? ")" : "";
}

void StPrinter::print_leaf(const Value& value, int outer, std::string& out) const {
  switch (value.op) {
    case Op::SampleTime:
      if (value.index == 1) {
        uses_sample_time = true;
        return print_variable(names_.sample_time, out);
      }
      out += float32_ ? "REAL#" : "";
      out += literal(Type::Real, static_cast<double>(graph_.sample_time_ns * value.index) * 1e-9);
      return;
    case Op::Input:
      return print_variable(layout_.inputs[value.index], out);
    case Op::Parameter:
      return print_variable(layout_.parameters[value.index].name, out);
    case Op::Cell:
      return print_cell(value.index, out);
    default:
      break;
  }
  if (value.type == Type::Real && std::isinf(value.literal)) {
    return print_largest(value.literal < 0.0, outer, out);
  }
  if (value.type == Type::Int && value.literal == std::numeric_limits<std::int32_t>::min()) {
    out += "(-2147483647 - 1)";  // 2147483648, before its sign is read, is no DINT
    return;
  }
  const std::string digits = literal(value.type, value.literal);
  const bool brackets = digits.front() == '-' && outer > Strength::Loosest;
  out += brackets ? "(" : "";
  // Elsewhere a literal with a point may be an LREAL.
  out += value.type == Type::Real && float32_ ? st_typed_literal("REAL", digits) : digits;
  out += brackets ? ")" : "";
}

std::uint16_t StPrinter::length_of(ValueId array) const {
  const Value& value = tape()[array];
  return value.op == Op::Cell ? routine_.cells[value.index].field.length : graph_.parameters[value.index].field.length;
}

void StPrinter::print_call(std::string_view function, std::initializer_list<std::string_view> names,
                           std::initializer_list<std::string_view> arguments, std::string& out) const {
  append(out, function, "(");
  const auto* name = names.begin();
  for (const auto* one = arguments.begin(); one != arguments.end(); ++one, ++name) {
    append(out, one == arguments.begin() ? "" : ", ");
    if (dialect_.named_arguments) {
      append(out, *name, " := ");
    }
    append(out, *one);
  }
  out += ')';
}

void StPrinter::print_place(ValueId index, std::uint16_t length, std::string& out) const {
  out += '[';
  const Value& place = tape()[index];
  if (place.op == Op::IntLiteral) {
    out += std::to_string(place_within(place.literal, length));
  } else {
    print_call("LIMIT", {"MN", "IN", "MX"}, {"DINT#0", text(index), fmt::format("DINT#{}", length - 1)}, out);
  }
  out += ']';
}

void StPrinter::print_power(std::string_view base, std::string_view exponent, std::string& out) const {
  if (dialect_.power_operator) {
    append(out, "(", base, ") ** (", exponent, ")");
  } else {
    append(out, "EXPT(", base, ", ", exponent, ")");
  }
}

void StPrinter::print_power_inside(const Value& value, int outer, std::string& out) const {
  const ValueId base = value.args[0];
  const auto positive_part = [&] {
    std::string part;
    print_call("MAX", {"IN1", "IN2"}, {text(base), zero()}, part);
    return part;
  };
  switch (guards_.power_form(value)) {
    case PowerForm::Base:
      return print(base, outer, out);
    case PowerForm::Square: {
      const bool brackets = outer > Strength::Multiplicative;
      const std::string factor = text(base, Strength::Primary);
      return append(out, brackets ? "(" : "", factor, " * ", factor, brackets ? ")" : "");
    }
    case PowerForm::Root:
      return append(out, "SQRT(", guards_.never_negative(base) ? text(base) : positive_part(), ")");
    case PowerForm::One:
      return append(out, real("1.0"));
    default: {
      const bool brackets = dialect_.power_operator && outer > Strength::Loosest;
      out += brackets ? "(" : "";
      const std::string exponent = literal(Type::Real, tape()[value.args[1]].literal);
      print_power(guards_.power_form(value) == PowerForm::PositivePart ? positive_part() : text(base),
                  st_typed_literal(st_type(Type::Real, float32_), exponent), out);
      out += brackets ? ")" : "";
    }
  }
}

/// A truth value turned round. NOT stands before single values alone: a compiler that makes C++ of it has no NOT of
/// what AND, OR and XOR of truth values give there.
void StPrinter::print_negated(ValueId id, int outer, std::string& out) const {
  const Value& value = tape()[id];
  if (!is_named(id) && value.op == Op::Not) {
    return print(value.args[0], outer, out);
  }
  if (!is_named(id) && (value.op == Op::IntEqual || value.op == Op::IntNotEqual)) {
    Value other = value;
    other.op = value.op == Op::IntEqual ? Op::IntNotEqual : Op::IntEqual;
    return print_comparison(other, outer, out);
  }
  if (!is_named(id) && (value.op == Op::And || value.op == Op::Or || value.op == Op::Xor)) {
    const bool brackets = outer > Strength::Loosest;
    out += brackets ? "(" : "";
    if (value.op == Op::Xor) {
      print(value.args[0], Strength::Primary, out);
      out += " = ";
      print(value.args[1], Strength::Primary, out);
    } else {
      print_negated(value.args[0], Strength::Primary, out);
      out += value.op == Op::And ? " OR " : " AND ";
      print_negated(value.args[1], Strength::Primary, out);
    }
    out += brackets ? ")" : "";
    return;
  }
  out += "NOT ";
  print(id, Strength::Primary, out);
}

void StPrinter::print_special(const Value& value, int outer, std::string& out) const {
  const ValueId first = value.args[0];
  switch (value.op) {
    case Op::Power:
      return print_power_inside(value, outer, out);
    case Op::At:
      print(first, out);
      return print_place(value.args[1], length_of(first), out);
    case Op::Not:
      return print_negated(first, outer, out);
    case Op::IntEqual:
    case Op::IntNotEqual:
      return print_comparison(value, outer, out);
    case Op::IntAnd:
    case Op::IntOr:
    case Op::IntXor:
    case Op::IntShiftLeft:
    case Op::IntShiftRight:
      return append(out, "DWORD_TO_DINT(", bits_text(value), ")");
    case Op::WordToInt:
      return append(out, "WORD_TO_DINT(", text(first), ")");
    case Op::IntToWord:
      return print_as_word(first, outer, out);
    case Op::ToSingle:
      return float32_ ? print(first, outer, out) : append(out, "REAL_TO_LREAL(LREAL_TO_REAL(", text(first), "))");
    case Op::ToReal:
      return append(out, float32_ ? "DINT_TO_REAL(" : "DINT_TO_LREAL(", argument(first), ")");
    case Op::Min:
    case Op::IntMin:
      return print_call("MIN", {"IN1", "IN2"}, {argument(first), argument(value.args[1])}, out);
    case Op::Max:
    case Op::IntMax:
      return print_call("MAX", {"IN1", "IN2"}, {argument(first), argument(value.args[1])}, out);
    case Op::Sqrt:  // the root of a number below 0 stops some PLCs
      out += "SQRT(";
      if (guards_.never_negative(first)) {
        print(first, out);
      } else {
        print_call("MAX", {"IN1", "IN2"}, {text(first), zero()}, out);
      }
      out += ')';
      return;
    case Op::Log: {  // and so does the logarithm of 0
      const std::string number = text(first);
      out += "LN(";
      print_call("SEL", {"G", "IN0", "IN1"}, {number + " > " + zero(), real("1.2E-38"), number}, out);
      out += ')';
      return;
    }
    case Op::Asin:
    case Op::Acos:
      append(out, value.op == Op::Asin ? "ASIN(" : "ACOS(");
      print_call("LIMIT", {"MN", "IN", "MX"}, {real("-1.0"), text(first), real("1.0")}, out);
      out += ')';
      return;
    default:  // SEL takes what is not chosen first
      print_call("SEL", {"G", "IN0", "IN1"}, {text(first), argument(value.args[2]), argument(value.args[1])}, out);
  }
}

}  // namespace hysteron
