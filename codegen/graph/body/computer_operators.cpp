// Operators, choices and shifts.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "codegen/graph/body/computer.hpp"
#include "support/errors.hpp"
#include "support/numbers.hpp"

namespace hysteron::bodies {

using language::Operator;

namespace {

constexpr std::int64_t lowest_whole = std::numeric_limits<std::int32_t>::min();
constexpr std::int64_t highest_whole = std::numeric_limits<std::int32_t>::max();
constexpr std::int64_t every_bit = std::numeric_limits<std::uint32_t>::max();

bool is_comparison(Operator op) {
  return op >= Operator::Less && op <= Operator::NotEqual;
}

std::string_view text_of(Operator op) {
  constexpr std::array texts{"-",  "NOT", "+",  "-", "*",  "/",   "MOD", "**", "<",
                             "<=", ">",   ">=", "=", "<>", "AND", "OR",  "XOR"};
  return texts[static_cast<std::size_t>(op)];
}

}  // namespace

Value Computer::negative(const Value& value) {
  if (!value.valid()) {
    return value;
  }
  if (value.loose && is_integer(value.type)) {
    return -value.low < lowest(Plain::Dint) ? beyond(Plain::Dint, -value.low)
                                            : literal(Plain::Dint, -static_cast<double>(value.low), true);
  }
  if (is_integer(value.type)) {
    Value result = ranged(apply(Op::IntNegate, {value.wire}), value.type, -value.high, -value.low);
    return result;
  }
  if (info(value.type).family == Family::Truth) {
    return refused(error::type_mismatch, "unary − does not take BOOL", "Write NOT.");
  }
  Value result = value;
  result.wire = apply(Op::Negate, {value.wire});
  return result;
}

Value Computer::inverse(const Value& value) {
  if (!value.valid()) {
    return value;
  }
  if (info(value.type).family == Family::Truth) {
    return {.wire = apply(Op::Not, {value.wire}), .type = Plain::Bool};
  }
  if (!is_integer(value.type)) {
    return refused(error::type_mismatch, fmt::format("NOT does not take {}", info(value.type).name),
                   "A comparison turns a number into a BOOL.");
  }
  return {.wire = apply(Op::IntXor, {value.wire, whole(-1)}),
          .type = value.type,
          .low = lowest_whole,
          .high = highest_whole};
}

Value Computer::integer(Op op, const Value& left, const Value& right, Plain type) {
  std::int64_t low = lowest_whole;
  std::int64_t high = highest_whole;
  if (op == Op::IntAdd) {
    low = left.low + right.low;
    high = left.high + right.high;
  } else if (op == Op::IntSubtract) {
    low = left.low - right.high;
    high = left.high - right.low;
  } else if (op == Op::IntMultiply) {
    const auto product = [](std::int64_t a, std::int64_t b) { return a * b; };
    const auto corners = {product(left.low, right.low), product(left.low, right.high), product(left.high, right.low),
                          product(left.high, right.high)};
    low = std::min(corners);
    high = std::max(corners);
  }
  return ranged(apply(op, {left.wire, right.wire}), type, low, high);
}

void Computer::warn_of_zero(bool remainder) {
  report_(error::other_meaning_elsewhere, span_,
          fmt::format("{} by 0 gives {} here; MATIEC refuses it, and many PLCs stop", remainder ? "MOD" : "a division",
                      remainder ? "0" : "0, or infinity of real numbers"),
          "Write a number that is not 0, or leave the division out.");
}

Value Computer::divided(bool remainder, const Value& left, const Value& right, Plain type) {
  if (is_zero(right)) {
    warn_of_zero(remainder);
    return literal(type, 0.0);
  }
  if (!left.beyond_dint() && !right.beyond_dint()) {
    const Value result = integer(remainder ? Op::IntModulo : Op::IntDivide, left, right, type);
    if (!remainder && right.low < 0) {
      return result;
    }
    // A division by 0 gives 0, and a remainder has the sign of what is divided.
    const std::int64_t most = std::max<std::int64_t>(0, std::max(right.high, -right.low) - 1);
    const std::int64_t least = std::max<std::int64_t>(1, right.low);
    const std::int64_t low = remainder ? std::max(-most, left.low) : left.low / least;
    const std::int64_t high = remainder ? std::min(most, left.high) : left.high / least;
    return ranged(result.wire, type, std::min<std::int64_t>(0, low), std::max<std::int64_t>(0, high));
  }
  // 32 bits without a sign: an LREAL holds both exactly, and the whole part of their quotient.
  const Wire divisor = real_of(right);
  const Wire zero = builder_.literal(Type::Real, 0.0);
  const Wire none = apply(Op::Equal, {divisor, zero});
  const Wire safe = apply(Op::Select, {none, builder_.literal(Type::Real, 1.0), divisor});
  const Wire quotient = apply(Op::Select, {none, zero, apply(Op::Divide, {real_of(left), safe})});
  Value result = whole_of(quotient, type, false);
  if (remainder) {
    const Wire rest = apply(Op::IntSubtract, {left.wire, apply(Op::IntMultiply, {result.wire, right.wire})});
    result.wire = apply(Op::SelectInt, {none, whole(0), rest});
  }
  return result;
}

/// What a comparison of two integers gives, where their ranges tell.
std::optional<bool> Computer::decided(Operator op, const Value& left, const Value& right) {
  if (left.beyond_dint() || right.beyond_dint()) {
    return std::nullopt;
  }
  const bool below = left.high < right.low;
  const bool above = left.low > right.high;
  const bool same = left.low == right.high && left.high == right.low;  // one number each
  switch (op) {
    case Operator::Equal:
    case Operator::NotEqual:
      return below || above || same ? std::optional((op == Operator::Equal) == same) : std::nullopt;
    case Operator::Less:
      return below ? std::optional(true) : left.low >= right.high ? std::optional(false) : std::nullopt;
    case Operator::LessEqual:
      return left.high <= right.low ? std::optional(true) : above ? std::optional(false) : std::nullopt;
    case Operator::Greater:
      return decided(Operator::Less, right, left);
    default:
      return decided(Operator::LessEqual, right, left);
  }
}

Value Computer::compared(Operator op, const Value& left, const Value& right) {
  const bool swapped = op == Operator::Greater || op == Operator::GreaterEqual;
  Wire a = swapped ? right.wire : left.wire;
  Wire b = swapped ? left.wire : right.wire;
  const bool equality = op == Operator::Equal || op == Operator::NotEqual;
  if (info(left.type).family == Family::Truth) {
    const Wire differs = apply(Op::Xor, {a, b});
    if (!equality) {  // FALSE < TRUE
      const Wire below = apply(Op::And, {apply(Op::Not, {a}), b});
      return {.wire = op == Operator::Less || op == Operator::Greater
                          ? below
                          : apply(Op::Or, {below, apply(Op::Not, {differs})}),
              .type = Plain::Bool};
    }
    return {.wire = op == Operator::Equal ? apply(Op::Not, {differs}) : differs, .type = Plain::Bool};
  }
  const bool integers = is_integer(left.type);
  if (const auto known = integers ? decided(op, left, right) : std::nullopt) {
    return truth(*known);
  }
  if (!equality && (left.beyond_dint() || right.beyond_dint())) {
    a = apply(Op::IntXor, {a, whole(lowest_whole)});  // in the order of numbers without a sign
    b = apply(Op::IntXor, {b, whole(lowest_whole)});
  }
  Op chosen = integers ? Op::IntNotEqual : Op::NotEqual;
  if (op == Operator::Equal) {
    chosen = integers ? Op::IntEqual : Op::Equal;
  } else if (op == Operator::Less || op == Operator::Greater) {
    chosen = integers ? Op::IntLess : Op::Less;
  } else if (op != Operator::NotEqual) {
    chosen = integers ? Op::IntLessEqual : Op::LessEqual;
  }
  return {.wire = apply(chosen, {a, b}), .type = Plain::Bool};
}

Value Computer::bits(Operator op, const Value& left, const Value& right, Plain type) {
  if (info(type).family == Family::Truth) {
    if (op != Operator::Xor) {  // what is known decides
      const bool neutral = op == Operator::And;
      for (const auto& [one, other] : {std::pair{left, right}, {right, left}}) {
        if (is_true(one) || is_false(one)) {
          return is_true(one) == neutral ? other : one;
        }
      }
    }
    const Op chosen = op == Operator::And ? Op::And : (op == Operator::Or ? Op::Or : Op::Xor);
    return {.wire = apply(chosen, {left.wire, right.wire}), .type = type};
  }
  const Op chosen = op == Operator::And ? Op::IntAnd : (op == Operator::Or ? Op::IntOr : Op::IntXor);
  std::int64_t low = lowest_whole;
  std::int64_t high = highest_whole;
  if (left.low >= 0 && right.low >= 0) {
    std::int64_t above = 1;
    while (above <= std::max(left.high, right.high)) {
      above *= 2;
    }
    low = 0;
    high = above - 1;
  }
  if (op == Operator::And && (left.low >= 0 || right.low >= 0)) {
    low = 0;
    high = left.low < 0 ? right.high : (right.low < 0 ? left.high : std::min(left.high, right.high));
  }
  return ranged(apply(chosen, {left.wire, right.wire}), type, low, high);
}

Value Computer::binary(Operator op, Value left, Value right) {
  if (op == Operator::Power) {
    if (!left.valid() || !right.valid()) {
      return {};
    }
    const bool single = left.type == Plain::Real;
    const bool untyped = Untyped({left}).as(Plain::Lreal);
    left = is_number(left.type) ? left : Value{.wire = real_of(left), .type = Plain::Lreal};
    right = is_number(right.type) ? right : Value{.wire = real_of(right), .type = Plain::Lreal};
    return {.wire = apply(Op::Power, {left.wire, right.wire}),
            .type = single ? Plain::Real : Plain::Lreal,
            .untyped = untyped,
            .wide = true};
  }
  const bool scaled = info(left.type).family == Family::Duration || info(right.type).family == Family::Duration;
  if (scaled && (op == Operator::Multiply || op == Operator::Divide) && left.type != right.type) {
    for (auto* one : {&left, &right}) {  // T * 2, T / 3
      *one = is_integer(one->type) ? Value{.wire = real_of(*one), .type = Plain::Time} : *one;
      one->type = Plain::Time;
    }
  }
  const bool loose = left.loose && right.loose;
  if (loose && is_integer(left.type) && is_integer(right.type) && op >= Operator::Add && op <= Operator::Modulo &&
      (right.low != 0 || op < Operator::Divide)) {
    return of_literals(op, left, right);
  }
  const Untyped untyped({left, right});
  if (!meet(left, right, text_of(op))) {
    return {};
  }
  const Plain type = left.type;
  const Family family = info(type).family;
  if (is_comparison(op)) {
    return compared(op, left, right);
  }
  if (op >= Operator::And) {
    return family == Family::Truth || is_integer(type)
               ? bits(op, left, right, type)
               : refused(error::type_mismatch, fmt::format("{} does not take {}", text_of(op), info(type).name),
                         "A comparison turns a number into a BOOL.");
  }
  if (family == Family::Truth || (op == Operator::Modulo && !is_integer(type))) {
    return refused(error::type_mismatch, fmt::format("{} does not take {}", text_of(op), info(type).name),
                   "It takes numbers.");
  }
  if (is_integer(type)) {
    Value result = op == Operator::Add        ? integer(Op::IntAdd, left, right, type)
                   : op == Operator::Subtract ? integer(Op::IntSubtract, left, right, type)
                   : op == Operator::Multiply ? integer(Op::IntMultiply, left, right, type)
                                              : divided(op == Operator::Modulo, left, right, type);
    result.loose = loose && result.low == result.high;
    result.untyped = !result.loose && untyped.as(type);
    return result;
  }
  const Op chosen = op == Operator::Add        ? Op::Add
                    : op == Operator::Subtract ? Op::Subtract
                    : op == Operator::Multiply ? Op::Multiply
                                               : Op::Divide;
  if (op == Operator::Divide && is_zero(right)) {
    warn_of_zero(false);
  }
  Value result{.wire = apply(chosen, {left.wire, right.wire}),
               .type = type,
               .loose = loose,
               .untyped = untyped.as(type),
               .wide = true};
  const bool wide = left.wide || right.wide || left.loose || right.loose;
  return type == Plain::Real && !wide ? fit(result, type) : result;
}

Value Computer::select(const Value& condition, const Value& yes, const Value& no) {
  if (is_true(condition) || is_false(condition)) {
    return is_true(condition) ? yes : no;
  }
  const bool same =
      yes.wire == no.wire || (GraphBuilder::is_literal(yes.wire) && GraphBuilder::is_literal(no.wire) &&
                              yes.wire.type == no.wire.type && builder_.value(yes.wire) == builder_.value(no.wire) &&
                              std::signbit(builder_.value(yes.wire)) == std::signbit(builder_.value(no.wire)));
  Value result = yes;
  result.low = std::min(yes.low, no.low);
  result.high = std::max(yes.high, no.high);
  if (same) {
    return result;
  }
  result.loose = false;
  result.untyped = false;
  result.wide = yes.wide || no.wide;
  const Op op =
      yes.wire.type == Type::Bool ? Op::SelectBool : (yes.wire.type == Type::Int ? Op::SelectInt : Op::Select);
  result.wire = apply(op, {condition.wire, yes.wire, no.wire});
  return result;
}

Value Computer::extreme(const Value& first, const Value& second, bool greater) {
  Value result = select(compared(greater ? Operator::Greater : Operator::Less, second, first), second, first);
  if (is_integer(first.type) && !first.beyond_dint() && !second.beyond_dint()) {
    const auto bound = [&](std::int64_t a, std::int64_t b) { return greater ? std::max(a, b) : std::min(a, b); };
    result.low = bound(first.low, second.low);
    result.high = bound(first.high, second.high);
  }
  return result;
}

/// By a variable number of places, in five steps, each of which shifts or does not; beyond 31 nothing is left.
Value Computer::shifted(const Value& value, const Value& places, bool left) {
  const Op op = left ? Op::IntShiftLeft : Op::IntShiftRight;
  Value result = fit(value, value.type);
  double known = 0.0;
  const bool is_fixed = constant(places, known);
  const auto n = static_cast<std::int64_t>(known);
  if (is_fixed) {
    result.wire = n == 0 ? result.wire : (n < 0 || n > 31 ? whole(0) : apply(op, {result.wire, whole(n)}));
  } else {
    for (std::int64_t bit = 16; bit > 0; bit /= 2) {
      const Wire step = apply(Op::IntNotEqual, {apply(Op::IntAnd, {places.wire, whole(bit)}), whole(0)});
      result.wire = apply(Op::SelectInt, {step, apply(op, {result.wire, whole(bit)}), result.wire});
    }
    const Wire beyond = apply(Op::IntNotEqual, {apply(Op::IntAnd, {places.wire, whole(-32)}), whole(0)});
    result.wire = apply(Op::SelectInt, {beyond, whole(0), result.wire});
  }
  const std::int64_t low = result.low;
  const std::int64_t high = result.high;
  result.low = lowest_whole;
  result.high = highest_whole;
  if (!is_fixed) {
    if (!left && low >= 0) {
      result.low = 0;
      result.high = high;
    }
  } else if (n == 0) {
    result.low = low;
    result.high = high;
  } else if (n < 0 || n > 31) {
    result.low = result.high = 0;
  } else if (!left) {  // zeros come in from the left
    result.low = low < 0 ? 0 : low >> n;
    result.high = low < 0 ? every_bit >> n : high >> n;
  } else if (low >= 0 && high <= highest_whole >> n) {
    result.low = low << n;
    result.high = high << n;
  }
  return fit(result, value.type);
}

Value Computer::rotated(const Value& value, const Value& places, bool left) {
  const int width = info(value.type).width;
  double known = 0.0;
  if (!constant(places, known)) {  // by as many as the lowest bits of the number say: a word is a ring
    const Value turns = ranged(apply(Op::IntAnd, {places.wire, whole(width - 1)}), Plain::Dint, 0, width - 1);
    const Value others = integer(Op::IntSubtract, literal(Plain::Dint, width), turns, Plain::Dint);
    const Value upper = shifted(value, left ? turns : others, true);
    const Value lower = shifted(value, left ? others : turns, false);
    return fit(bits(Operator::Or, upper, lower, value.type), value.type);
  }
  const int n = ((static_cast<int>(known) % width) + width) % width;
  const int up = left ? n : width - n;
  if (n == 0) {
    return value;
  }
  const Value upper = shifted(value, literal(Plain::Dint, up), true);
  const Value lower = shifted(value, literal(Plain::Dint, width - up), false);
  return fit(bits(Operator::Or, upper, lower, value.type), value.type);
}

}  // namespace hysteron::bodies
