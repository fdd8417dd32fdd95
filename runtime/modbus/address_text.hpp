// Addresses as people write them: in the notation of IEC 61131-3 with OpenPLC's meaning, or as an area and a number.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "runtime/modbus/register_map.hpp"

namespace hysteron::runtime::modbus {

/// OpenPLC's Modbus addresses: 800 bits, 1024 words in and out, then memory of 16, 32 and 64 bits behind the outputs.
namespace openplc {
inline constexpr Stretch output_bits{Area::coil, 0, 800};                     ///< %QX0.0 to %QX99.7
inline constexpr Stretch input_bits{Area::discrete_input, 0, 800};            ///< %IX0.0 to %IX99.7
inline constexpr Stretch input_words{Area::input_register, 0, 1024};          ///< %IW0 to %IW1023
inline constexpr Stretch output_words{Area::holding_register, 0, 1024};       ///< %QW0 to %QW1023
inline constexpr Stretch memory_words{Area::holding_register, 1024, 1024};    ///< %MW0 to %MW1023
inline constexpr Stretch memory_doubles{Area::holding_register, 2048, 2048};  ///< %MD0 to %MD1023, high word first
inline constexpr Stretch memory_longs{Area::holding_register, 4096, 4096};    ///< %ML0 to %ML1023, high word first
}  // namespace openplc

struct ParsedAddress {
  Stretch at{};            ///< count is the width that the notation fixes
  bool any_width = false;  ///< holding 16: the point's type says how many
};

/// Empty where the text is no address, or one outside of its area.
[[nodiscard]] std::optional<ParsedAddress> parse_address(std::string_view text);

/// As it stands behind the number of a register: .3; empty where it is no bit.
[[nodiscard]] std::string bit_text(const Stretch& at);

/// As an area and a number: holding 16, or the bit holding 16.3.
[[nodiscard]] std::string address_text(const Stretch& at);

/// coil, discrete, holding, input.
[[nodiscard]] std::optional<Area> area_named(std::string_view name);

/// A decimal number of at most five digits without sign.
[[nodiscard]] std::optional<std::uint32_t> parse_count(std::string_view digits);

}  // namespace hysteron::runtime::modbus
