#include "codegen/language/literal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <string>

#include "codegen/language/token.hpp"
#include "support/errors.hpp"

namespace hysteron::language {
namespace {

constexpr std::uint64_t dint_highest = 2147483647;
constexpr std::uint64_t word_highest = 65535;

bool is_decimal(char c) {
  return c >= '0' && c <= '9';
}

/// Digits with single underscores between them: 1_000.
bool is_digit_group(std::string_view text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool inside = i > 0 && i + 1 < text.size();
    if (!is_decimal(text[i]) && !(text[i] == '_' && inside && is_decimal(text[i - 1]) && is_decimal(text[i + 1]))) {
      return false;
    }
  }
  return !text.empty();
}

std::string without_underscores(std::string_view text) {
  std::string digits(text);
  digits.erase(std::remove(digits.begin(), digits.end(), '_'), digits.end());
  return digits;
}

LiteralError malformed(std::string_view text, std::string mend) {
  return {error::malformed_number, fmt::format("`{}` is not a number of the language.", text), std::move(mend)};
}

LiteralError out_of_range(std::string_view text, std::string_view type, std::string_view range) {
  return {error::number_out_of_range, fmt::format("`{}` does not fit into {}.", text, type),
          fmt::format("{} reaches from {}.", type, range)};
}

constexpr std::string_view dint_range = "-2147483648 to 2147483647; write a real number such as 3.0e9 for more";
constexpr std::string_view word_range = "0 to 65535";
constexpr std::string_view lreal_range = "±4.9e-324 to ±1.8e308";

struct Whole {
  std::uint64_t value = 0;
  bool fits = true;
};

Whole whole(std::string_view digits, int base) {
  const auto plain = without_underscores(digits);
  Whole result;
  const auto [stop, problem] = std::from_chars(plain.data(), plain.data() + plain.size(), result.value, base);
  result.fits = problem == std::errc{};
  return result;
}

/// 16#FF: base, sign, digits of that base with single underscores.
std::variant<Whole, LiteralError> based(std::string_view text, std::size_t mark) {
  const auto base_text = text.substr(0, mark);
  const auto digits = text.substr(mark + 1);
  const int base = base_text == "2" ? 2 : (base_text == "8" ? 8 : (base_text == "16" ? 16 : 0));
  if (base == 0) {
    return malformed(text, "The base before # is 2, 8 or 16.");
  }
  const auto is_digit_of_base = [base](char c) {
    const int digit =
        is_decimal(c) ? c - '0' : (c >= 'A' && c <= 'F' ? c - 'A' + 10 : (c >= 'a' && c <= 'f' ? c - 'a' + 10 : 99));
    return digit < base;
  };
  bool right = !digits.empty();
  for (std::size_t i = 0; i < digits.size(); ++i) {
    const bool inside = i > 0 && i + 1 < digits.size();
    right = right && (is_digit_of_base(digits[i]) || (digits[i] == '_' && inside && digits[i - 1] != '_'));
  }
  if (!right) {
    return malformed(
        text, fmt::format("Behind {}# stand digits of base {}, with single underscores between them.", base, base));
  }
  return whole(digits, base);
}

/// What a number that is nearly right was meant to be: 1. → 1.0, .5 → 0.5, 1e6 → 1.0e6.
std::string repaired(std::string_view text) {
  const auto exponent = text.find_first_of("eE");
  const auto mantissa = text.substr(0, exponent);
  const auto rest = exponent == std::string_view::npos ? std::string_view() : text.substr(exponent + 1);
  const auto digits = rest.substr(rest.empty() || is_decimal(rest[0]) ? 0 : 1);
  const auto point = mantissa.find('.');
  const auto before = mantissa.substr(0, point);
  const auto after = point == std::string_view::npos ? std::string_view() : mantissa.substr(point + 1);
  if ((!before.empty() && !is_digit_group(before)) || (!after.empty() && !is_digit_group(after)) ||
      (exponent != std::string_view::npos && !is_digit_group(digits))) {
    return {};
  }
  return fmt::format("{}.{}{}", before.empty() ? "0" : before, after.empty() ? "0" : after,
                     exponent == std::string_view::npos ? std::string_view() : text.substr(exponent));
}

std::variant<Whole, double, LiteralError> untyped(std::string_view text) {
  if (const auto mark = text.find('#'); mark != std::string_view::npos) {
    const auto result = based(text, mark);
    if (const auto* number = std::get_if<Whole>(&result)) {
      return *number;
    }
    return std::get<LiteralError>(result);
  }
  if (is_digit_group(text)) {
    return whole(text, 10);
  }
  const auto fixed = repaired(text);
  if (fixed != text) {
    return malformed(text, fixed.empty()
                               ? "A number is written 42, 1_000, 16#FF, 1.5 or 1.5e-6, its unit in a comment."
                               : fmt::format("Write {}: a real number has digits on both sides of its point.", fixed));
  }
  const auto plain = without_underscores(text);
  double value = 0.0;
  const auto [stop, problem] = std::from_chars(plain.data(), plain.data() + plain.size(), value);
  if (problem != std::errc{}) {
    return out_of_range(text, "LREAL", lreal_range);
  }
  return value;
}

Literal integer(std::string_view text, Whole number, bool negative, bool is_word) {
  const std::uint64_t highest = is_word ? word_highest : dint_highest + (negative ? 1 : 0);
  if (!number.fits || number.value > highest || (is_word && negative && number.value != 0)) {
    return out_of_range(text, is_word ? "WORD" : "DINT", is_word ? word_range : dint_range);
  }
  const auto value = static_cast<std::int64_t>(number.value);
  return IntLiteral{.value = value, .is_word = is_word};
}

bool is_time_type(std::string_view type) {
  static constexpr std::array<std::string_view, 15> types{
      "T",   "TIME",        "LT",   "LTIME",         "D",  "DATE", "LD",          "LDATE",
      "TOD", "TIME_OF_DAY", "LTOD", "DATE_AND_TIME", "DT", "LDT",  "LTIME_OF_DAY"};
  return std::any_of(types.begin(), types.end(), [type](std::string_view other) { return same_name(type, other); });
}

}  // namespace

Literal number_literal(std::string_view text, bool behind_minus) {
  const auto number = untyped(text);
  if (const auto* value = std::get_if<double>(&number)) {
    return RealLiteral{*value};
  }
  if (const auto* value = std::get_if<Whole>(&number)) {
    return integer(text, *value, behind_minus, false);
  }
  return std::get<LiteralError>(number);
}

Literal typed_literal(std::string_view text) {
  const auto mark = text.find('#');
  const auto type = text.substr(0, mark);
  auto body = text.substr(mark + 1);
  if (is_time_type(type)) {
    return LiteralError{error::time_literal,
                        fmt::format("`{}` is a time or a date, which compilers read differently.", text),
                        "Write the time in seconds as a real number: 5.0e-5 for 50 us."};
  }
  if (!is_elementary_type(type)) {
    return LiteralError{error::refused_type, fmt::format("The type {} before # is not a type of a diagram.", type),
                        "Write LREAL#, DINT#, WORD# or BOOL#, or the number alone."};
  }
  if (same_name(type, "BOOL")) {
    if (same_name(body, "TRUE") || body == "1") {
      return BoolLiteral{true};
    }
    if (same_name(body, "FALSE") || body == "0") {
      return BoolLiteral{false};
    }
    return malformed(text, "A truth value is TRUE or FALSE.");
  }
  const bool negative = !body.empty() && body[0] == '-';
  if (!body.empty() && (body[0] == '-' || body[0] == '+')) {
    body.remove_prefix(1);
  }
  if (body.empty() || !is_decimal(body[0])) {
    return malformed(text, fmt::format("Write a number right behind {}#.", type));
  }
  const auto number = untyped(body);
  if (const auto* problem = std::get_if<LiteralError>(&number)) {
    return *problem;
  }
  const auto* real = std::get_if<double>(&number);
  if (same_name(type, "LREAL")) {
    if (real == nullptr && !std::get<Whole>(number).fits) {
      return out_of_range(text, "LREAL", "0 to 18446744073709551615 without a point; write a point and an exponent");
    }
    const double value = real != nullptr ? *real : static_cast<double>(std::get<Whole>(number).value);
    return RealLiteral{negative ? -value : value};
  }
  if (real != nullptr) {
    return malformed(text, fmt::format("{} holds whole numbers; leave the point out, or write LREAL#.", type));
  }
  auto result = integer(text, std::get<Whole>(number), negative, same_name(type, "WORD"));
  if (const auto* value = std::get_if<IntLiteral>(&result)) {
    return IntLiteral{.value = negative ? -value->value : value->value, .is_word = value->is_word};
  }
  return result;
}

}  // namespace hysteron::language
