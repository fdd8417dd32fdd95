#include "runtime/modbus/value_bits.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <type_traits>

namespace hysteron::runtime::modbus {
namespace {

template <class Integer>
std::uint64_t integer_bits(double value) {
  using Limits = std::numeric_limits<Integer>;
  using Unsigned = std::make_unsigned_t<Integer>;
  if (std::isnan(value)) {
    return 0;
  }
  const double whole = std::nearbyint(value);
  // The upper bound of a type is no double where it has 64 bits; the power of two above it is.
  const double above = std::ldexp(1.0, Limits::digits);
  if (whole >= above) {
    return static_cast<Unsigned>(Limits::max());
  }
  if (whole < static_cast<double>(Limits::min())) {
    return static_cast<Unsigned>(Limits::min());
  }
  return static_cast<Unsigned>(static_cast<Integer>(whole));
}

constexpr std::uint64_t most_of_bcd(RegisterType type) {
  return registers_of(type) == 1 ? 9'999 : 99'999'999;
}

std::uint64_t decimal_bits(double value, RegisterType type) {
  std::uint64_t number = std::min(integer_bits<std::uint32_t>(value), most_of_bcd(type));
  std::uint64_t bits = 0;
  for (unsigned shift = 0; number > 0; shift += 4, number /= 10) {
    bits |= number % 10 << shift;
  }
  return bits;
}

std::optional<double> decimal_value(std::uint64_t bits, RegisterType type) {
  double number = 0.0;
  for (auto digit = static_cast<unsigned>(4 * registers_of(type)); digit-- > 0;) {
    const std::uint64_t one = bits >> 4 * digit & 0xFU;
    if (one > 9) {
      return std::nullopt;
    }
    number = 10.0 * number + static_cast<double>(one);
  }
  return number;
}

}  // namespace

std::optional<RegisterType> register_type_named(std::string_view name) {
  const auto* const found =
      std::ranges::find_if(register_types, [&](RegisterType type) { return name_of(type) == name; });
  return found == register_types.end() ? std::nullopt : std::optional(*found);
}

std::uint64_t bits_of(double value, RegisterType type) {
  if (type.is_bcd) {
    return decimal_bits(value, type);
  }
  switch (type.type) {
    case PointType::boolean:
      return value != 0.0 && !std::isnan(value) ? 1 : 0;
    case PointType::int16:
      return integer_bits<std::int16_t>(value);
    case PointType::uint16:
      return integer_bits<std::uint16_t>(value);
    case PointType::int32:
      return integer_bits<std::int32_t>(value);
    case PointType::uint32:
      return integer_bits<std::uint32_t>(value);
    case PointType::int64:
      return integer_bits<std::int64_t>(value);
    case PointType::uint64:
      return integer_bits<std::uint64_t>(value);
    case PointType::real32:
      return std::bit_cast<std::uint32_t>(static_cast<float>(value));
    case PointType::real64:
      return std::bit_cast<std::uint64_t>(value);
  }
  return 0;
}

std::pair<double, double> limits_of(RegisterType type) {
  return type.is_bcd ? std::pair(0.0, static_cast<double>(most_of_bcd(type))) : type_limits(type.type);
}

bool holds(RegisterType type, double value) {
  const auto [low, high] = limits_of(type);
  return value >= low && value <= high && (is_real(type) || value == std::trunc(value));
}

std::optional<double> value_of(std::uint64_t bits, RegisterType type) {
  constexpr std::int64_t exact = std::int64_t{1} << 53U;
  if (type.is_bcd) {
    return decimal_value(bits, type);
  }
  switch (type.type) {
    case PointType::boolean:
      return bits != 0 ? 1.0 : 0.0;
    case PointType::int16:
      return static_cast<std::int16_t>(bits);
    case PointType::uint16:
      return static_cast<std::uint16_t>(bits);
    case PointType::int32:
      return static_cast<std::int32_t>(bits);
    case PointType::uint32:
      return static_cast<std::uint32_t>(bits);
    case PointType::int64: {
      const auto whole = static_cast<std::int64_t>(bits);
      if (whole > exact || whole < -exact) {
        return std::nullopt;
      }
      return static_cast<double>(whole);
    }
    case PointType::uint64:
      if (bits > static_cast<std::uint64_t>(exact)) {
        return std::nullopt;
      }
      return static_cast<double>(bits);
    case PointType::real32:
      return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
    case PointType::real64:
      return std::bit_cast<double>(bits);
  }
  return std::nullopt;
}

}  // namespace hysteron::runtime::modbus
