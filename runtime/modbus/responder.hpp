// The answer to a request (PDU): a function of the request, the register map, the values behind the door and what the
// client may do. No sockets, no time.
//
// A request is carried out whole or not at all. The first of these that fails is the exception:
//   01 the function is none of ours, or reads or writes, which the client may not do at all
//   03 the request has not the form of its function: its length, its quantity, its byte count, a coil's value
//   02 an address is no point's, may not be written, or the request would write a part of a wide value
//   01 the client may write, but not one of these points
//   03 a value is outside of its point's limits, not a finite number or none of its format, or a bit is no point's
//   06 another client owns the writes
//   04 the program refuses; or a value to be read is not a number, and lies where only numbers can
// A value beyond what its format reaches is read as the nearest that it has, and counted.
// All values of one answer are of one cycle. A part of a wide value may be read; two reads may be of two cycles.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "runtime/modbus/frame.hpp"
#include "runtime/modbus/register_map.hpp"
#include "runtime/point.hpp"

namespace hysteron::runtime::modbus {

enum class Exception : std::uint8_t {
  none = 0,
  illegal_function = 1,
  illegal_address = 2,
  illegal_value = 3,
  device_failure = 4,
  device_busy = 6,
};

/// What function 43/14 tells of the device; the map's title and hash are added.
struct Identity {
  std::string vendor = "Hysteron";
  std::string product = "hysteron-runtime";
  std::string revision = "0.1";
};

/// What a client may do.
struct Rights {
  bool read = true;  ///< every function that reads, and the discovery
  bool inputs = true;
  bool parameters = true;
  bool reset = true;

  [[nodiscard]] bool writes() const { return inputs || parameters || reset; }
  [[nodiscard]] bool write(WriteRight right) const {
    return right == WriteRight::inputs ? inputs : right == WriteRight::parameters ? parameters : reset;
  }
  [[nodiscard]] Rights without_writes() const {
    return {.read = read, .inputs = false, .parameters = false, .reset = false};
  }
  bool operator==(const Rights&) const = default;
};
inline constexpr Rights no_rights{.read = false, .inputs = false, .parameters = false, .reset = false};

/// Of the client that asks.
struct Caller {
  Rights rights{};
  bool other_owns_writes = false;
};

struct Reply {
  std::array<std::uint8_t, longest_pdu> bytes{};
  std::size_t size = 0;
  Exception exception = Exception::none;
  bool wrote = false;  ///< values were handed to the door and taken

  [[nodiscard]] std::span<const std::uint8_t> pdu() const { return std::span(bytes).first(size); }
};

class Responder {
 public:
  /// Map and door must outlive the responder. The map is of the door's points, and of its further places.
  Responder(const RegisterMap& map, PointDoor& door, const Identity& identity);

  /// From the next request on, another map of points that the door has; it must outlive the responder.
  void show(const RegisterMap& map);
  /// The answer to a PDU of at least one byte.
  [[nodiscard]] Reply answer(std::span<const std::uint8_t> pdu, const Caller& caller);

  /// Values read that were beyond what their format reaches.
  [[nodiscard]] std::uint64_t saturated() const { return saturated_; }
  /// The point of the newest of them.
  [[nodiscard]] std::size_t saturated_point() const { return saturated_point_; }

  /// Why the door refused since the last call; for logs. Empty where it did not.
  [[nodiscard]] std::string take_refusal() { return std::exchange(refusal_, {}); }

 private:
  using Pdu = std::span<const std::uint8_t>;

  Exception serve(Pdu pdu, const Caller& caller, Reply& reply);
  Exception read_bits(Pdu pdu, Area area, Reply& reply);
  Exception read_words(Pdu pdu, Area area, Reply& reply);
  Exception write_one_coil(Pdu pdu, const Caller& caller, Reply& reply);
  Exception write_one_register(Pdu pdu, const Caller& caller, Reply& reply);
  Exception write_coils(Pdu pdu, const Caller& caller, Reply& reply);
  Exception write_registers(Pdu pdu, const Caller& caller, Reply& reply);
  Exception mask_register(Pdu pdu, const Caller& caller, Reply& reply);
  Exception write_and_read(Pdu pdu, const Caller& caller, Reply& reply);
  Exception read_files(Pdu pdu, Reply& reply) const;
  Exception identify(Pdu pdu, Reply& reply) const;

  [[nodiscard]] bool covered(Area area, std::uint32_t address, std::uint32_t count) const;
  Exception put_words(Area area, std::uint32_t address, std::uint32_t count, Reply& reply);
  /// The bits of a point now; nothing where it has none.
  std::optional<std::uint64_t> bits_now(const MapEntry& entry);
  /// The bits that lie at the address of these entries: of one wide value, or of the booleans of one register.
  std::optional<std::uint64_t> register_bits(std::span<const MapEntry> entries);
  [[nodiscard]] Exception writable(Area area, std::uint32_t address, std::uint32_t count, const Caller& caller) const;
  Exception collect_words(std::uint32_t address, Pdu data);
  Exception collect_register(std::span<const MapEntry> entries, std::uint64_t bits);
  Exception collect(const MapEntry& entry, std::uint64_t bits);
  Exception hand_over(const Caller& caller, Reply& reply);

  const RegisterMap* map_;
  PointDoor& door_;
  std::array<std::string, 6> objects_;  ///< of function 43/14, as object_ids
  Snapshot now_;
  std::vector<PointWrite> writes_;
  std::string refusal_;
  std::uint64_t saturated_ = 0;
  std::size_t saturated_point_ = 0;
};

}  // namespace hysteron::runtime::modbus
