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
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runtime/modbus/register_map.hpp"

namespace hysteron::runtime::modbus {

[[nodiscard]] std::vector<std::uint16_t> make_chain(const RegisterMap& map);

struct DiscoveredPoint {
  Point point{};  ///< without its meaning
  Stretch at{};
};

struct DiscoveredMap {
  WordOrder order = WordOrder::abcd;
  std::string hash{};  ///< its first 32 digits
  std::vector<DiscoveredPoint> points{};
};

/// What a client reads from the chain; empty where the registers are no chain.
[[nodiscard]] std::optional<DiscoveredMap> read_chain(std::span<const std::uint16_t> chain);

}  // namespace hysteron::runtime::modbus
