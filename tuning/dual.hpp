// Dual numbers: a value and its gradient with respect to N parameters, carried through every operation.
//
// A block, or a whole interpreter, run with Dual<N> as its scalar gives beside each output the exact derivatives
// ∂output/∂θ₁ … ∂output/∂θ_N. Seed a parameter with Dual<N>::variable(value, index); everything else is a constant,
// Dual<N>(value). The value goes through exactly the operations that double goes through, so that a rollout with
// duals gives the bits of the plain one, and a comparison decides as it would there.
//
// Where a function has no derivative, one is chosen so that a single sample there cannot spoil the gradient of a
// whole rollout with a NaN (∞ · 0):
//
//   abs at 0                            0, as a central difference gives
//   min, max of equal values            the derivative of the first, whose value is also the one returned
//   select                              the derivative of the side chosen
//   sqrt at 0, asin and acos at ±1      0, where the one-sided derivative is infinite
//   power at base 0                     see power
//   to_int, comparisons                 step functions: no derivative
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "blocks/filtered_rate.hpp"
#include "blocks/scalar.hpp"
#include "support/single.hpp"

namespace hysteron {

/// A register of so many numbers.
template <int W>
struct Register;
template <>
struct Register<2> {
  using Type [[gnu::vector_size(16)]] = double;
};
template <>
struct Register<4> {
  using Type [[gnu::vector_size(32)]] = double;
};
template <>
struct Register<8> {
  using Type [[gnu::vector_size(64)]] = double;
};

/// W is the width of a register in numbers: 2, 4 or 8. It changes no bit, only what the code is compiled for. The
/// alignment is stated, since code with and without such registers shares duals.
template <int N, int W = 2>
class alignas(8 * W) Dual {
  static_assert(N > 0, "a dual number has at least one derivative");

 public:
  using Gradient = std::array<double, static_cast<std::size_t>(N)>;

  constexpr Dual() = default;
  /// A constant: its gradient is 0.
  constexpr explicit Dual(double value) : parts_{Part{value}} {}
  Dual(double value, const Gradient& gradient) : Dual(value) {
    for (std::size_t i = 0; i < gradient.size(); ++i) {
      set(i + 1, gradient[i]);
    }
  }
  /// The parameter with this index: the gradient is 1 there and 0 elsewhere.
  static Dual variable(double value, int index) {
    Dual result(value);
    result.set(static_cast<std::size_t>(index) + 1, 1.0);
    return result;
  }

  [[nodiscard]] double value() const { return parts_[0][0]; }
  [[nodiscard]] Gradient gradient() const {
    Gradient result;
    for (std::size_t i = 0; i < result.size(); ++i) {
      result[i] = get(i + 1);
    }
    return result;
  }
  [[nodiscard]] double derivative(int index) const { return get(static_cast<std::size_t>(index) + 1); }

  friend Dual operator-(const Dual& a) { return chain(-a.value(), -1.0, a); }
  friend Dual operator+(const Dual& a, const Dual& b) {
    Dual result;
    for (std::size_t i = 0; i < size; ++i) {
      result.parts_[i] = a.parts_[i] + b.parts_[i];
    }
    return result;
  }
  friend Dual operator-(const Dual& a, const Dual& b) {
    Dual result;
    for (std::size_t i = 0; i < size; ++i) {
      result.parts_[i] = a.parts_[i] - b.parts_[i];
    }
    return result;
  }
  friend Dual operator*(const Dual& a, const Dual& b) {
    return chain(a.value() * b.value(), b.value(), a, a.value(), b);
  }
  friend Dual operator/(const Dual& a, const Dual& b) {
    // d(a/b) = (da − (a/b)·db) / b
    const double quotient = a.value() / b.value();
    const double inverse = 1.0 / b.value();
    return chain(quotient, inverse, a, -quotient * inverse, b);
  }

  friend bool operator<(const Dual& a, const Dual& b) { return a.value() < b.value(); }
  friend bool operator<=(const Dual& a, const Dual& b) { return a.value() <= b.value(); }
  friend bool operator>(const Dual& a, const Dual& b) { return a.value() > b.value(); }
  friend bool operator>=(const Dual& a, const Dual& b) { return a.value() >= b.value(); }
  friend bool operator==(const Dual& a, const Dual& b) { return a.value() == b.value(); }
  friend bool operator!=(const Dual& a, const Dual& b) { return a.value() != b.value(); }

  friend Dual abs(const Dual& x) {
    const double sign = static_cast<double>(x.value() > 0.0) - static_cast<double>(x.value() < 0.0);
    return chain(std::fabs(x.value()), sign, x);
  }
  friend Dual sqrt(const Dual& x) {
    const double root = std::sqrt(x.value());
    return chain(root, x.value() == 0.0 ? 0.0 : 0.5 / root, x);
  }
  friend Dual exp(const Dual& x) {
    const double result = std::exp(x.value());
    return chain(result, result, x);
  }
  /// The slope by the closed form: through the series of decayed_part it would cost a dozen products of duals.
  friend Dual decayed_part(const Dual& u) {
    const double part = hysteron::decayed_part(u.value());
    return chain(part, 1.0 - part, u);
  }
  friend Dual log(const Dual& x) { return chain(std::log(x.value()), 1.0 / x.value(), x); }
  friend Dual sin(const Dual& x) { return chain(std::sin(x.value()), std::cos(x.value()), x); }
  friend Dual cos(const Dual& x) { return chain(std::cos(x.value()), -std::sin(x.value()), x); }
  friend Dual tan(const Dual& x) {
    const double tangent = std::tan(x.value());
    return chain(tangent, 1.0 + tangent * tangent, x);
  }
  friend Dual asin(const Dual& x) { return chain(std::asin(x.value()), arc_slope(x.value()), x); }
  friend Dual acos(const Dual& x) { return chain(std::acos(x.value()), -arc_slope(x.value()), x); }
  friend Dual atan(const Dual& x) { return chain(std::atan(x.value()), 1.0 / (1.0 + x.value() * x.value()), x); }

  /// base^exponent, with the value of power(double, double) to the bit.
  ///
  /// ∂/∂base = exponent·base^(exponent−1) and ∂/∂exponent = base^exponent·log(base); the latter also where the
  /// value takes a shortcut (exponent 0, ½, 1, 2): the shortcut is a faster way to the same function, not another
  /// function. At base 0:
  /// - ∂/∂exponent is 0, the limit of base^exponent·log(base) for every positive exponent;
  /// - ∂/∂base is 1 for exponent 1, and 0 for every other. Above 1 that is exact. Below 1 the slope is infinite; the
  ///   momentum p is 0 only in the one sample at a branching point, where p does not depend on the parameters, so
  ///   that the true contribution is 0 and ∞ · 0 would lose it.
  /// At a negative base a real power exists for whole exponents alone, so that there is no derivative with respect
  /// to the exponent; it is taken as 0.
  friend Dual power(const Dual& base, const Dual& exponent) {
    const double b = base.value();
    const double e = exponent.value();
    const double result = power(b, e);
    double by_base = 0.0;
    if (e == 1.0) {
      by_base = 1.0;
    } else if (e == 2.0) {
      by_base = 2.0 * b;
    } else if (b != 0.0) {
      by_base = e * result / b;
    }
    if (b > 0.0 && !exponent.is_constant()) {
      return chain(result, by_base, base, result * std::log(b), exponent);
    }
    return chain(result, by_base, base);
  }

  friend Dual min(const Dual& a, const Dual& b) { return b.value() < a.value() ? b : a; }
  friend Dual max(const Dual& a, const Dual& b) { return b.value() > a.value() ? b : a; }

  /// To the nearest REAL: a step function of tiny steps, whose derivative is that of the line through them.
  friend Dual single(const Dual& x) { return chain(nearest_single(x.value()), 1.0, x); }
  friend std::int32_t to_int(const Dual& x) { return to_int(x.value()); }
  friend bool vanishes(const Dual& x) { return x.value() == 0.0 && x.is_constant(); }
  friend double value_of(const Dual& x) { return x.value(); }

 private:
  /// Value and gradient in one row of registers, the value first. Every operation then writes whole registers, as the
  /// compiler reads them when it copies a Dual; with a lone value, each copy waited for its stores.
  using Part = typename Register<W>::Type;
  static constexpr std::size_t width = W;
  static constexpr std::size_t size = (static_cast<std::size_t>(N) + width) / width;

  [[nodiscard]] double get(std::size_t place) const { return parts_[place / width][place % width]; }
  void set(std::size_t place, double number) { parts_[place / width][place % width] = number; }

  /// f(a) with df = slope·da. The first part is put together before it is written: who reads one of which an element
  /// was written by itself waits for the store.
  static Dual chain(double value, double slope, const Dual& a) {
    Dual result;
    Part first = slope * a.parts_[0];
    first[0] = value;
    result.parts_[0] = first;
    for (std::size_t i = 1; i < size; ++i) {
      result.parts_[i] = slope * a.parts_[i];
    }
    return result;
  }
  /// f(a, b) with df = by_a·da + by_b·db.
  static Dual chain(double value, double by_a, const Dual& a, double by_b, const Dual& b) {
    Dual result;
    Part first = by_a * a.parts_[0] + by_b * b.parts_[0];
    first[0] = value;
    result.parts_[0] = first;
    for (std::size_t i = 1; i < size; ++i) {
      result.parts_[i] = by_a * a.parts_[i] + by_b * b.parts_[i];
    }
    return result;
  }
  /// d asin(x)/dx; 0 at the ends, where it is infinite.
  static double arc_slope(double x) {
    const double square = (1.0 - x) * (1.0 + x);
    return square == 0.0 ? 0.0 : 1.0 / std::sqrt(square);
  }
  [[nodiscard]] bool is_constant() const {
    bool constant = true;
    for (std::size_t i = 1; i <= static_cast<std::size_t>(N); ++i) {
      constant = constant && get(i) == 0.0;
    }
    return constant;
  }

  std::array<Part, size> parts_{};
};

}  // namespace hysteron
