// Discovery over Modbus itself: a chain of holding registers, in the manner of SunSpec, from which a client without any
// file learns every point's name, unit, type, limits and access.
//
// From chain_address, all numbers with the high word first, whatever the word order of the values:
//   "HYST"                                  2 registers
//   version 1, word order 0 to 3            2 registers
//   the first 128 bits of the map's hash    8 registers
//   number of points                        1 register
// then for each point, sorted by area and address:
//   1, length of what follows in registers  2 registers
//   area (0 coil, 1 discrete, 3 holding, 4 input: the digits of reference numbers), address, type, access and kind
//   low, high                               4 registers each, real64
//   length of the name in bytes, the name   padded to whole registers with 0
//   length of the unit in bytes, the unit   the same
// and at the end 0xFFFF, 0.
// Type and kind are the numbers of PointType and PointKind; access is 0x8000 where the point may be written.
//
// A point that lies in a format of its own has 2 instead of the first 1, a type that may also be 9 or 10, decimal
// digits of 16 and of 32 bits, and behind its unit:
//   scale, offset                           4 registers each, real64: value = scale·raw + offset
//   word order, bit of a register or 0xFFFF 2 registers
//
// The whole chain can also be read by function 20: its register n is record n mod 10000 of file 1 + n div 10000. Where
// it is longer than the holding registers from chain_address on, these have the head with 0 points, and then
//   3, 2, registers of the whole chain      4 registers, the high word first
// and the end. Records that a client does not know are to be skipped by their length.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runtime/modbus/register_map.hpp"

namespace hysteron::runtime::modbus {

/// The whole chain.
[[nodiscard]] std::vector<std::uint16_t> make_chain(const RegisterMap& map);
/// What leads to the map's chain, where that is to be read by function 20.
[[nodiscard]] std::vector<std::uint16_t> make_entrance(const RegisterMap& map);

/// Records of a file of function 20.
inline constexpr std::uint32_t records_of_file = 10000;

struct DiscoveredPoint {
  Point point{};  ///< without its meaning; its type is that of the registers
  Stretch at{};
  PointFormat format{};
};

struct DiscoveredMap {
  WordOrder order = WordOrder::abcd;
  std::string hash{};  ///< its first 32 digits
  std::vector<DiscoveredPoint> points{};
  std::uint32_t in_files = 0;  ///< registers of the whole chain, where it is to be read by function 20
};

/// What a client reads from the chain; empty where the registers are no chain.
[[nodiscard]] std::optional<DiscoveredMap> read_chain(std::span<const std::uint16_t> chain);

}  // namespace hysteron::runtime::modbus
