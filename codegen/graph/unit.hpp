// A unit as a number to compute with: a factor to the SI, powers of the base dimensions, and a block's unit variables.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numeric>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace hysteron::units {

/// An exponent: a fraction in lowest terms.
struct Fraction {
  std::int32_t over = 0;
  std::int32_t under = 1;

  static Fraction of(std::int64_t numerator, std::int64_t denominator) {
    if (denominator == 1) {
      return {static_cast<std::int32_t>(numerator), 1};
    }
    const std::int64_t divisor = std::gcd(numerator, denominator) * (denominator < 0 ? -1 : 1);
    return {static_cast<std::int32_t>(numerator / divisor), static_cast<std::int32_t>(denominator / divisor)};
  }
  friend Fraction operator+(Fraction a, Fraction b) {
    return of(std::int64_t{a.over} * b.under + std::int64_t{b.over} * a.under, std::int64_t{a.under} * b.under);
  }
  friend Fraction operator*(Fraction a, Fraction b) {
    return of(std::int64_t{a.over} * b.over, std::int64_t{a.under} * b.under);
  }
  [[nodiscard]] bool zero() const { return over == 0; }
  [[nodiscard]] Fraction inverse() const { return of(under, over); }
  [[nodiscard]] double number() const { return static_cast<double>(over) / under; }
};

// The base dimensions: those of the SI without the mole and the candela's kin, and a temperature scale of its own for
// °C, whose zero is elsewhere. Behind them the marks of angles: the SI has both rad and a cycle as 1, so that either
// may be left away, but a radian is no cycle, and rad/s no Hz.
constexpr std::size_t dimensions = 8;  // m kg s A K degC mol cd
constexpr std::size_t radians = dimensions;
constexpr std::size_t cycles = dimensions + 1;
using Powers = std::array<Fraction, dimensions + 2>;

/// A unit: a factor to the SI, powers of the base dimensions and, in a block, of its unit variables.
struct Unit {
  double factor = 1.0;
  Powers powers{};
  std::vector<std::pair<std::uint32_t, Fraction>> variables{};   ///< sorted by variable
  std::vector<std::pair<std::string_view, Fraction>> symbols{};  ///< as it was written, for messages
  bool declared = false;  ///< an @unit of the text is a part of it, not the descriptions of blocks alone

  void multiply(const Unit& other, Fraction exponent) {
    declared = declared || other.declared;
    factor *= other.factor == 1.0 ? 1.0 : std::pow(other.factor, exponent.number());
    for (std::size_t i = 0; i < powers.size(); ++i) {
      if (!other.powers[i].zero()) {
        powers[i] = powers[i] + other.powers[i] * exponent;
      }
    }
    for (const auto& [variable, power] : other.variables) {
      add_variable(variable, power * exponent);
    }
    for (const auto& [symbol, power] : other.symbols) {
      add_symbol(symbol, power * exponent);
    }
  }
  void add_symbol(std::string_view symbol, Fraction power) {
    const auto place = std::ranges::find(symbols, symbol, [](const auto& one) { return one.first; });
    if (place == symbols.end()) {
      symbols.emplace_back(symbol, power);
    } else {
      place->second = place->second + power;
      if (place->second.zero()) {
        symbols.erase(place);
      }
    }
  }
  void add_variable(std::uint32_t variable, Fraction power) {
    const auto place = std::ranges::lower_bound(variables, variable, {}, [](const auto& one) { return one.first; });
    if (place == variables.end() || place->first != variable) {
      variables.insert(place, {variable, power});
    } else {
      place->second = place->second + power;
      if (place->second.zero()) {
        variables.erase(place);
      }
    }
  }
  [[nodiscard]] bool same_dimension(const Unit& other) const {
    for (std::size_t i = 0; i < dimensions; ++i) {
      if (!(powers[i] + other.powers[i] * Fraction{-1, 1}).zero()) {
        return false;
      }
    }
    return true;
  }
};

/// The number of the second unit in one of the first (mm in m: 1000); nothing where their dimensions differ. Radians
/// where cycles are expected, and the reverse, count by 2π; where only one side has them, they are plain numbers.
std::optional<double> conversion(const Unit& from, const Unit& to);

/// Whether two factors to the SI are the same but for rounding.
inline bool same_size(double a, double b) {
  return std::abs(a / b - 1.0) < 1e-9;
}

/// Gives the number of a unit variable ('x) by its name.
using UnitVariable = std::function<std::uint32_t(std::string_view)>;

/// Reads `um/V`, `'y/'x`, `kg*m^2/s^2`, `'x^(1/2)`, `1/(m*K)`. Nothing and a reason where it is none.
std::optional<Unit> parse_unit(std::string_view text, std::string& reason, const UnitVariable& variable = {});

/// A unit in the symbols in which it was written: um/V, N*m/s^2, m^(1/2).
std::string unit_text(const Unit& unit);

}  // namespace hysteron::units
