// The register map: where each point lies for a Modbus client.
//
// The map is derived from the points. Booleans are coils where they may be written and discrete inputs where not; other
// values are holding or input registers, aligned to their width. A lock file keeps the addresses through edits of the
// diagram: a point that stays keeps its address, and the address of a point that went is given to nobody else.
// A map has a hash, by which a client knows that it speaks to the diagram that it was made for. A point lies in the
// registers as its type, unless the user gives it a format (point_format.hpp) or an address of its own. A boolean may
// be a bit of a register, and shares that with others.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/modbus/point_format.hpp"
#include "runtime/point.hpp"
#include "support/diagnostic.hpp"

namespace hysteron::runtime::modbus {

enum class Area : std::uint8_t { coil, discrete_input, holding_register, input_register };

inline constexpr std::array<Area, 4> areas{Area::coil, Area::discrete_input, Area::holding_register,
                                           Area::input_register};

/// As lock files write it: coil, discrete, holding, input.
[[nodiscard]] std::string_view name_of(Area area);
[[nodiscard]] constexpr bool holds_bits(Area area) {
  return area == Area::coil || area == Area::discrete_input;
}

inline constexpr std::int8_t no_bit = -1;

/// A stretch of addresses in one area, or one bit of a register.
struct Stretch {
  Area area = Area::holding_register;
  std::uint32_t address = 0;
  std::uint32_t count = 1;
  std::int8_t bit = no_bit;  ///< 0, the lowest, to 15
  [[nodiscard]] bool is_bit() const { return bit != no_bit; }
  /// Whether a boolean lies here, and nothing else can.
  [[nodiscard]] bool is_boolean() const { return holds_bits(area) || is_bit(); }
  /// The lowest bit of its register that it has: of a bit, that one; else 0.
  [[nodiscard]] unsigned shift() const { return is_bit() ? static_cast<unsigned>(bit) : 0U; }
  [[nodiscard]] bool overlaps(const Stretch& other) const {
    const bool are_bits_apart = is_bit() && other.is_bit() && bit != other.bit;
    return area == other.area && address < other.address + other.count && other.address < address + count &&
           !are_bits_apart;
  }
  friend bool operator==(const Stretch&, const Stretch&) = default;
};

struct MapEntry {
  std::size_t point = 0;  ///< index into points()
  Stretch at{};
  PointFormat format{};
};

/// An address that a lock file keeps for a point that is no longer there, or not exposed.
struct RetiredAddress {
  Stretch at{};
  RegisterType type = PointType::boolean;
  std::string name{};
};

enum class Placing : std::uint8_t {
  compact,  ///< wide values first, from address 0, without holes
  openplc,  ///< as OpenPLC does: %QX, %IX, %IW, %QW, %MW, then %MD and %ML for 32 and 64 bits
};

/// An address that the user gives: %QX0.3, %QW5, %MD2, or an area and a number as in a lock file: holding 16,
/// holding 16.3. Or a format, or both.
struct GivenRegister {
  std::string name{};
  std::string address{};  ///< empty: where any other would lie
  std::optional<GivenFormat> format{};
  Place place{};
  Place address_place{};
};

struct MapRequest {
  std::string title{};  ///< the diagram's name
  Placing placing = Placing::compact;
  WordOrder order = WordOrder::abcd;
  bool has_discovery = true;  ///< else points may lie where its chain would
  /// Names of points, or what they begin with and a star behind it; none: all points. The others have no address.
  std::vector<std::string> expose{};
  Place expose_place{};
  std::vector<GivenRegister> given{};
  std::string lock_file{};  ///< the path, for messages
  std::string lock_text{};  ///< empty where there is none yet
};

/// Where the discovery chain starts, among the holding registers; the address is SunSpec's. Points lie below where
/// there is one.
inline constexpr std::uint32_t chain_address = 40000;

class RegisterMap {
 public:
  [[nodiscard]] const std::string& title() const { return title_; }
  [[nodiscard]] std::span<const Point> points() const { return points_; }
  [[nodiscard]] WordOrder order() const { return order_; }
  /// Sorted by area and address.
  [[nodiscard]] std::span<const MapEntry> entries() const { return entries_; }
  [[nodiscard]] std::span<const MapEntry> entries_in(Area area) const;
  [[nodiscard]] std::span<const RetiredAddress> retired() const { return retired_; }
  /// The entry that covers an address, or the bits of a register, the lowest first; empty where there is none.
  [[nodiscard]] std::span<const MapEntry> covering(Area area, std::uint32_t address) const;
  /// The first of them, or null.
  [[nodiscard]] const MapEntry* find(Area area, std::uint32_t address) const;
  [[nodiscard]] const Point& point_of(const MapEntry& entry) const { return points_[entry.point]; }
  /// SHA-256 of names, formats, units, limits, access, addresses and the word order.
  [[nodiscard]] const std::string& hash() const { return hash_; }
  /// In which a client can read this map (discovery.hpp), by function 20, and from chain_address on where it fits
  /// there; empty where there is no discovery.
  [[nodiscard]] std::span<const std::uint16_t> chain() const { return chain_; }
  /// The registers from chain_address on.
  [[nodiscard]] std::span<const std::uint16_t> chain_registers() const { return is_in_files() ? entrance_ : chain_; }
  [[nodiscard]] bool is_in_files() const { return !entrance_.empty(); }
  /// HY860 of formats that do not hold the whole declared range of their point.
  [[nodiscard]] const Diagnostics& warnings() const { return warnings_; }

 private:
  friend RegisterMap make_register_map(std::span<const Point> points, const MapRequest& request);
  std::string title_;
  std::vector<Point> points_;
  WordOrder order_ = WordOrder::abcd;
  std::vector<MapEntry> entries_;
  std::array<std::size_t, 5> first_{};  ///< of each area in entries_
  std::vector<RetiredAddress> retired_;
  std::string hash_;
  std::vector<std::uint16_t> chain_;
  std::vector<std::uint16_t> entrance_;
  Diagnostics warnings_;
};

/// Gives every point its address; of points of one name, to the first alone. Throws InputError HY820 to HY826, HY860
/// and HY861 with all that is wrong.
[[nodiscard]] RegisterMap make_register_map(std::span<const Point> points, const MapRequest& request);

/// The lock file of a map: a line for each point and for each retired address. It reads back to the same addresses.
[[nodiscard]] std::string lock_text(const RegisterMap& map);

}  // namespace hysteron::runtime::modbus
