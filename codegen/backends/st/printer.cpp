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
    {Op::IntEqual, infix("=", Strength::Equality)},
    {Op::IntNotEqual, infix("<>", Strength::Equality)},
    {Op::And, infix("AND", Strength::LogicalAnd)},
    {Op::Or, infix("OR", Strength::LogicalOr)},
    {Op::Xor, infix("XOR", Strength::LogicalXor)},
    {Op::Not, negation("NOT ")},
});

/// The digits of a real number with a large E, as the standard writes it. A constant that is not a number (LN(-1.0)) is
/// 0, as what a guard gives for 0 / 0.
std::string digits_of(double value, const StReals& reals) {
  if (std::isnan(value)) {
    value = 0.0;
  }
  if (std::isinf(value)) {
    const double largest =
        reals.float32 || reals.small_literals ? std::numeric_limits<float>::max() : std::numeric_limits<double>::max();
    value = std::copysign(largest, value);
  }
  std::string text = reals.float32 ? real_literal(static_cast<float>(value)) : real_literal(value);
  std::ranges::replace(text, 'e', 'E');
  return text;
}

}  // namespace

std::string_view st_type(Type type, bool float32) {
  return float32 && type == Type::Real ? "REAL" : type_name(type);
}

std::string st_literal(Type type, double value, const StReals& reals) {
  switch (type) {
    case Type::Real:
      return digits_of(value, reals);
    case Type::Word:
      return fmt::format("WORD#16#{:04X}", static_cast<unsigned>(value));
    default:
      return literal_text(type, value);
  }
}

StPrinter::StPrinter(const Graph& graph, const Routine& routine, const Layout& layout, const StNames& names,
                     const StDialect& dialect, bool float32)
    : ExpressionPrinter(routine.tape, st_operations),
      graph_(graph),
      routine_(routine),
      layout_(layout),
      names_(names),
      dialect_(dialect),
      float32_(float32),
      guards_(routine) {}

std::string StPrinter::text(ValueId id, int outer) const {
  std::string out;
  print(id, outer, out);
  return out;
}

/// An argument of a function: a compiler finds the type of an integer by its literal, which is then too narrow.
std::string StPrinter::argument(ValueId id) const {
  const Value& value = tape()[id];
  if (value.op == Op::IntLiteral && !is_named(id) && value.literal == std::numeric_limits<std::int32_t>::min()) {
    return "(DINT#-2147483647 - DINT#1)";
  }
  return value.op == Op::IntLiteral && !is_named(id) ? "DINT#" + text(id) : text(id);
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
  out += value.type == Type::Real && float32_ ? "REAL#" : "";  // elsewhere a literal with a point may be an LREAL
  out += digits;
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
    out += std::to_string(std::clamp(static_cast<int>(place.literal), 0, length - 1));
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
                  fmt::format("{}#{}", st_type(Type::Real, float32_), exponent), out);
      out += brackets ? ")" : "";
    }
  }
}

void StPrinter::print_special(const Value& value, int outer, std::string& out) const {
  const ValueId first = value.args[0];
  switch (value.op) {
    case Op::Power:
      return print_power_inside(value, outer, out);
    case Op::At:
      print(first, out);
      return print_place(value.args[1], length_of(first), out);
    case Op::IntAnd:
    case Op::IntOr:
    case Op::IntXor:
      return append(out, "DWORD_TO_DINT(DINT_TO_DWORD(", argument(first), ")",
                    value.op == Op::IntAnd ? " AND " : (value.op == Op::IntOr ? " OR " : " XOR "), "DINT_TO_DWORD(",
                    argument(value.args[1]), "))");
    case Op::IntShiftLeft:
    case Op::IntShiftRight: {
      std::string shifted;
      print_call(value.op == Op::IntShiftLeft ? "SHL" : "SHR", {"IN", "N"},
                 {"DINT_TO_DWORD(" + argument(first) + ")", text(value.args[1])}, shifted);
      return append(out, "DWORD_TO_DINT(", shifted, ")");
    }
    case Op::WordToInt:
      return append(out, "WORD_TO_DINT(", text(first), ")");
    case Op::IntToWord:  // from its lower bits, since some compilers saturate
      return append(out, "DWORD_TO_WORD(DINT_TO_DWORD(", argument(first), ") AND DWORD#16#0000FFFF)");
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
