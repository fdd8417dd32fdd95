// The bits in which a point's value travels, by its type.
//
// A door gives every value as a double. Integers are exact to 2^53 and are rounded to the nearest, saturated at the
// bounds of the type; a value that is not a number becomes 0 in an integer and stays one in a real.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include "runtime/point.hpp"

namespace hysteron::runtime::modbus {

inline constexpr std::array<PointType, 9> point_types{PointType::boolean, PointType::int16,  PointType::uint16,
                                                      PointType::int32,   PointType::uint32, PointType::int64,
                                                      PointType::uint64,  PointType::real32, PointType::real64};

/// How many registers hold a value of the type; a boolean has one where it stands among registers.
constexpr std::size_t registers_of(PointType type) {
  switch (type) {
    case PointType::boolean:
    case PointType::int16:
    case PointType::uint16:
      return 1;
    case PointType::int32:
    case PointType::uint32:
    case PointType::real32:
      return 2;
    case PointType::int64:
    case PointType::uint64:
    case PointType::real64:
      return 4;
  }
  return 1;
}

constexpr const char* name_of(PointType type) {
  switch (type) {
    case PointType::boolean:
      return "boolean";
    case PointType::int16:
      return "int16";
    case PointType::uint16:
      return "uint16";
    case PointType::int32:
      return "int32";
    case PointType::uint32:
      return "uint32";
    case PointType::int64:
      return "int64";
    case PointType::uint64:
      return "uint64";
    case PointType::real32:
      return "real32";
    case PointType::real64:
      return "real64";
  }
  return "";
}

/// The bits of a value, in the low 16·registers_of(type) bits.
[[nodiscard]] std::uint64_t bits_of(double value, PointType type);

/// The lowest and the highest number that a type holds, and a double exactly.
[[nodiscard]] std::pair<double, double> limits_of(PointType type);

/// Whether the type holds a number, but for the rounding of a real.
[[nodiscard]] bool holds(PointType type, double value);

/// The value of bits; empty where an integer is beyond ±2^53 and a double would not hold it exactly.
[[nodiscard]] std::optional<double> value_of(std::uint64_t bits, PointType type);

}  // namespace hysteron::runtime::modbus
