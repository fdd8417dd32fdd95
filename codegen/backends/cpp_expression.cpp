#include "codegen/backends/cpp_expression.hpp"

#include <fmt/format.h>

#include <cmath>

#include "support/numbers.hpp"

namespace hysteron {
namespace {

// How strongly C++ binds, weakest first.
enum Strength : int {
  Conditional = 1,
  LogicalOr,
  LogicalAnd,
  Equality,
  Relation,
  Additive,
  Multiplicative,
  Prefix,
  Primary
};

std::string cpp_real(double value, bool float32) {
  if (std::isnan(value)) {
    return "std::numeric_limits<Real>::quiet_NaN()";
  }
  if (std::isinf(value)) {
    return value > 0 ? "std::numeric_limits<Real>::infinity()" : "-std::numeric_limits<Real>::infinity()";
  }
  return float32 ? real_literal(static_cast<float>(value)) + "F" : real_literal(value);
}

}  // namespace

std::string_view cpp_type(Type type) {
  switch (type) {
    case Type::Real:
      return "Real";
    case Type::Bool:
      return "bool";
    case Type::Int:
      return "std::int32_t";
    case Type::Word:
      return "std::uint16_t";
  }
  return "";
}

std::string CppExpressions::literal(Type type, double value) const {
  switch (type) {
    case Type::Real:
      return cpp_real(value, float32_);
    case Type::Bool:
      return value != 0.0 ? "true" : "false";
    case Type::Int:
      return value == -2147483648.0 ? "(-2147483647 - 1)" : fmt::format("{}", static_cast<std::int64_t>(value));
    case Type::Word:
      return fmt::format("std::uint16_t{{0x{:04X}}}", static_cast<unsigned>(value));
  }
  return "";
}

namespace {

void append_member(std::string_view object, const CppMember& member, std::string& out) {
  out += object;
  if (!member.group.empty()) {
    out += member.group;
    out += '.';
  }
  out += member.name;
}

}  // namespace

void CppExpressions::print_cell(const CppMember& cell, std::string& out) {
  append_member("state.", cell, out);
}

void CppExpressions::binary(const Value& value, std::string_view spelled, int strength, int outer,
                            std::string& out) const {
  // The left side may bind as strongly (a - b - c is (a - b) - c); the right side must bind more strongly, or the
  // order of rounding would change. && inside || is bracketed for the reader's sake.
  const bool brackets =
      strength < outer || (strength == LogicalAnd && outer == LogicalOr) || (strength == Equality && outer == Equality);
  if (brackets) {
    out += '(';
  }
  const auto side = [&](ValueId id, int needed) {
    // Brackets that C++ does not need, but its readers do.
    const Op inner = tape_[id].op;
    const bool mixed = !is_named(id) && ((value.op == Op::Or && inner == Op::And) ||
                                         (strength == Equality && inner >= Op::Less && inner <= Op::IntNotEqual));
    print(id, mixed ? Primary : needed, out);
  };
  side(value.args[0], strength == Equality || strength == Relation ? strength + 1 : strength);
  out += ' ';
  out += spelled;
  out += ' ';
  side(value.args[1], strength + 1);
  if (brackets) {
    out += ')';
  }
}

void CppExpressions::call(const Value& value, std::string_view function, std::size_t arity, std::string& out) const {
  out += function;
  out += '(';
  for (std::size_t i = 0; i < arity; ++i) {
    if (i > 0) {
      out += ", ";
    }
    print(value.args[i], 0, out);
  }
  out += ')';
}

void CppExpressions::print(ValueId id, int outer, std::string& out) const {
  if (is_named(id)) {
    out += names_[name_of_[id] - 1];
    return;
  }
  const Value& value = tape_[id];
  switch (value.op) {
    case Op::RealLiteral:
    case Op::IntLiteral:
    case Op::BoolLiteral:
    case Op::WordLiteral: {
      const std::string text = literal(value.type, value.literal);
      const bool brackets = text.front() == '-' && outer >= Multiplicative;
      out += brackets ? "(" + text + ")" : text;
      return;
    }
    case Op::SampleTime:
      if (value.index == 1) {
        out += "sample_time";
        return;
      }
      out += cpp_real(static_cast<double>(base_ns_ * value.index) * 1e-9, float32_);
      return;
    case Op::Input:
      out += "in.";
      out += inputs[value.index];
      return;
    case Op::Parameter:
      return append_member("params.", parameters[value.index], out);
    case Op::Cell:
      return print_cell(cells[value.index], out);
    case Op::Pin:
      return;
    case Op::Add:
      return binary(value, "+", Additive, outer, out);
    case Op::Subtract:
      return binary(value, "-", Additive, outer, out);
    case Op::Multiply:
      return binary(value, "*", Multiplicative, outer, out);
    case Op::Divide:
      return binary(value, "/", Multiplicative, outer, out);
    case Op::Negate:
      if (outer > Prefix || outer == Additive + 1) {
        out += '(';
      }
      out += '-';
      print(value.args[0], Primary, out);
      if (outer > Prefix || outer == Additive + 1) {
        out += ')';
      }
      return;
    case Op::Abs:
      return call(value, "std::fabs", 1, out);
    case Op::Sqrt:
      return call(value, "std::sqrt", 1, out);
    case Op::Exp:
      return call(value, "std::exp", 1, out);
    case Op::Log:
      return call(value, "std::log", 1, out);
    case Op::Sin:
      return call(value, "std::sin", 1, out);
    case Op::Cos:
      return call(value, "std::cos", 1, out);
    case Op::Tan:
      return call(value, "std::tan", 1, out);
    case Op::Asin:
      return call(value, "std::asin", 1, out);
    case Op::Acos:
      return call(value, "std::acos", 1, out);
    case Op::Atan:
      return call(value, "std::atan", 1, out);
    case Op::Power:
      return call(value, "detail::power", 2, out);
    case Op::Min:
    case Op::IntMin:
      return call(value, "detail::min", 2, out);
    case Op::Max:
    case Op::IntMax:
      return call(value, "detail::max", 2, out);
    case Op::IntAdd:
      return call(value, "detail::add", 2, out);
    case Op::IntSubtract:
      return call(value, "detail::subtract", 2, out);
    case Op::IntMultiply:
      return call(value, "detail::multiply", 2, out);
    case Op::IntDivide:
      return call(value, "detail::divide", 2, out);
    case Op::IntModulo:
      return call(value, "detail::modulo", 2, out);
    case Op::IntNegate:
      return call(value, "detail::negate", 1, out);
    case Op::Less:
    case Op::IntLess:
      return binary(value, "<", Relation, outer, out);
    case Op::LessEqual:
    case Op::IntLessEqual:
      return binary(value, "<=", Relation, outer, out);
    case Op::Equal:
    case Op::IntEqual:
      return binary(value, "==", Equality, outer, out);
    case Op::NotEqual:
    case Op::IntNotEqual:
    case Op::Xor:
      return binary(value, "!=", Equality, outer, out);
    case Op::And:
      return binary(value, "&&", LogicalAnd, outer, out);
    case Op::Or:
      return binary(value, "||", LogicalOr, outer, out);
    case Op::Not:
      if (const Value& inner = tape_[value.args[0]]; inner.op == Op::Not && !is_named(value.args[0])) {
        return print(inner.args[0], outer, out);
      }
      out += '!';
      print(value.args[0], Primary, out);
      return;
    case Op::Select:
    case Op::SelectInt:
    case Op::SelectBool:
    case Op::SelectWord:
      if (outer > 0) {
        out += '(';
      }
      print(value.args[0], LogicalOr, out);
      out += " ? ";
      print(value.args[1], LogicalOr, out);
      out += " : ";
      print(value.args[2], 0, out);
      if (outer > 0) {
        out += ')';
      }
      return;
    case Op::ToInt:
      return call(value, "detail::to_int", 1, out);
    case Op::ToReal:
      out += "static_cast<Real>(";
      print(value.args[0], 0, out);
      out += ')';
      return;
    case Op::At:
      return call(value, "detail::at", 2, out);
  }
}

}  // namespace hysteron
