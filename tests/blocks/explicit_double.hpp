// A scalar that converts to nothing and from nothing but a written S(0.5).
//
// A block that compiles with it uses the vocabulary of blocks/scalar.hpp alone: no stray literal of another type, no
// truth value in an `if`, no std:: function. It computes with the bits of double. (After Sleipnir's ExplicitDouble.)
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>

#include "blocks/scalar.hpp"

namespace hysteron::testing {

/// A value that is made only from exactly Value, and read only by value().
template <class Value, class Tag>
class Explicit {
 public:
  constexpr Explicit() = default;
  template <std::same_as<Value> V>
  constexpr explicit Explicit(V value) : value_(value) {}
  [[nodiscard]] constexpr Value value() const { return value_; }

 private:
  Value value_{};
};

using ExplicitDouble = Explicit<double, struct RealTag>;
using ExplicitBool = Explicit<bool, struct BoolTag>;
using ExplicitInt = Explicit<std::int32_t, struct IntTag>;
using ExplicitWord = Explicit<std::uint16_t, struct WordTag>;

template <class T>
concept ExplicitNumber = std::same_as<T, ExplicitDouble> || std::same_as<T, ExplicitInt>;

template <ExplicitNumber T>
T operator+(const T& a, const T& b) {
  return T(a.value() + b.value());
}
template <ExplicitNumber T>
T operator-(const T& a, const T& b) {
  return T(a.value() - b.value());
}
template <ExplicitNumber T>
T operator*(const T& a, const T& b) {
  return T(a.value() * b.value());
}
template <ExplicitNumber T>
T operator/(const T& a, const T& b) {
  return T(a.value() / b.value());
}
template <ExplicitNumber T>
T operator-(const T& a) {
  return T(-a.value());
}
inline ExplicitInt operator%(const ExplicitInt& a, const ExplicitInt& b) {
  return ExplicitInt(a.value() % b.value());
}

template <ExplicitNumber T>
ExplicitBool operator<(const T& a, const T& b) {
  return ExplicitBool(a.value() < b.value());
}
template <ExplicitNumber T>
ExplicitBool operator<=(const T& a, const T& b) {
  return ExplicitBool(a.value() <= b.value());
}
template <ExplicitNumber T>
ExplicitBool operator>(const T& a, const T& b) {
  return ExplicitBool(a.value() > b.value());
}
template <ExplicitNumber T>
ExplicitBool operator>=(const T& a, const T& b) {
  return ExplicitBool(a.value() >= b.value());
}
template <class Value, class Tag>
ExplicitBool operator==(const Explicit<Value, Tag>& a, const Explicit<Value, Tag>& b) {
  return ExplicitBool(a.value() == b.value());
}
template <class Value, class Tag>
ExplicitBool operator!=(const Explicit<Value, Tag>& a, const Explicit<Value, Tag>& b) {
  return ExplicitBool(a.value() != b.value());
}
inline ExplicitBool operator&&(const ExplicitBool& a, const ExplicitBool& b) {
  return ExplicitBool(a.value() && b.value());
}
inline ExplicitBool operator||(const ExplicitBool& a, const ExplicitBool& b) {
  return ExplicitBool(a.value() || b.value());
}
inline ExplicitBool operator!(const ExplicitBool& a) {
  return ExplicitBool(!a.value());
}

inline ExplicitDouble abs(const ExplicitDouble& x) {
  return ExplicitDouble(hysteron::abs(x.value()));
}
inline ExplicitDouble sqrt(const ExplicitDouble& x) {
  return ExplicitDouble(hysteron::sqrt(x.value()));
}
inline ExplicitDouble exp(const ExplicitDouble& x) {
  return ExplicitDouble(hysteron::exp(x.value()));
}
inline ExplicitDouble log(const ExplicitDouble& x) {
  return ExplicitDouble(hysteron::log(x.value()));
}
inline ExplicitDouble sin(const ExplicitDouble& x) {
  return ExplicitDouble(hysteron::sin(x.value()));
}
inline ExplicitDouble cos(const ExplicitDouble& x) {
  return ExplicitDouble(hysteron::cos(x.value()));
}
inline ExplicitDouble tan(const ExplicitDouble& x) {
  return ExplicitDouble(hysteron::tan(x.value()));
}
inline ExplicitDouble asin(const ExplicitDouble& x) {
  return ExplicitDouble(hysteron::asin(x.value()));
}
inline ExplicitDouble acos(const ExplicitDouble& x) {
  return ExplicitDouble(hysteron::acos(x.value()));
}
inline ExplicitDouble atan(const ExplicitDouble& x) {
  return ExplicitDouble(hysteron::atan(x.value()));
}
inline ExplicitDouble power(const ExplicitDouble& base, const ExplicitDouble& exponent) {
  return ExplicitDouble(hysteron::power(base.value(), exponent.value()));
}
template <ExplicitNumber T>
T min(const T& a, const T& b) {
  return T(hysteron::min(a.value(), b.value()));
}
template <ExplicitNumber T>
T max(const T& a, const T& b) {
  return T(hysteron::max(a.value(), b.value()));
}

template <class T, class Tag>
Explicit<T, Tag> select(const ExplicitBool& condition, const Explicit<T, Tag>& a, const Explicit<T, Tag>& b) {
  return condition.value() ? a : b;
}
inline ExplicitInt to_int(const ExplicitDouble& x) {
  return ExplicitInt(hysteron::to_int(x.value()));
}
template <class S>
requires std::same_as<S, ExplicitDouble> S to_real(const ExplicitInt& i) {
  return S(static_cast<double>(i.value()));
}
template <std::size_t N>
const ExplicitDouble& at(const std::array<ExplicitDouble, N>& array, const ExplicitInt& index) {
  return hysteron::at(array, index.value());
}
template <std::size_t N>
void store(std::array<ExplicitDouble, N>& array, const ExplicitInt& index, const ExplicitDouble& value) {
  hysteron::store(array, index.value(), value);
}

}  // namespace hysteron::testing

namespace hysteron {

template <>
struct ScalarTypes<testing::ExplicitDouble> {
  using Bool = testing::ExplicitBool;
  using Int = testing::ExplicitInt;
  using Word = testing::ExplicitWord;
  template <std::size_t N>
  using Array = std::array<testing::ExplicitDouble, N>;
};

}  // namespace hysteron
