#include "codegen/backends/shared/interval.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <numbers>

#include "codegen/trace/evaluate.hpp"
#include "support/single.hpp"

namespace hysteron::interval {
namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();
constexpr double lowest_dint = -2147483648.0;
constexpr double highest_dint = 2147483647.0;
constexpr double highest_word = 65535.0;

const ValueBounds any_number{};
const ValueBounds any_dint{.low = lowest_dint, .high = highest_dint, .may_be_nan = false};
const ValueBounds any_truth{.low = 0.0, .high = 1.0, .may_be_nan = false};

double rounded(double value, bool float32) {
  return float32 ? nearest_single(value) : value;
}

/// A library's result may be off by some units in the last place.
ValueBounds widened(ValueBounds bounds, bool float32) {
  constexpr double units = 8.0;
  const double epsilon =
      float32 ? static_cast<double>(std::numeric_limits<float>::epsilon()) : std::numeric_limits<double>::epsilon();
  const double least =
      float32 ? static_cast<double>(std::numeric_limits<float>::min()) : std::numeric_limits<double>::min();
  const auto margin = [&](double end) {
    return std::isfinite(end) ? units * epsilon * std::max(std::abs(end), least) : 0.0;
  };
  bounds.low -= margin(bounds.low);
  bounds.high += margin(bounds.high);
  if (float32) {  // outwards, so that the ends are floats
    bounds.low =
        static_cast<double>(std::nextafter(static_cast<float>(bounds.low), -std::numeric_limits<float>::infinity()));
    bounds.high =
        static_cast<double>(std::nextafter(static_cast<float>(bounds.high), std::numeric_limits<float>::infinity()));
  }
  return bounds;
}

ValueBounds around(std::initializer_list<double> values, bool may_be_nan) {
  ValueBounds bounds{.low = unlimited, .high = -unlimited, .may_be_nan = may_be_nan};
  for (const double value : values) {
    bounds.low = std::min(bounds.low, value);
    bounds.high = std::max(bounds.high, value);
  }
  return bounds;
}

bool is_unlimited(const ValueBounds& x) {
  return std::isinf(x.low) || std::isinf(x.high);
}
bool has_zero(const ValueBounds& x) {
  return x.low <= 0.0 && 0.0 <= x.high;
}

ValueBounds sum(const ValueBounds& a, const ValueBounds& b, bool float32) {
  const bool opposed = (a.high == unlimited && b.low == -unlimited) || (a.low == -unlimited && b.high == unlimited);
  if (a.low == unlimited || b.low == unlimited || a.high == -unlimited || b.high == -unlimited) {
    return any_number;  // of numbers that are infinite for certain
  }
  return {.low = rounded(a.low + b.low, float32),
          .high = rounded(a.high + b.high, float32),
          .may_be_nan = a.may_be_nan || b.may_be_nan || opposed};
}

ValueBounds negated(const ValueBounds& a) {
  return {.low = -a.high, .high = -a.low, .may_be_nan = a.may_be_nan};
}

ValueBounds product(const ValueBounds& a, const ValueBounds& b, bool float32) {
  const bool nan = a.may_be_nan || b.may_be_nan || (has_zero(a) && is_unlimited(b)) || (has_zero(b) && is_unlimited(a));
  const auto corner = [&](double x, double y) { return x == 0.0 || y == 0.0 ? 0.0 : rounded(x * y, float32); };
  return around({corner(a.low, b.low), corner(a.low, b.high), corner(a.high, b.low), corner(a.high, b.high)}, nan);
}

ValueBounds quotient(const ValueBounds& a, const ValueBounds& b, bool float32) {
  const bool both_unlimited = is_unlimited(a) && is_unlimited(b);
  if (has_zero(b)) {
    return {.may_be_nan = a.may_be_nan || b.may_be_nan || both_unlimited || has_zero(a)};
  }
  const auto corner = [&](double x, double y) { return std::isinf(y) ? 0.0 : rounded(x / y, float32); };
  ValueBounds bounds =
      around({corner(a.low, b.low), corner(a.low, b.high), corner(a.high, b.low), corner(a.high, b.high)},
             a.may_be_nan || b.may_be_nan || both_unlimited);
  if (both_unlimited) {  // an infinite number over a finite one
    bounds = {.may_be_nan = true};
  }
  return bounds;
}

ValueBounds absolute(const ValueBounds& a) {
  const double high = std::max(std::abs(a.low), std::abs(a.high));
  return {
      .low = has_zero(a) ? 0.0 : std::min(std::abs(a.low), std::abs(a.high)), .high = high, .may_be_nan = a.may_be_nan};
}

/// A rising function of the library, on the part of an interval on which it is defined.
template <class Function>
ValueBounds rising(ValueBounds a, double from, double to, bool float32, const Function& function) {
  const bool outside = a.low < from || a.high > to;
  a.low = std::clamp(a.low, from, to);
  a.high = std::clamp(a.high, from, to);
  return widened({.low = function(a.low), .high = function(a.high), .may_be_nan = a.may_be_nan || outside}, float32);
}

ValueBounds root(const ValueBounds& a, bool float32) {
  const auto of = [&](double x) { return rounded(std::sqrt(std::max(x, 0.0)), float32); };
  return {.low = of(a.low), .high = of(a.high), .may_be_nan = a.may_be_nan || a.low < 0.0};
}

ValueBounds raised(const ValueBounds& base, const ValueBounds& exponent, bool float32) {
  if (exponent.low == exponent.high && !exponent.may_be_nan) {
    const double e = exponent.low;
    if (e == 1.0) {
      return base;
    }
    if (e == 0.5) {
      return root(base, float32);
    }
    if (e == 2.0) {
      const ValueBounds size = absolute(base);
      return {.low = rounded(size.low * size.low, float32),
              .high = rounded(size.high * size.high, float32),
              .may_be_nan = base.may_be_nan};
    }
    if (e == 0.0) {
      return exactly(1.0);
    }
  }
  const bool nan = base.may_be_nan || exponent.may_be_nan;
  if (base.low < 0.0) {
    return any_number;
  }
  if (base.low == 0.0 && exponent.low < 0.0) {  // infinite, with the sign of the 0
    return {.may_be_nan = nan};
  }
  // Monotonic in either operand while the other stands still: the ends are at corners.
  const auto corner = [](double x, double y) { return std::pow(std::abs(x), y); };
  const ValueBounds corners = around({corner(base.low, exponent.low), corner(base.low, exponent.high),
                                      corner(base.high, exponent.low), corner(base.high, exponent.high)},
                                     nan);
  return hull(widened(corners, float32), has_zero(exponent) ? exactly(1.0) : corners);
}

/// b < a ? b : a, so that a is kept where b is not a number, and where it is none itself.
ValueBounds smaller(const ValueBounds& a, const ValueBounds& b) {
  const double high = b.may_be_nan ? a.high : std::min(a.high, b.high);
  return {.low = std::min(a.low, b.low), .high = high, .may_be_nan = a.may_be_nan};
}
ValueBounds larger(const ValueBounds& a, const ValueBounds& b) {
  return negated(smaller(negated(a), negated(b)));
}

/// Integers wrap where they leave DINT.
ValueBounds wrapped(const ValueBounds& x) {
  return x.low < lowest_dint || x.high > highest_dint ? any_dint : x;
}

ValueBounds integer_operation(Op op, const ValueBounds& a, const ValueBounds& b) {
  const auto whole = [](double low, double high) { return wrapped({.low = low, .high = high, .may_be_nan = false}); };
  const bool positive = a.low >= 0.0 && b.low >= 0.0;
  const double most_bits =
      static_cast<double>(std::bit_ceil(static_cast<std::uint64_t>(std::max({a.high, b.high, 0.0})) + 1)) - 1.0;
  switch (op) {
    case Op::IntAdd:
      return whole(a.low + b.low, a.high + b.high);
    case Op::IntSubtract:
      return whole(a.low - b.high, a.high - b.low);
    case Op::IntMultiply:
      return wrapped(product(a, b, false));
    case Op::IntNegate:
      return whole(-a.high, -a.low);
    case Op::IntMin:
      return smaller(a, b);
    case Op::IntMax:
      return larger(a, b);
    case Op::IntDivide: {  // towards 0; by 0 it is 0
      const ValueBounds size = absolute(a);
      return wrapped({.low = a.low < 0.0 || b.low < 0.0 ? -size.high : 0.0, .high = size.high, .may_be_nan = false});
    }
    case Op::IntModulo: {  // the sign of the dividend; by 0 it is 0
      const double most = std::min(absolute(a).high, std::max(absolute(b).high - 1.0, 0.0));
      return whole(a.low < 0.0 ? -most : 0.0, a.high > 0.0 ? most : 0.0);
    }
    case Op::IntAnd:
      return positive ? whole(0.0, std::min(a.high, b.high)) : any_dint;
    case Op::IntOr:
    case Op::IntXor:
      return positive ? whole(0.0, most_bits) : any_dint;
    case Op::IntShiftRight:
      return a.low >= 0.0 ? whole(0.0, a.high) : any_dint;
    default:
      return any_dint;
  }
}

/// A truth value that is known, or either.
ValueBounds truth(bool is_true, bool is_false) {
  return is_true ? exactly(1.0) : is_false ? exactly(0.0) : any_truth;
}

ValueBounds compared(Op op, const ValueBounds& a, const ValueBounds& b) {
  const bool nan = a.may_be_nan || b.may_be_nan;  // then every comparison but <> is FALSE
  const bool apart = a.high < b.low || b.high < a.low;
  const bool equal = a.low == a.high && b.low == b.high && a.low == b.low;
  switch (op) {
    case Op::Less:
    case Op::IntLess:
      return truth(!nan && a.high < b.low, a.low >= b.high);
    case Op::LessEqual:
    case Op::IntLessEqual:
      return truth(!nan && a.high <= b.low, a.low > b.high);
    case Op::Equal:
    case Op::IntEqual:
      return truth(!nan && equal, apart);
    default:
      return truth(apart, !nan && equal);
  }
}

ValueBounds logical(Op op, const ValueBounds& a, const ValueBounds& b) {
  switch (op) {
    case Op::And:
      return {.low = std::min(a.low, b.low), .high = std::min(a.high, b.high), .may_be_nan = false};
    case Op::Or:
      return {.low = std::max(a.low, b.low), .high = std::max(a.high, b.high), .may_be_nan = false};
    case Op::Xor:
      return a.low == a.high && b.low == b.high ? exactly(a.low != b.low ? 1.0 : 0.0) : any_truth;
    default:
      return {.low = 1.0 - a.high, .high = 1.0 - a.low, .may_be_nan = false};
  }
}

ValueBounds to_integer(const ValueBounds& a) {
  const auto end = [](double x) { return std::trunc(std::clamp(x, lowest_dint, highest_dint)); };
  const ValueBounds whole{.low = end(a.low), .high = end(a.high), .may_be_nan = false};
  return a.may_be_nan ? hull(whole, exactly(0.0)) : whole;
}

/// Each end as a function gives it, which rises and is exact.
template <class Function>
ValueBounds ends(const ValueBounds& a, const Function& function) {
  return {.low = function(a.low), .high = function(a.high), .may_be_nan = a.may_be_nan};
}

}  // namespace

ValueBounds exactly(double value) {
  return std::isnan(value) ? any_number : ValueBounds{.low = value, .high = value, .may_be_nan = false};
}

ValueBounds any_of_type(Type type) {
  switch (type) {
    case Type::Bool:
      return any_truth;
    case Type::Int:
      return any_dint;
    case Type::Word:
      return {.low = 0.0, .high = highest_word, .may_be_nan = false};
    default:
      return any_number;
  }
}

ValueBounds hull(const ValueBounds& a, const ValueBounds& b) {
  return {.low = std::min(a.low, b.low), .high = std::max(a.high, b.high), .may_be_nan = a.may_be_nan || b.may_be_nan};
}

ValueBounds apply(Op op, const Operands& operands, bool float32) {
  const auto& [a, b, c] = operands;
  switch (op) {
    case Op::Add:
      return sum(a, b, float32);
    case Op::Subtract:
      return sum(a, negated(b), float32);
    case Op::Multiply:
      return product(a, b, float32);
    case Op::Divide:
      return quotient(a, b, float32);
    case Op::Negate:
      return negated(a);
    case Op::Abs:
      return absolute(a);
    case Op::Sqrt:
      return root(a, float32);
    case Op::Exp:
      return larger(rising(a, -unlimited, unlimited, float32, [](double x) { return std::exp(x); }), exactly(0.0));
    case Op::Log:
      return rising(a, 0.0, unlimited, float32, [](double x) { return std::log(x); });
    case Op::Sin:
    case Op::Cos:
      return {.low = -1.0, .high = 1.0, .may_be_nan = a.may_be_nan || is_unlimited(a)};
    case Op::Tan:
      return {.may_be_nan = a.may_be_nan || is_unlimited(a)};
    case Op::Asin:
      return rising(a, -1.0, 1.0, float32, [](double x) { return std::asin(x); });
    case Op::Acos:
      return rising(negated(a), -1.0, 1.0, float32, [](double x) { return std::acos(-x); });
    case Op::Atan:
      return rising(a, -unlimited, unlimited, float32, [](double x) { return std::atan(x); });
    case Op::Power:
      return raised(a, b, float32);
    case Op::Min:
      return smaller(a, b);
    case Op::Max:
      return larger(a, b);
    case Op::Less:
    case Op::LessEqual:
    case Op::Equal:
    case Op::NotEqual:
    case Op::IntLess:
    case Op::IntLessEqual:
    case Op::IntEqual:
    case Op::IntNotEqual:
      return compared(op, a, b);
    case Op::And:
    case Op::Or:
    case Op::Xor:
    case Op::Not:
      return logical(op, a, b);
    case Op::Select:
    case Op::SelectInt:
    case Op::SelectBool:
    case Op::SelectWord:
      return a.low == 1.0 ? b : a.high == 0.0 ? c : hull(b, c);
    case Op::ToInt:
      return to_integer(a);
    case Op::ToReal:
      return ends(a, [&](double x) { return rounded(x, float32); });
    case Op::ToSingle:
      return ends(a, [](double x) { return rounded(x, true); });
    case Op::WordToInt:
      return a;
    case Op::IntToWord:
      return a.low >= 0.0 && a.high <= highest_word ? a : any_of_type(Type::Word);
    case Op::At:
      return a;
    default:
      return integer_operation(op, a, b);
  }
}

}  // namespace hysteron::interval
