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
  if (value.low >= lowest(type) && value.high <= highest(type)) {
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
    const bool reaches = value.loose
                             ? value.low >= std::min(lowest(type), -highest(type) - 1) && value.low <= highest(type)
                         : value.untyped ? value.low >= lowest(type) && value.high <= highest(type)
                                         : lowest(value.type) >= lowest(type) && highest(value.type) <= highest(type);
    if (!reaches && value.untyped && !value.loose) {
      return refused(error::type_mismatch,
                     fmt::format("{} is {}, and does not hold {}, which this choice may give", target, to.name,
                                 value.high > highest(type) ? value.high : value.low),
                     fmt::format("Write numbers from {} to {}.", lowest(type), highest(type)));
    }
    return reaches ? fit(value, type) : mismatch(value.loose ? "Write a number within its range." : conversion);
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

}  // namespace hysteron::bodies
