#include "runtime/modbus/point_format.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "support/numbers.hpp"

namespace hysteron::runtime::modbus {
namespace {

/// Of a step: what arithmetic may add to a number that stands on one.
constexpr double rounding = 1e-6;

/// With a unit roundoff u = 2^-53, scale·raw + offset and back is off by no more than u·(4·|raw| + |offset/scale|)
/// steps. Below half a step the nearest is the raw number again: with |raw| ≤ 2^49 and |offset/scale| ≤ 2^50 it is.
constexpr double most_scaled = 0x1p49;
constexpr double most_steps_of_offset = 0x1p50;

/// The raw numbers in use; of unscaled integers of 64 bits those of the type, for a value may be read beyond 2^53.
std::pair<double, double> raw_limits(const PointFormat& format) {
  const auto [low, high] = limits_of(format.type);
  if (registers_of(format.type) < 4 || is_real(format.type)) {
    return {low, high};
  }
  const bool is_signed = format.type == PointType::int64;
  if (format.is_scaled()) {
    return {is_signed ? -most_scaled : 0.0, most_scaled};
  }
  return {is_signed ? -0x1p63 : 0.0, std::nextafter(is_signed ? 0x1p63 : 0x1p64, 0.0)};
}

RawCode encoded_real(double value, const PointFormat& format) {
  const double raw = format.is_scaled() ? (value - format.offset) / format.scale : value;
  const double most = format.type.type == PointType::real32 ? static_cast<double>(std::numeric_limits<float>::max())
                                                            : std::numeric_limits<double>::max();
  const bool is_saturated = std::isfinite(value) && std::abs(raw) > most;
  return {.bits = bits_of(is_saturated ? std::copysign(most, raw) : raw, format.type), .is_saturated = is_saturated};
}

/// The value as the format tells it; nothing where it does not have it, but for rounding.
std::optional<double> as_held(double value, const PointFormat& format) {
  const auto code = encoded(value, format);
  const auto held = code && !code->is_saturated ? decoded(code->bits, format) : std::nullopt;
  const bool is_same = held && (is_real(format.type) || std::abs(*held - value) <= rounding * std::abs(format.scale));
  return is_same ? held : std::nullopt;
}

}  // namespace

std::string flaw_of(const PointFormat& format) {
  if (!std::isfinite(format.scale) || !std::isfinite(format.offset) || !std::isnormal(format.scale)) {
    return fmt::format("has the scale {} and the offset {}, and a scale is a finite number that is not 0",
                       number_text(format.scale), number_text(format.offset));
  }
  if (!format.is_scaled()) {
    return {};
  }
  if (format.type == PointType::boolean) {
    return "is a boolean, which has no scale and no offset";
  }
  const auto [low, high] = raw_limits(format);
  const double reach = std::max(std::abs(low), std::abs(high));
  if (!is_real(format.type) &&
      (!std::isfinite(format.scale * reach) || std::abs(format.offset / format.scale) > most_steps_of_offset)) {
    return fmt::format("has an offset of {} with steps of {}, between which a double cannot tell them apart",
                       number_text(format.offset), number_text(format.scale));
  }
  return {};
}

std::string order_flaw_of(const GivenFormat& given, RegisterType type) {
  return given.order && registers_of(type) == 1 ? "lies in one register, which has no word order" : "";
}

std::string range_flaw_of(const PointFormat& format, double low, double high) {
  const auto [least, most] = limits_of(format);
  const double half = is_real(format.type) ? 0.0 : 0.5 * std::abs(format.scale);
  const bool is_below = std::isfinite(low) && low < least - half;
  const bool is_above = std::isfinite(high) && high > most + half;
  return !is_below && !is_above ? ""
                                : fmt::format("goes from {} to {}, and its format, {}, reaches {:.6g} to {:.6g} alone",
                                              number_text(low), number_text(high), name_of(format.type), least, most);
}

std::optional<RawCode> encoded(double value, const PointFormat& format) {
  if (is_real(format.type)) {
    return encoded_real(value, format);
  }
  if (std::isnan(value)) {
    return std::nullopt;
  }
  if (format.type == PointType::boolean) {
    return RawCode{.bits = bits_of(value, format.type)};
  }
  const double raw = std::nearbyint((value - format.offset) / format.scale);
  const auto [low, high] = raw_limits(format);
  // Without a scale, the bounds are those of the type itself.
  const double reached = format.is_scaled() ? std::clamp(raw, low, high) : raw;
  return RawCode{.bits = bits_of(reached, format.type), .is_saturated = raw < low || raw > high};
}

std::optional<double> decoded(std::uint64_t bits, const PointFormat& format) {
  const auto raw = value_of(bits, format.type);
  if (!raw || !format.is_scaled()) {
    return raw;
  }
  const auto [low, high] = raw_limits(format);
  const bool is_exact = is_real(format.type) || (*raw >= low && *raw <= high);
  return is_exact ? std::optional(format.scale * *raw + format.offset) : std::nullopt;
}

std::optional<double> taken(std::uint64_t bits, const PointFormat& format, double low, double high) {
  const auto value = decoded(bits, format);
  const bool is_within = value && std::isfinite(*value) &&
                         *value >= std::min(low, as_held(low, format).value_or(low)) &&
                         *value <= std::max(high, as_held(high, format).value_or(high));
  return is_within ? std::optional(std::min(std::max(*value, low), high)) : std::nullopt;
}

std::pair<double, double> limits_of(const PointFormat& format) {
  if (!format.is_scaled()) {
    return limits_of(format.type);
  }
  const auto [low, high] = raw_limits(format);
  return std::minmax({format.scale * low + format.offset, format.scale * high + format.offset});
}

bool holds(const PointFormat& format, double value) {
  return as_held(value, format).has_value();
}

}  // namespace hysteron::runtime::modbus
