// The bits in which a number travels, by the type that lies in the registers: the types of points, and binary-coded
// decimals of four and eight digits, which have a decimal digit in every four bits.
//
// A door gives every value as a double. Integers are exact to 2^53 and are rounded to the nearest, saturated at the
// bounds of the type; a value that is not a number becomes 0 in an integer and stays one in a real. A scale, and what
// may not be written so, is of point_format.hpp.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

#include "runtime/point.hpp"

namespace hysteron::runtime::modbus {

inline constexpr std::array<PointType, 9> point_types{PointType::boolean, PointType::int16,  PointType::uint16,
                                                      PointType::int32,   PointType::uint32, PointType::int64,
                                                      PointType::uint64,  PointType::real32, PointType::real64};

/// A type that lies in registers; every type of a point is one.
struct RegisterType {
  PointType type = PointType::real64;
  bool is_bcd = false;  ///< of uint16 and uint32: decimal digits

  constexpr RegisterType(PointType of = PointType::real64, bool bcd = false)  // NOLINT(google-explicit-constructor)
      : type(of), is_bcd(bcd) {}
  friend bool operator==(const RegisterType&, const RegisterType&) = default;
};

/// In the order in which a run file names them and the discovery numbers them.
inline constexpr std::array<RegisterType, 11> register_types{
    PointType::boolean, PointType::int16,          PointType::uint16,        PointType::int32,
    PointType::uint32,  PointType::int64,          PointType::uint64,        PointType::real32,
    PointType::real64,  {PointType::uint16, true}, {PointType::uint32, true}};

/// How many registers hold a value of the type; a boolean has one where it stands among registers.
constexpr std::size_t registers_of(RegisterType type) {
  switch (type.type) {
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

constexpr bool is_real(RegisterType type) {
  return is_real(type.type);
}

constexpr const char* name_of(RegisterType type) {
  if (type.is_bcd) {
    return registers_of(type) == 1 ? "bcd16" : "bcd32";
  }
  switch (type.type) {
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

[[nodiscard]] std::optional<RegisterType> register_type_named(std::string_view name);

/// The bits of a value, in the low 16·registers_of(type) bits.
[[nodiscard]] std::uint64_t bits_of(double value, RegisterType type);

/// The lowest and the highest number that a type holds, and a double exactly.
[[nodiscard]] std::pair<double, double> limits_of(RegisterType type);

/// Whether the type holds a number, but for the rounding of a real.
[[nodiscard]] bool holds(RegisterType type, double value);

/// The value of bits; empty where an integer is beyond ±2^53 and a double would not hold it exactly, and where a
/// decimal digit is above 9.
[[nodiscard]] std::optional<double> value_of(std::uint64_t bits, RegisterType type);

}  // namespace hysteron::runtime::modbus
