#include "support/numbers.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <system_error>

namespace hysteron {
namespace {

/// The shortest digits d₁d₂… of a finite number and its decimal exponent: ±d₁.d₂… · 10^exponent.
struct Decimal {
  std::array<char, 48> text{};  ///< holds the digits
  std::string_view digits{};
  int exponent = 0;
  bool negative = false;
};

template <class Real>
void shortest(Real value, Decimal& result) {
  char* begin = result.text.data();
  const char* const end = std::to_chars(begin, begin + result.text.size(), value, std::chars_format::scientific).ptr;
  if (*begin == '-') {
    result.negative = true;
    ++begin;
  }
  // d.ddde±xx: the first digit goes over the point
  const char* const mark = static_cast<const char*>(std::memchr(begin, 'e', static_cast<std::size_t>(end - begin)));
  if (begin[1] == '.') {
    begin[1] = begin[0];
    ++begin;
  }
  result.digits = {begin, static_cast<std::size_t>(mark - begin)};
  for (const char* digit = mark + 2; digit != end; ++digit) {
    result.exponent = 10 * result.exponent + (*digit - '0');
  }
  result.exponent = mark[1] == '-' ? -result.exponent : result.exponent;
}

template <class Real>
std::string to_text(Real value, bool literal) {
  if (std::isnan(value)) {
    return "nan";
  }
  if (std::isinf(value)) {
    return value < 0 ? "-inf" : "inf";
  }
  Decimal decimal;
  shortest(value, decimal);
  const std::string_view digits = decimal.digits;
  std::string text = decimal.negative ? "-" : "";
  if (decimal.exponent < -5 || decimal.exponent > 15) {
    text += digits.front();
    if (digits.size() > 1) {
      text.append(".").append(digits, 1);
    } else if (literal) {
      text += ".0";
    }
    return text.append("e").append(std::to_string(decimal.exponent));
  }
  if (decimal.exponent < 0) {
    return text.append("0.").append(static_cast<std::size_t>(-decimal.exponent - 1), '0').append(digits);
  }
  const auto before_point = static_cast<std::size_t>(decimal.exponent) + 1;
  if (digits.size() > before_point) {
    return text.append(digits, 0, before_point).append(".").append(digits, before_point);
  }
  return text.append(digits).append(before_point - digits.size(), '0').append(literal ? ".0" : "");
}

}  // namespace

std::string number_text(double value) {
  return to_text(value, false);
}
std::string number_text(float value) {
  return to_text(value, false);
}
std::string real_literal(double value) {
  return to_text(value, true);
}
std::string real_literal(float value) {
  return to_text(value, true);
}

std::pair<std::string, std::string> distinct_texts(double a, double b, int digits) {
  constexpr int all_of_them = 17;  // digits that tell any two doubles apart
  const double difference = a - b;
  for (;; ++digits) {
    std::pair<std::string, std::string> texts{fmt::format("{:.{}g}", a, digits), fmt::format("{:.{}g}", b, digits)};
    const double shown = parse_number(texts.first).value - parse_number(texts.second).value;
    const bool is_shown = std::abs(shown - difference) <= 0.1 * std::abs(difference);
    if (is_shown || !std::isfinite(difference) || digits >= all_of_them) {
      return texts;
    }
  }
}

ParsedNumber parse_number(std::string_view text) {
  ParsedNumber result;
  const char* begin = text.data();
  const char* const end = begin + text.size();
  if (begin != end && *begin == '+') {
    ++begin;  // from_chars knows only the minus
    if (begin != end && *begin == '-') {
      return result;
    }
  }
  const auto read = std::from_chars(begin, end, result.value);
  if (read.ptr != end || read.ec == std::errc::invalid_argument) {
    return {};
  }
  if (read.ec == std::errc::result_out_of_range) {
    result.value = 0.0;
    result.status = NumberStatus::OutOfRange;
  } else {
    result.status = std::isfinite(result.value) ? NumberStatus::Finite : NumberStatus::NotFinite;
  }
  return result;
}

}  // namespace hysteron
