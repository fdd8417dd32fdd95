#include "codegen/graph/body/computer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "support/errors.hpp"
#include "support/numbers.hpp"

namespace hysteron::bodies {

using language::Operator;

namespace {

constexpr std::int64_t lowest_dint = std::numeric_limits<std::int32_t>::min();
constexpr std::int64_t highest_dint = std::numeric_limits<std::int32_t>::max();
constexpr double two_to_32 = 4294967296.0;

bool holds(Plain type, std::int64_t low, std::int64_t high) {
  return lowest(type) <= low && high <= highest(type);
}
bool holds(Plain wide, Plain narrow) {
  return holds(wide, lowest(narrow), highest(narrow));
}

}  // namespace

Value Computer::refused(int number, std::string cause, std::string mend) {
  report_(number, span_, std::move(cause), std::move(mend));
  return {};
}

Value Computer::ranged(Wire wire, Plain type, std::int64_t low, std::int64_t high) {
  const bool fits = low >= lowest_dint && high <= highest_dint;
  return {.wire = wire, .type = type, .low = fits ? low : lowest_dint, .high = fits ? high : highest_dint};
}

Wire Computer::whole(std::int64_t value) {
  return builder_.literal(Type::Int, static_cast<double>(value));
}

Value Computer::literal(Plain type, double value, bool loose) {
  Value result{.type = type, .loose = loose};
  if (is_integer(type)) {
    const auto number = static_cast<std::int64_t>(value);
    const auto bits = static_cast<std::int32_t>(static_cast<std::uint32_t>(number));
    result.wire = whole(bits);
    result.low = result.high = loose ? number : bits;
  } else {
    result.wire = builder_.literal(info(type).carrier, value);
  }
  return result;
}

bool Computer::constant(const Value& value, double& number) const {
  if (!GraphBuilder::is_literal(value.wire)) {
    return false;
  }
  number = value.loose && is_integer(value.type) ? static_cast<double>(value.low) : builder_.value(value.wire);
  number += is_unsigned_32(value.type) && number < 0.0 ? two_to_32 : 0.0;
  return true;
}

bool Computer::is_true(const Value& value) const {
  return GraphBuilder::is_literal(value.wire) && builder_.value(value.wire) != 0.0;
}
bool Computer::is_false(const Value& value) const {
  return is_zero(value);
}
bool Computer::is_zero(const Value& value) const {
  return GraphBuilder::is_literal(value.wire) && builder_.value(value.wire) == 0.0;
}

Value Computer::operation(Op op, std::initializer_list<Value> operands, Plain type) {
  const auto* const first = operands.begin();
  const Wire wire = operands.size() == 1 ? apply(op, {first->wire}) : apply(op, {first->wire, first[1].wire});
  return {.wire = wire, .type = type, .low = lowest_dint, .high = highest_dint};
}

Value Computer::taken(Wire wire, Plain type) {
  if (type == Plain::Time) {  // seconds at the border, as everywhere; inside, whole milliseconds are exact
    return {.wire = apply(Op::Multiply, {wire, builder_.literal(Type::Real, 1000.0)}), .type = type};
  }
  if (!is_integer(type)) {
    return fit({.wire = wire, .type = type, .wide = true}, type);
  }
  if (info(type).carrier == Type::Word) {
    return ranged(apply(Op::WordToInt, {wire}), type, 0, 65535);
  }
  return fit({.wire = wire, .type = type, .low = lowest_dint, .high = highest_dint}, type);
}

Wire Computer::given(const Value& value) {
  if (value.type == Plain::Time) {
    return apply(Op::Divide, {value.wire, builder_.literal(Type::Real, 1000.0)});
  }
  return info(value.type).carrier == Type::Word ? apply(Op::IntToWord, {value.wire}) : value.wire;
}

Value Computer::fit(const Value& value, Plain type) {
  Value result = value;
  result.type = type;
  result.loose = false;
  result.untyped = false;
  if (type == Plain::Real && (value.wide || value.type != Plain::Real)) {
    result.wire = apply(Op::ToSingle, {value.wire});
    result.wide = false;
  }
  if (!is_integer(type)) {
    return result;
  }
  if (value.loose && info(type).width == 32) {
    return literal(type, static_cast<double>(value.low));
  }
  if (info(type).width == 32) {
    result.low = result.beyond_dint() ? lowest_dint : value.low;
    result.high = std::min(value.high, highest_dint);
    return result;
  }
  if (holds(type, value.low, value.high)) {
    return result;
  }
  const std::int64_t mask = (std::int64_t{1} << info(type).width) - 1;
  result.wire = apply(Op::IntAnd, {value.wire, whole(mask)});
  if (info(type).below_zero) {
    const Wire middle = whole(-lowest(type));
    result.wire = apply(Op::IntSubtract, {apply(Op::IntXor, {result.wire, middle}), middle});
  }
  result.low = lowest(type);
  result.high = highest(type);
  return result;
}

std::string Computer::conversion_in_words(const Value& value, Plain type) const {
  const PlainInfo& from = info(value.type);
  const PlainInfo& to = info(type);
  double number = 0.0;
  const bool is_known = constant(value, number);
  // A number as a TIME is milliseconds: whoever writes a plain one means seconds as often.
  if (to.family == Family::Duration && value.loose && is_known && std::abs(number) < 1e9 &&
      (number == 0.0 || std::abs(number) >= 1e-3)) {
    return fmt::format("Write it with its unit: T#{0}s, or T#{0}ms.", number_text(number));
  }
  // So is a TIME as a number, and a time of a block is seconds.
  if (from.family == Family::Duration && is_number(type) && is_known) {
    return fmt::format("Write {}, the time in s; {}_TO_{}( … ) would give it in ms.", number_text(1e-3 * number),
                       from.name, to.name);
  }
  return fmt::format("Convert it: {}_TO_{}( … ).", from.name, to.name);
}

Value Computer::assignable(const Value& value, Plain type, const std::string& target) {
  if (!value.valid()) {
    return value;
  }
  const PlainInfo& from = info(value.type);
  const PlainInfo& to = info(type);
  const auto mismatch = [&](std::string mend) {
    return refused(error::type_mismatch,
                   fmt::format("{} is {}, the value is {}", target, to.name,
                               value.loose ? "a literal that it does not hold" : from.name),
                   std::move(mend));
  };
  const std::string conversion = conversion_in_words(value, type);
  if (value.type == type) {
    return fit(value, type);
  }
  if (is_integer(value.type) && (is_integer(type) || is_number(type))) {
    if (is_number(type)) {
      return fit({.wire = real_of(value), .type = type, .wide = true}, type);
    }
    const bool by_range = value.untyped && !value.loose && !value.beyond_dint();
    const bool reaches = value.loose ? holds(type, value.low, value.low)
                         : by_range  ? holds(type, value.low, value.high)
                                     : holds(type, value.type);
    if (!reaches && by_range) {
      return refused(
          error::type_mismatch,
          fmt::format("{} is {}, and does not hold {}, which this may give", target, to.name,
                      value.high > highest(type) ? value.high : value.low),
          fmt::format("Write numbers from {0} to {1}, or limit it: LIMIT({0}, …, {1}).", lowest(type), highest(type)));
    }
    return reaches ? fit(value, type) : mismatch(value.loose ? "Write a number within its range." : conversion);
  }
  constexpr double past_real = 3.4028235677973366e38;  // what is below rounds to the greatest REAL
  if (double number = 0.0; type == Plain::Real && value.loose && constant(value, number) && std::isfinite(number) &&
                           std::abs(number) >= past_real) {
    return refused(error::number_out_of_range, fmt::format("{} is REAL, which does not hold {}", target, number),
                   "It reaches from -3.4e38 to 3.4e38: make it LREAL.");
  }
  if (is_number(value.type) && is_number(type) && (value.loose || value.untyped || type == Plain::Lreal)) {
    return fit(value, type);
  }
  if (value.loose && to.family == Family::Truth && (value.low == 0 || value.low == 1)) {
    return truth(value.low == 1);
  }
  return mismatch(is_number(value.type) && is_number(type) ? conversion
                  : from.family == Family::Truth || to.family == Family::Truth
                      ? "A comparison turns a number into a BOOL, SEL a BOOL into a number."
                      : conversion);
}

Wire Computer::real_of(const Value& value) {
  if (value.loose) {  // which may be a UDINT
    return builder_.literal(Type::Real, static_cast<double>(value.low));
  }
  const Wire real = apply(Op::ToReal, {value.wire});
  if (!value.beyond_dint()) {
    return real;
  }
  const Wire above = apply(Op::Add, {real, builder_.literal(Type::Real, two_to_32)});
  return apply(Op::Select, {apply(Op::IntLess, {value.wire, whole(0)}), above, real});
}

Value Computer::whole_of(Wire real, Plain type, bool round) {
  const auto to_whole = [&](Wire x) {
    return round ? Lowering::rounded(builder_, x, path_, span_) : apply(Op::ToInt, {x});
  };
  Wire wire = to_whole(real);
  if (is_unsigned_32(type)) {  // above the highest DINT, from the other side
    const Wire half = builder_.literal(Type::Real, two_to_32 / 2.0);
    const Wire rest = apply(Op::Subtract, {real, builder_.literal(Type::Real, two_to_32)});
    wire = apply(Op::SelectInt, {apply(Op::Less, {real, half}), wire, to_whole(rest)});
  }
  return fit({.wire = wire, .type = type, .low = lowest_dint, .high = highest_dint}, type);
}

Value Computer::truncated(const Value& value, Plain type) {
  return whole_of(value.wire, type, false);
}

/// The lower 32 bits, as a PLC whose TIME has no more of them gives it: what is counted by them goes on for ever.
Value Computer::whole_milliseconds(const Value& time, Plain type) {
  const Wire range = builder_.literal(Type::Real, two_to_32);
  const Wire rounds = apply(Op::ToReal, {apply(Op::ToInt, {apply(Op::Divide, {time.wire, range})})});
  const Wire rest = apply(Op::Subtract, {time.wire, apply(Op::Multiply, {rounds, range})});
  return fit(whole_of(rest, Plain::Udint, true), type);
}

Value Computer::convert(const Value& value, Plain type) {
  const Family from = info(value.type).family;
  const Family to = info(type).family;
  if (!value.valid()) {
    return value;
  }
  if (from == Family::Duration || to == Family::Duration) {
    if (value.type == type) {
      return value;
    }
    if (from == Family::Truth || to == Family::Truth) {
      return refused(error::type_mismatch, fmt::format("there is no {}_TO_{}", info(value.type).name, info(type).name),
                     "Compare the time with T#0s.");
    }
    report_(
        error::other_meaning_elsewhere, span_,
        fmt::format("{}_TO_{} counts in milliseconds here, as in CODESYS, TwinCAT and SIMATIC; MATIEC counts seconds",
                    info(value.type).name, info(type).name),
        to == Family::Duration
            ? "Write T#1ms * ( … ), which means the same everywhere."
            : "Compare the time with a literal, T#…, where the text shall mean the same everywhere.");
    Value number = value;  // a number of milliseconds, whichever of the two it is
    number.type = from == Family::Duration ? Plain::Lreal : value.type;
    if (to == Family::Duration) {
      number = convert(number, Plain::Lreal);
      number.type = Plain::Time;
      return number;
    }
    return is_integer(type) ? whole_milliseconds(number, type) : convert(number, type);
  }
  if (to == Family::Truth) {
    if (from == Family::Truth) {
      return value;
    }
    return is_integer(value.type) ? compared(Operator::NotEqual, value, literal(value.type, 0.0))
                                  : compared(Operator::NotEqual, value, literal(Plain::Lreal, 0.0));
  }
  if (from == Family::Truth) {
    return select(value, literal(type, 1.0), literal(type, 0.0));
  }
  if (is_number(type)) {
    return is_number(value.type) ? fit(value, type) : fit({.wire = real_of(value), .type = type, .wide = true}, type);
  }
  if (is_number(value.type)) {
    return whole_of(value.type == Plain::Real ? fit(value, Plain::Real).wire : value.wire, type, true);
  }
  // An unsigned number that has all its bits: as a wider one it may be past the highest DINT.
  return fit(fit(value, value.type), type);
}

Untyped::Untyped(std::span<const Value> values) {
  for (const Value& one : values) {
    if (one.loose || one.untyped) {
      literal_ = true;
    } else {
      typed_number_ = typed_number_ || is_number(one.type);
      typed_.push_back(one.type);
    }
  }
}

bool Untyped::as(Plain result) const {
  return literal_ && (is_number(result)    ? !typed_number_
                      : is_integer(result) ? std::ranges::find(typed_, result) == typed_.end()
                                           : typed_.empty());
}

Value Computer::beyond(Plain type, std::int64_t number) {
  return refused(error::number_out_of_range, fmt::format("{} does not hold {}", info(type).name, number),
                 fmt::format("It holds whole numbers from {} to {}; as a real number this one is {}.0.", lowest(type),
                             highest(type), number));
}

namespace {

/// The smallest type that holds all from low to high, of the bits where `bits` says so; none beyond 32 bits.
std::optional<Plain> smallest(bool bits, std::int64_t low, std::int64_t high) {
  constexpr std::array of_bits{Plain::Byte, Plain::Word, Plain::Dword};
  constexpr std::array whole{Plain::Sint, Plain::Usint, Plain::Int, Plain::Uint, Plain::Dint, Plain::Udint};
  const bool pattern = bits && low >= 0;
  for (const Plain one : pattern ? std::span<const Plain>(of_bits) : std::span<const Plain>(whole)) {
    if (holds(one, low, high)) {
      return one;
    }
  }
  return std::nullopt;
}

bool is_of_bits(std::string_view what) {
  return what == "AND" || what == "OR" || what == "XOR";
}

}  // namespace

/// A literal takes the type of its neighbour where that holds it, and both take the smallest that holds both where not.
bool Computer::meet_literal(Value& left, Value& right, std::string_view what) {
  if (left.loose && right.loose) {  // one of them is past the highest DINT
    const std::int64_t low = std::min(left.low, right.low);
    if (low < 0) {
      return beyond(Plain::Dint, std::max(left.low, right.low)).valid();
    }
    left.type = right.type = Plain::Udint;
    return true;
  }
  Value& number = left.loose ? left : right;
  Value& other = left.loose ? right : left;
  const Plain type = other.type;
  // A pattern of bits: X AND 16#FFFF, W AND -2.
  const std::int64_t every = (std::int64_t{1} << info(type).width) - 1;
  const bool pattern = is_of_bits(what) && number.low >= -(every / 2) - 1 && number.low <= every;
  if (pattern || holds(type, number.low, number.low)) {
    number = literal(type, static_cast<double>(number.low));
    return true;
  }
  const auto common = smallest(info(type).family == Family::Bits, std::min(lowest(type), number.low),
                               std::max(highest(type), number.low));
  if (!common) {
    return beyond(type, number.low).valid();
  }
  number = literal(*common, static_cast<double>(number.low));
  other.type = *common;
  return true;
}

/// What + - * / MOD make of two literals is a literal.
Value Computer::of_literals(Operator op, const Value& left, const Value& right) {
  const std::int64_t a = left.low;
  const std::int64_t b = right.low;
  const double product = static_cast<double>(a) * static_cast<double>(b);
  constexpr double far = 4503599627370496.0;  // past what any type holds
  const std::int64_t number = op == Operator::Add        ? a + b
                              : op == Operator::Subtract ? a - b
                              : op == Operator::Multiply ? static_cast<std::int64_t>(std::clamp(product, -far, far))
                              : op == Operator::Divide   ? a / b
                                                         : a % b;
  const bool dint = holds(Plain::Dint, number, number);
  return dint || holds(Plain::Udint, number, number)
             ? literal(dint ? Plain::Dint : Plain::Udint, static_cast<double>(number), true)
             : beyond(Plain::Dint, number);
}

bool Computer::meet(Value& left, Value& right, std::string_view what) {
  if (!left.valid() || !right.valid()) {
    return false;
  }
  if (left.type == right.type) {
    if (left.loose != right.loose && is_integer(left.type)) {
      Value& number = left.loose ? left : right;
      number = fit(number, left.type);
    }
    return true;
  }
  const auto to_number = [&](Value& value, Plain type) {
    value = is_integer(value.type) ? Value{.wire = real_of(value), .type = type, .loose = value.loose} : value;
  };
  if (is_number(left.type) && is_number(right.type)) {  // a literal and a REAL, or an LREAL: wide
    const auto fits_single = [](const Value& one) { return one.type == Plain::Real || one.loose || one.untyped; };
    const bool single = fits_single(left) && fits_single(right);
    left.wide = right.wide = true;
    left.type = right.type = single ? Plain::Real : Plain::Lreal;
    return true;
  }
  if (is_number(left.type) && is_integer(right.type)) {
    to_number(right, left.type);
    right.type = left.type;
    return true;
  }
  if (is_integer(left.type) && is_number(right.type)) {
    to_number(left, right.type);
    left.type = right.type;
    return true;
  }
  if (is_integer(left.type) && is_integer(right.type)) {
    if (left.loose || right.loose) {
      return meet_literal(left, right, what);
    }
    if (left.untyped != right.untyped) {
      Value& chosen = left.untyped ? left : right;
      const Plain type = left.untyped ? right.type : left.type;
      if (holds(type, chosen.low, chosen.high)) {
        chosen = fit(chosen, type);
        return true;
      }
    }
    if (holds(left.type, right.type) || holds(right.type, left.type)) {
      (holds(left.type, right.type) ? right.type : left.type) = holds(left.type, right.type) ? left.type : right.type;
      return true;
    }
    if (info(left.type).width < 32 && info(right.type).width < 32) {
      left.type = right.type = Plain::Dint;
      return true;
    }
  }
  // A literal number beside a BOOL: 0 and 1 are its values.
  for (auto* one : {&left, &right}) {
    Value& other = one == &left ? right : left;
    if (one->loose && other.type == Plain::Bool && is_integer(one->type) && (one->low == 0 || one->low == 1)) {
      *one = truth(one->low == 1);
      return true;
    }
  }
  const bool is_time = left.type == Plain::Time || right.type == Plain::Time;
  const Value& other = left.type == Plain::Time ? right : left;
  double number = 0.0;
  const bool plain = is_time && other.loose && constant(other, number);
  refused(error::type_mismatch,
          fmt::format("{} does not take {} and {}", what, info(left.type).name, info(right.type).name),
          plain ? fmt::format("Write the number with its unit: T#{0}s, or T#{0}ms.", number_text(number))
                : fmt::format("Convert one of them: {}_TO_{}( … ).", info(other.type).name,
                              info(&other == &left ? right.type : left.type).name));
  return false;
}

}  // namespace hysteron::bodies
