// Word orders: how a value of 32 or 64 bits lies in registers of 16 bits.
//
// Modbus fixes the order of the two bytes in a register and leaves the rest to the maker. Four orders are in use, named
// by where the bytes A (highest) to D (lowest) of a 32-bit value go. Values are moved as bits, never as floating-point
// numbers, so that a signalling NaN arrives as it left.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace hysteron::runtime::modbus {

enum class WordOrder : std::uint8_t {
  abcd,  ///< high word first: what the specification does with addresses; the default
  cdab,  ///< low word first
  badc,  ///< high word first, bytes swapped in each word
  dcba,  ///< low word first, bytes swapped
};

inline constexpr std::array<WordOrder, 4> word_orders{WordOrder::abcd, WordOrder::cdab, WordOrder::badc,
                                                      WordOrder::dcba};

constexpr bool low_word_first(WordOrder order) {
  return order == WordOrder::cdab || order == WordOrder::dcba;
}
constexpr bool bytes_swapped(WordOrder order) {
  return order == WordOrder::badc || order == WordOrder::dcba;
}

constexpr std::uint16_t swap_bytes(std::uint16_t word) {
  return static_cast<std::uint16_t>(static_cast<unsigned>(word) << 8U | static_cast<unsigned>(word) >> 8U);
}

/// The low 16·N bits of a value as N registers, 1 ≤ N ≤ 4. A single register has no order: it is sent as it is.
constexpr void to_registers(std::uint64_t bits, WordOrder order, std::span<std::uint16_t> registers) {
  const std::size_t count = registers.size();
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t place = low_word_first(order) ? i : count - 1 - i;  // 0 is the lowest word
    const auto word = static_cast<std::uint16_t>(bits >> (16U * place));
    registers[i] = count > 1 && bytes_swapped(order) ? swap_bytes(word) : word;
  }
}

/// The value of 1 to 4 registers; bits above are zero.
constexpr std::uint64_t from_registers(std::span<const std::uint16_t> registers, WordOrder order) {
  const std::size_t count = registers.size();
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t place = low_word_first(order) ? i : count - 1 - i;
    const std::uint16_t word = count > 1 && bytes_swapped(order) ? swap_bytes(registers[i]) : registers[i];
    bits |= static_cast<std::uint64_t>(word) << (16U * place);
  }
  return bits;
}

constexpr std::string_view name_of(WordOrder order) {
  switch (order) {
    case WordOrder::abcd:
      return "ABCD";
    case WordOrder::cdab:
      return "CDAB";
    case WordOrder::badc:
      return "BADC";
    case WordOrder::dcba:
      return "DCBA";
  }
  return "";
}

constexpr std::optional<WordOrder> word_order_named(std::string_view name) {
  for (const WordOrder order : word_orders) {
    if (name_of(order) == name) {
      return order;
    }
  }
  return std::nullopt;
}

}  // namespace hysteron::runtime::modbus
