// Numbers as text: the shortest text that reads back to the same bits, and a strict reader. No locale is involved.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

namespace hysteron {

inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// The shortest decimal text that reads back to the same bits: 0.1, 25, -1e-11. Plain from 1e-5 up to 1e16, with an
/// exponent outside. Infinities and not-a-number are "inf", "-inf" and "nan".
[[nodiscard]] std::string number_text(double value);
[[nodiscard]] std::string number_text(float value);

/// The same digits as a real literal, which always has a point with digits on both sides: 25.0, -1.0e-11. C++, C,
/// Structured Text and TOML all read it as a real number. The value must be finite.
[[nodiscard]] std::string real_literal(double value);
[[nodiscard]] std::string real_literal(float value);

/// Two numbers with as many significant digits as show their difference to a tenth of itself, `digits` at least: 0.1013
/// and 0.1009 where three would give 0.101 twice. Equal numbers have equal texts.
[[nodiscard]] std::pair<std::string, std::string> distinct_texts(double a, double b, int digits);

enum class NumberStatus : std::uint8_t {
  Finite,
  NotFinite,   ///< inf, nan, as such
  OutOfRange,  ///< a number that no double holds: 1e400, 1e-400
  NotANumber
};

struct ParsedNumber {
  double value = 0.0;
  NumberStatus status = NumberStatus::NotANumber;
};

/// Reads the whole text as a decimal number: an optional sign, digits with at most one point, an optional exponent.
/// Spaces, hexadecimal digits, thousands separators and rests of text are refused. Correctly rounded.
[[nodiscard]] ParsedNumber parse_number(std::string_view text);

}  // namespace hysteron
